// Where points of the world fall on the picture, and back. One camera for VTK, for the drawing on top and for picking.
#pragma once

#include <optional>

#include "visualizers/view_state.h"

namespace sightlines {

/// An orbit camera looking through a picture of `size`. Pixels: (0, 0) is the top left corner, y down.
struct ViewCamera {
    vec3 position{0.0f}, right{1.0f, 0.0f, 0.0f}, up{0.0f, 1.0f, 0.0f}, forward{0.0f, 0.0f, -1.0f};
    float pixels_per_slope = 1.0f;  ///< pixels for one metre across at one metre's distance
    ImageSize size;
};

ViewCamera view_camera(const OrbitCamera& orbit, ImageSize size);

/// x and y in pixels, z the distance along the view direction in m; nothing behind the camera.
std::optional<vec3> projected(const ViewCamera& camera, vec3 point);

/// Unit direction, world, through a pixel position.
vec3 direction_through(const ViewCamera& camera, vec2 pixel);

/// Metres in the plane at `distance_m` for one pixel.
float metres_per_pixel(const ViewCamera& camera, float distance_m);

/// The part of the segment in front of the camera, projected; nothing where there is none.
struct ProjectedSegment {
    vec2 from{0.0f}, to{0.0f};
};
std::optional<ProjectedSegment> projected_segment(const ViewCamera& camera, vec3 from, vec3 to);

}  // namespace sightlines
