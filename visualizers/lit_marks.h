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

/// Calls `edge(from, to)` for the twelve edges of a box given as origin and three edge vectors.
template <class Edge>
void for_each_edge(const std::vector<vec3>& box, const Edge& edge) {
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner) {
            const vec3 from = box[0] + ((corner & 1) != 0 ? box[1 + (axis + 1) % 3] : vec3(0.0f)) +
                              ((corner & 2) != 0 ? box[1 + (axis + 2) % 3] : vec3(0.0f));
            edge(from, from + box[1 + axis]);
        }
}

/// How far the pixel is from the drawn geometry; nothing for boxes, whose inside is not theirs, and for what is behind
/// the camera.
std::optional<float> distance_pixels(const ViewCamera& camera, const TraceGeometry& geometry, vec2 pixel);

}  // namespace sightlines
