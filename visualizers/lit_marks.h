// What a recorded step touches, drawn over a view inside as lines, rings and frames. In the units of the canvas.
#pragma once

#include <span>

#include "shaders/trace.h"
#include "visualizers/canvas.h"
#include "visualizers/theme.h"
#include "visualizers/view_camera.h"

namespace sightlines {

/// How strongly geometry is drawn.
enum class Emphasis {
    step,     ///< thin: there, but not before the view itself
    pointed,  ///< thick, on a halo, with its name
};

void draw_lit(Canvas& canvas, const ViewCamera& camera, std::span<const TraceGeometry> geometry, const Palette& colours,
              float text_scale, Emphasis emphasis);

/// How far the pixel is from the drawn geometry; nothing for boxes, whose inside is not theirs, and for what is behind
/// the camera.
std::optional<float> distance_pixels(const ViewCamera& camera, const TraceGeometry& geometry, vec2 pixel);

}  // namespace sightlines
