// Boxes that move rigidly over a floor, and what truly stands in a ray's way.
#pragma once

#include <span>
#include <vector>

#include "techniques/base/random.h"
#include "techniques/scene/builtin_mesh.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/technique.h"

namespace sightlines::voxel_rows::testing {

inline constexpr Box3 moving_box{vec3(-0.9f, -0.3f, -0.3f), vec3(0.9f, 0.3f, 0.3f)};
inline constexpr Box3 motion_space{vec3(-4, 0, -4), vec3(4, 5, 4)};

/// A floor that stands still, and instances of one box at `places`.
inline Scene boxes_over_a_floor(std::span<const mat4> places) {
    Scene scene;
    scene.materials = {diffuse("stone", vec3(0.5f))};
    Mesh floor, box;
    add_quad(floor, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, 0);
    add_box(box, moving_box, 0);
    add_part(scene, floor, "floor", 0, mat4(1.0f));
    for (const mat4& place : places) {
        add_part(scene, box, "box", 1, place);
        scene.parts.back().moves = true;
    }
    scene.bounds = tight_bounds(scene);
    scene.motion_bounds = scene.light_volume = motion_space;
    return scene;
}

/// Many boxes, turned any way, all in the air.
inline std::vector<mat4> scattered_places(std::uint32_t count, std::uint64_t seed) {
    std::vector<mat4> places;
    for (std::uint32_t k = 0; k < count; ++k) {
        const auto unit = [&](std::uint32_t sample) { return random_unit(seed, k, sample); };
        places.push_back(placed(vec3(-3, 1, -3) + vec3(6, 3, 6) * vec3(unit(0), unit(1), unit(2)), 360.0f * unit(3)));
    }
    return places;
}

/// Whether the segment meets the moving box at `world_from_box`, grown by `margin_m` on all sides.
inline bool meets(const mat4& world_from_box, const Segment& ray, float margin_m) {
    const mat4 box_from_world = glm::inverse(world_from_box);
    const vec3 a(box_from_world * vec4(ray.origin, 1.0f)), b(box_from_world * vec4(ray.target, 1.0f));
    float enter = 0.0f, leave = 1.0f;
    for (int axis = 0; axis < 3; ++axis) {
        const float first = (moving_box.lowest[axis] - margin_m - a[axis]) / (b[axis] - a[axis]);
        const float second = (moving_box.highest[axis] + margin_m - a[axis]) / (b[axis] - a[axis]);
        enter = std::max(enter, std::min(first, second));
        leave = std::min(leave, std::max(first, second));
    }
    return enter < leave;
}

/// A picture of `size` pixels with a surface all over the floor and in the air, normals any way up.
inline SurfaceBuffer surfaces_all_over(ImageSize size) {
    SurfaceBuffer surfaces;
    surfaces.size = size;
    for (std::uint32_t k = 0; k < size.pixels(); ++k) {
        const auto unit = [&](std::uint32_t sample) { return random_unit(77, k, sample); };
        vec3 place = motion_space.lowest + motion_space.size() * vec3(unit(0), unit(1), unit(2));
        vec3 normal = sphere_direction(unit(3), unit(4));
        if (k % 2 == 0) {
            place.y = 0.0f;
            normal = vec3(0.0f, 1.0f, 0.0f);
        }
        const bool background = k % 31 == 0;
        surfaces.position.push_back(background ? vec3(0.0f) : place);
        surfaces.normal.push_back(background ? vec3(0.0f) : normal);
        surfaces.albedo.push_back(background ? vec3(0.0f) : vec3(0.5f));
        surfaces.emission.push_back(vec3(0.0f));
        surfaces.triangle.push_back(background ? no_triangle : 0u);
    }
    surfaces.shading_normal = surfaces.normal;
    return surfaces;
}

/// Lights in the air; `of_all_kinds`: some of them spots, directional or outside the scene.
inline std::vector<Light> lights_above(std::uint32_t count, bool of_all_kinds) {
    std::vector<Light> lights(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        const auto unit = [&](std::uint32_t sample) { return random_unit(78, k, sample); };
        lights[k].position = vec3(-4, 4, -4) + vec3(8, 1, 8) * vec3(unit(0), unit(1), unit(2));
        if (!of_all_kinds) continue;
        lights[k].kind = static_cast<LightKind>(k % 3);
        lights[k].direction = glm::normalize(vec3(unit(3) - 0.5f, -1.0f, unit(4) - 0.5f));
        if (k % 5 == 0) lights[k].position *= 4.0f;
    }
    return lights;
}

inline ParameterValues small_parameters() {
    return {{"resolution", 48.0}, {"angle_step", 4.0}, {"motion", 2.0}};  // objects
}

}  // namespace sightlines::voxel_rows::testing
