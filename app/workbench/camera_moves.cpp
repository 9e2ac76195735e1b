#include "app/workbench/camera_moves.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace sightlines {
namespace {

constexpr float steepest_deg = 89.0f;
constexpr float nearest_target_m = 1.0e-3f;

/// `direction` (unit) turned about `up` by `turn_deg` and raised by `rise_deg`, no steeper than steepest_deg.
vec3 turned(vec3 direction, vec3 up, float turn_deg, float rise_deg) {
    const float height = std::clamp(glm::dot(direction, up), -1.0f, 1.0f);
    const vec3 level = direction - height * up;
    const vec3 level_unit = glm::length(level) > 1.0e-6f
                                ? glm::normalize(level)
                                : glm::normalize(vec3(up.y, up.z, up.x) - glm::dot(vec3(up.y, up.z, up.x), up) * up);
    const float elevation_deg = std::clamp(glm::degrees(std::asin(height)) + rise_deg, -steepest_deg, steepest_deg);
    const vec3 around(glm::rotate(mat4(1.0f), glm::radians(turn_deg), up) * vec4(level_unit, 0.0f));
    return std::cos(glm::radians(elevation_deg)) * around + std::sin(glm::radians(elevation_deg)) * up;
}

/// Metres across one pixel of the picture, at a distance from the camera.
float metres_a_pixel(const Camera& camera, ImageSize picture, float distance_m) {
    const float half_height = camera_frame(camera, picture).half_height;
    const float at = camera.kind == CameraKind::orthographic ? 1.0f : distance_m;
    return 2.0f * half_height * at / static_cast<float>(picture.height);
}

}  // namespace

Camera orbited(Camera camera, vec2 drag_deg) {
    const vec3 back = camera.position - camera.target;
    const float distance_m = std::max(glm::length(back), nearest_target_m);
    camera.position =
        camera.target + distance_m * turned(back / distance_m, glm::normalize(camera.up), -drag_deg.x, drag_deg.y);
    return camera;
}

Camera looked(Camera camera, vec2 drag_deg) {
    const vec3 ahead = camera.target - camera.position;
    const float distance_m = std::max(glm::length(ahead), nearest_target_m);
    camera.target =
        camera.position + distance_m * turned(ahead / distance_m, glm::normalize(camera.up), -drag_deg.x, -drag_deg.y);
    return camera;
}

Camera panned(Camera camera, vec2 drag_pixels, ImageSize picture) {
    const CameraFrame frame = camera_frame(camera, picture);
    const float pixel_m = metres_a_pixel(camera, picture, glm::length(camera.target - camera.position));
    const vec3 move = pixel_m * (-drag_pixels.x * frame.right + drag_pixels.y * frame.up);
    camera.position += move;
    camera.target += move;
    return camera;
}

Camera dollied(Camera camera, float factor) {
    if (camera.kind == CameraKind::orthographic) camera.orthographic_height_m /= factor;
    const vec3 back = camera.position - camera.target;
    const float distance_m = std::max(glm::length(back), nearest_target_m);
    camera.position = camera.target + back / distance_m * std::max(distance_m / factor, nearest_target_m);
    return camera;
}

Camera flown(Camera camera, vec3 move_m) {
    const CameraFrame frame = camera_frame(camera, {1, 1});
    const vec3 move = move_m.x * frame.right + move_m.y * glm::normalize(camera.up) + move_m.z * frame.forward;
    camera.position += move;
    camera.target += move;
    return camera;
}

std::optional<vec2> projected(const Camera& camera, ImageSize picture, vec3 point) {
    const CameraFrame frame = camera_frame(camera, picture);
    const vec3 offset = point - camera.position;
    const float ahead_m = glm::dot(offset, frame.forward);
    if (ahead_m <= nearest_target_m) return std::nullopt;
    const float depth = camera.kind == CameraKind::orthographic ? 1.0f : ahead_m;
    const float x = glm::dot(offset, frame.right) / (depth * frame.half_width);
    const float y = glm::dot(offset, frame.up) / (depth * frame.half_height);
    return vec2(0.5f * (x + 1.0f) * static_cast<float>(picture.width),
                0.5f * (1.0f - y) * static_cast<float>(picture.height));
}

vec3 dragged(const Camera& camera, ImageSize picture, vec3 point, vec2 drag_pixels) {
    const CameraFrame frame = camera_frame(camera, picture);
    const float pixel_m = metres_a_pixel(camera, picture, glm::dot(point - camera.position, frame.forward));
    return point + pixel_m * (drag_pixels.x * frame.right - drag_pixels.y * frame.up);
}

}  // namespace sightlines
