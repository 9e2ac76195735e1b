// The fonts: found by their names, rasterised for the window's scale.
#pragma once

#include "app/window/style.h"

namespace sightlines {

/// Fills ImGui's atlas in place of what it held, for `scale` pixels a design pixel. EnvironmentError: no fonts at all.
Fonts load_fonts(float scale);

/// Dear ImGui's style in the theme's colours, lengths times `scale`.
void apply_style(Theme theme, float scale);

}  // namespace sightlines
