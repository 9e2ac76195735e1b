#include "visualizers/view_camera.h"

#include <cmath>

#include <glm/gtc/constants.hpp>

namespace sightlines {
namespace {

constexpr float nearest_m = 1e-3f;

}  // namespace

ViewCamera view_camera(const OrbitCamera& orbit, ImageSize size) {
    const float azimuth = glm::radians(orbit.azimuth_deg), elevation = glm::radians(orbit.elevation_deg);
    const vec3 towards_eye{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                           std::cos(azimuth) * std::cos(elevation)};
    ViewCamera camera;
    camera.size = size;
    camera.position = orbit.focal_point + orbit.distance_m * towards_eye;
    camera.forward = -towards_eye;
    camera.right = {std::cos(azimuth), 0.0f, -std::sin(azimuth)};
    camera.up = glm::cross(camera.right, camera.forward);
    camera.pixels_per_slope =
        0.5f * static_cast<float>(size.height) / std::tan(0.5f * glm::radians(view_field_of_view_deg));
    return camera;
}

std::optional<vec3> projected(const ViewCamera& camera, vec3 point) {
    const vec3 from_eye = point - camera.position;
    const float depth_m = glm::dot(from_eye, camera.forward);
    if (depth_m < nearest_m) return std::nullopt;
    const float scale = camera.pixels_per_slope / depth_m;
    return vec3(0.5f * static_cast<float>(camera.size.width) + scale * glm::dot(from_eye, camera.right),
                0.5f * static_cast<float>(camera.size.height) - scale * glm::dot(from_eye, camera.up), depth_m);
}

vec3 direction_through(const ViewCamera& camera, vec2 pixel) {
    const float x = (pixel.x - 0.5f * static_cast<float>(camera.size.width)) / camera.pixels_per_slope;
    const float y = (0.5f * static_cast<float>(camera.size.height) - pixel.y) / camera.pixels_per_slope;
    return glm::normalize(camera.forward + x * camera.right + y * camera.up);
}

float metres_per_pixel(const ViewCamera& camera, float distance_m) { return distance_m / camera.pixels_per_slope; }

std::optional<ProjectedSegment> projected_segment(const ViewCamera& camera, vec3 from, vec3 to) {
    const float from_m = glm::dot(from - camera.position, camera.forward);
    const float to_m = glm::dot(to - camera.position, camera.forward);
    const float clip_m = 2.0f * nearest_m;
    if (from_m < clip_m && to_m < clip_m) return std::nullopt;
    if (from_m < clip_m) from = glm::mix(from, to, (clip_m - from_m) / (to_m - from_m));
    if (to_m < clip_m) to = glm::mix(from, to, (from_m - clip_m) / (from_m - to_m));
    const auto a = projected(camera, from), b = projected(camera, to);
    if (!a || !b) return std::nullopt;
    return ProjectedSegment{vec2(*a), vec2(*b)};
}

}  // namespace sightlines
