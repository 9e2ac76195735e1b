#include "techniques/baselines/shadow_maps/map_shapes.h"

#include <algorithm>
#include <cmath>

namespace sightlines::baselines {

ShadowMapShape map_shape(const LightRecord& light, const Box3& bounds, const MapOptions& options) {
    ShadowMapShape shape{};
    shape.light = light.position;
    shape.resolution = options.resolution;
    shape.pitch = (options.resolution + 15) / 16 * 16;
    shape.map_pitch = shape.pitch * options.resolution;
    shape.normal_offset = options.normal_offset;
    shape.depth_bias = options.depth_bias;
    shape.blur_m = options.blur_m;
    if (light.kind != light_directional) return shape;
    shape.directional = 1;
    shape.light = bounds.empty() ? vec3(0.0f) : bounds.centre();
    shape.axis_depth = light.direction;
    const vec3 helper = std::abs(light.direction.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    const vec3 u = glm::normalize(glm::cross(light.direction, helper)), v = glm::cross(light.direction, u);
    const vec3 half = bounds.empty() ? vec3(1.0f) : glm::max(0.5f * bounds.size(), vec3(1.0e-3f));
    shape.reach_m = 2.0f * glm::length(half);
    // A square that holds the bounds, and a texel's margin all around.
    const float half_side = std::max(glm::dot(glm::abs(u), half), glm::dot(glm::abs(v), half));
    shape.texel_m = 2.0f * half_side / static_cast<float>(std::max(options.resolution - 2, 1));
    shape.axis_u = u / shape.texel_m;
    shape.axis_v = v / shape.texel_m;
    return shape;
}

std::uint32_t lights_at_once(int resolution, int maps) {
    const auto side = static_cast<std::size_t>((resolution + 15) / 16 * 16);
    const std::size_t bytes = side * side * static_cast<std::size_t>(maps) * sizeof(float);
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(maps_at_once_bytes / bytes, 1, 64));
}

vec3 held_point(const ShadowMapShape& shape, int map, int column, int line, float held, bool paraboloids) {
    const float half = 0.5f * static_cast<float>(shape.resolution);
    const float x = static_cast<float>(column) + 0.5f - half, y = static_cast<float>(line) + 0.5f - half;
    if (shape.directional != 0)
        return shape.light + shape.texel_m * shape.texel_m * (x * shape.axis_u + y * shape.axis_v) +
               (shape.reach_m - held) * shape.axis_depth;
    if (paraboloids) {
        const float u = x / half, v = y / half, squared = u * u + v * v;
        const vec3 direction =
            vec3(2.0f * u, (map == 0 ? 1.0f : -1.0f) * (1.0f - squared), 2.0f * v) / (1.0f + squared);
        return shape.light + direction / held;
    }
    const int axis = map / 2;
    vec3 direction(0.0f);
    direction[axis] = map % 2 == 0 ? 1.0f : -1.0f;
    direction[(axis + 1) % 3] = x / half;
    direction[(axis + 2) % 3] = y / half;
    return shape.light + direction / held;
}

}  // namespace sightlines::baselines
