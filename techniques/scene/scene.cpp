#include "techniques/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "techniques/base/error.h"

namespace sightlines {

Camera framing_camera(const Box3& bounds) {
    Camera camera;
    if (bounds.empty()) return camera;
    const vec3 backward = glm::normalize(vec3(0.0f, 0.35f, 1.0f));
    const vec3 right(1.0f, 0.0f, 0.0f);
    const vec3 up = glm::cross(backward, right);
    const float slope = std::tan(glm::radians(0.5f * camera.vertical_field_of_view_deg));
    // The nearest distance from which every corner is inside a square picture, and a little air.
    float distance_m = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 sign((corner & 1) != 0 ? 0.5f : -0.5f, (corner & 2) != 0 ? 0.5f : -0.5f,
                        (corner & 4) != 0 ? 0.5f : -0.5f);
        const vec3 offset = sign * bounds.size();
        const float across = std::max(std::abs(glm::dot(offset, right)), std::abs(glm::dot(offset, up)));
        distance_m = std::max(distance_m, glm::dot(offset, backward) + across / slope);
    }
    camera.target = bounds.centre();
    camera.position = camera.target + backward * (distance_m > 0.0f ? 1.05f * distance_m : 1.0f);
    return camera;
}

CameraFrame camera_frame(const Camera& camera, ImageSize size) {
    CameraFrame frame{};
    const vec3 ahead = camera.target - camera.position;
    frame.forward = glm::dot(ahead, ahead) > 0.0f ? glm::normalize(ahead) : vec3(0.0f, 0.0f, -1.0f);
    vec3 sideways = glm::cross(frame.forward, camera.up);
    if (glm::dot(sideways, sideways) < 1.0e-12f * std::max(1.0e-30f, glm::dot(camera.up, camera.up))) {
        // Looking along `up`: any other direction will do.
        const vec3 other = std::fabs(frame.forward.z) < 0.9f ? vec3(0.0f, 0.0f, -1.0f) : vec3(0.0f, 1.0f, 0.0f);
        sideways = glm::cross(frame.forward, other);
    }
    frame.right = glm::normalize(sideways);
    frame.up = glm::cross(frame.right, frame.forward);
    frame.half_height = camera.kind == CameraKind::orthographic
                            ? 0.5f * camera.orthographic_height_m
                            : std::tan(0.5f * glm::radians(camera.vertical_field_of_view_deg));
    frame.half_width = frame.half_height * static_cast<float>(size.width) / static_cast<float>(size.height);
    return frame;
}

Camera find_camera(const Scene& scene, const std::string& name) {
    if (scene.cameras.empty()) return framing_camera(scene.bounds);
    if (name.empty()) return scene.cameras.front();
    const auto found = std::ranges::find(scene.cameras, name, &Camera::name);
    if (found != scene.cameras.end()) return *found;
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) names.push_back(camera.name);
    const std::string nearest = nearest_name(name, names);
    throw InputError("--camera", "", "the scene has no camera `" + name + "`",
                     "did you mean `" + (nearest.empty() ? names.front() : nearest) + "`?");
}

}  // namespace sightlines
