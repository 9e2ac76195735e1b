// The flat part of the view "dictionary": the two rows bit under bit, and three charts of the whole dictionary.
#pragma once

#include "visualizers/canvas.h"
#include "visualizers/dictionary_picture.h"
#include "visualizers/view_state.h"

namespace sightlines {

/// How high the panel is in a view of `size`: with charts where there is room, else the rows alone, else 0.
/// `em` is the height of body text.
float dictionary_panel_height(vec2 size, float em);

/// Draws the panel into `where`, whose height is one of those above. As many charts as fit side by side.
void draw_dictionary_panel(Canvas& canvas, const DictionaryPicture& picture, const ViewState& state,
                           const Rectangle& where, float em);

}  // namespace sightlines
