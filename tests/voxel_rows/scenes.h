// Small scenes with known answers for the tests of the voxel rows.
#pragma once

#include "techniques/base/random.h"
#include "techniques/scene/scene.h"

namespace sightlines::voxel_rows::testing {

inline void add_triangle(Scene& scene, vec3 a, vec3 b, vec3 c) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    for (const vec3 corner : {a, b, c}) {
        scene.positions.push_back(corner);
        scene.normals.push_back(normal);
        scene.bounds.add(corner);
    }
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangle_materials.push_back(0);
}

inline Scene finished(Scene scene) {
    scene.materials.resize(1);
    scene.parts = {{"all", 0, static_cast<std::uint32_t>(scene.triangles.size())}};
    scene.light_volume = scene.bounds;
    return scene;
}

/// Triangles of about a metre scattered through a box of 8 x 6 x 10 m.
inline Scene scattered_triangles(std::uint32_t count, std::uint64_t seed) {
    Scene scene;
    for (std::uint32_t k = 0; k < count; ++k) {
        const auto unit = [&](std::uint32_t sample) { return random_unit(seed, k, sample); };
        const vec3 centre = vec3(unit(0), unit(1), unit(2)) * vec3(8.0f, 6.0f, 10.0f);
        vec3 corners[3];
        for (std::uint32_t c = 0; c < 3; ++c)
            corners[c] = centre + 0.7f * sphere_direction(unit(3 + 2 * c), unit(4 + 2 * c));
        add_triangle(scene, corners[0], corners[1], corners[2]);
    }
    return finished(scene);
}

/// A square wall of side `side_m` at x = 0, in a box that reaches 2 m to both sides of it.
inline Scene wall_in_a_box(float side_m) {
    Scene scene;
    const float h = 0.5f * side_m;
    add_triangle(scene, {0, -h, -h}, {0, h, -h}, {0, h, h});
    add_triangle(scene, {0, -h, -h}, {0, h, h}, {0, -h, h});
    scene.bounds.add({-2.0f, -2.0f, -2.0f});
    scene.bounds.add({2.0f, 2.0f, 2.0f});
    return finished(scene);
}

inline vec3 random_point(const Box3& box, std::uint64_t seed, std::uint32_t index) {
    return box.lowest +
           box.size() * vec3(random_unit(seed, index, 0), random_unit(seed, index, 1), random_unit(seed, index, 2));
}

}  // namespace sightlines::voxel_rows::testing
