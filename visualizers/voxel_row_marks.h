// The marks on top of the view inside, as lines and text: the ray, its twin and their angle, the extent, orientation,
// scale, legend. In the units of the canvas, so that they are pixels in a window and vectors on a page.
#pragma once

#include "visualizers/canvas.h"
#include "visualizers/view_state.h"
#include "visualizers/voxel_row_picture.h"

namespace sightlines {

/// Whether verdict and legend are drawn into the picture, or the page has them elsewhere.
enum class MarksKey { none, in_corner };

/// Draws into (0, 0) to `size` of the canvas (its offset applies), as seen by the camera in force. `text_scale` 1 gives
/// body text 12 units high.
void draw_voxel_row_marks(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, ImageSize size,
                          float text_scale, MarksKey key);

/// What the colours and shapes mean, from `at` to the right, in lines no wider than `width`. Gives the height used.
float draw_voxel_row_legend(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, vec2 at,
                            float width, float text_height);

}  // namespace sightlines
