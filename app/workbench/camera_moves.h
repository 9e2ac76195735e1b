// How the mouse and keys move the camera of the picture: pure functions of the camera.
#pragma once

#include <optional>

#include "techniques/scene/scene.h"

namespace sightlines {

/// Turns about the target; +x to the right, +y downwards, as the mouse moves the scene. Stays upright.
Camera orbited(Camera camera, vec2 drag_deg);
/// Turns about its own position: looks around. +x turns to the right, +y down.
Camera looked(Camera camera, vec2 drag_deg);
/// Moves sideways so that what lies at the target's distance follows the mouse.
Camera panned(Camera camera, vec2 drag_pixels, ImageSize picture);
/// Nearer to the target by `factor` > 1. An orthographic camera magnifies.
Camera dollied(Camera camera, float factor);
/// Flies: to the right, up and forward, m.
Camera flown(Camera camera, vec3 move_m);

/// Where a point appears in the picture, in pixels from the top left corner; empty where it lies behind the camera.
std::optional<vec2> projected(const Camera& camera, ImageSize picture, vec3 point);
/// `point` moved parallel to the picture by `drag_pixels`.
vec3 dragged(const Camera& camera, ImageSize picture, vec3 point, vec2 drag_pixels);

}  // namespace sightlines
