// Small scenes with known answers, and a ray tracer too simple to be wrong.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "techniques/base/random.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/rays/reference.h"
#include "techniques/scene/scene.h"

namespace sightlines::test {

inline Scene scene_with_material(const Material& material = {}) {
    Scene scene;
    scene.name = "test";
    scene.materials.push_back(material);
    return scene;
}

/// Its own three vertices; normals as the winding gives them.
inline void add_triangle(Scene& scene, vec3 a, vec3 b, vec3 c, std::uint32_t material = 0) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const vec3 cross = glm::cross(b - a, c - a);
    const vec3 normal = glm::length(cross) > 0.0f ? glm::normalize(cross) : vec3(0.0f, 1.0f, 0.0f);
    for (const vec3 corner : {a, b, c}) {
        scene.positions.push_back(corner);
        scene.normals.push_back(normal);
        scene.bounds.add(corner);
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangle_materials.push_back(material);
    scene.light_volume = scene.bounds;
}

/// The corners in turn; texture coordinates (0,0) (1,0) (1,1) (0,1).
inline void add_corners(Scene& scene, vec3 a, vec3 b, vec3 c, vec3 d, std::uint32_t material) {
    add_triangle(scene, a, b, c, material);
    add_triangle(scene, a, c, d, material);
    for (const vec2 at : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1)})
        scene.texture_coordinates[0].push_back(at);
}

/// The parallelogram corner, corner + u, corner + u + v, corner + v.
inline void add_quad(Scene& scene, vec3 corner, vec3 u, vec3 v, std::uint32_t material = 0) {
    add_corners(scene, corner, corner + u, corner + u + v, corner + v, material);
}

/// Six quads, facing outwards; neighbours share their corners to the last bit.
inline void add_box(Scene& scene, vec3 lowest, vec3 highest, std::uint32_t material = 0) {
    const auto corner = [&](int x, int y, int z) {
        return vec3(x ? highest.x : lowest.x, y ? highest.y : lowest.y, z ? highest.z : lowest.z);
    };
    add_corners(scene, corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0), material);
    add_corners(scene, corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1), material);
    add_corners(scene, corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0), material);
    add_corners(scene, corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1), material);
    add_corners(scene, corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1), material);
    add_corners(scene, corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), material);
}

/// Inscribed in the sphere; smooth outward normals; vertices shared, as a modeller would leave it.
inline void add_sphere(Scene& scene, vec3 centre, float radius, std::uint32_t slices, std::uint32_t material = 0) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const std::uint32_t stacks = slices / 2;
    for (std::uint32_t i = 0; i <= stacks; ++i) {
        for (std::uint32_t j = 0; j < slices; ++j) {
            const float polar = std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(stacks);
            const float azimuth = 2.0f * std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(slices);
            // The sine of pi is not zero in floats; the pole must be one point.
            const float ring = i == stacks ? 0.0f : std::sin(polar);
            const vec3 normal(ring * std::cos(azimuth), std::cos(polar), ring * std::sin(azimuth));
            scene.positions.push_back(centre + radius * normal);
            scene.normals.push_back(normal);
            scene.bounds.add(scene.positions.back());
        }
    }
    for (std::uint32_t i = 0; i < stacks; ++i) {
        for (std::uint32_t j = 0; j < slices; ++j) {
            const std::uint32_t next = (j + 1) % slices;
            const std::uint32_t a = first + i * slices + j, b = first + i * slices + next;
            const std::uint32_t c = first + (i + 1) * slices + next, d = first + (i + 1) * slices + j;
            scene.triangles.emplace_back(a, b, c);
            scene.triangles.emplace_back(a, c, d);
            scene.triangle_materials.insert(scene.triangle_materials.end(), 2, material);
        }
    }
    scene.light_volume = scene.bounds;
}

/// A horizontal square of 1 m at height 1, textured: its left half is solid, its right half a hole where masked.
inline Scene scene_with_square(AlphaMode mode) {
    Material material;
    material.alpha_mode = mode;
    material.base_color_texture = TextureLookup{};
    Scene scene = scene_with_material(material);
    Texture texture;
    texture.texels = ImageRgba8({64, 64}, glm::u8vec4(255));
    for (int y = 0; y < 64; ++y)
        for (int x = 32; x < 64; ++x) texture.texels.at(x, y).a = 10;
    scene.textures.push_back(texture);
    add_quad(scene, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
    return scene;
}

inline vec3 random_point(const Box3& box, std::uint32_t index, std::uint64_t seed = 1) {
    const vec3 unit(random_unit(seed, index, 0), random_unit(seed, index, 1), random_unit(seed, index, 2));
    return box.lowest + unit * box.size();
}

/// `count` triangles of random places, sizes and directions in the box [-1, 1]^3.
inline Scene triangle_soup(std::uint32_t count) {
    Scene scene = scene_with_material();
    const Box3 box{vec3(-1.0f), vec3(1.0f)};
    for (std::uint32_t i = 0; i < count; ++i) {
        const vec3 middle = random_point(box, i);
        std::array<vec3, 3> corners;
        for (std::uint32_t k = 0; k < 3; ++k) corners[k] = middle + 0.35f * random_point(box, 3 * i + k, 2);
        add_triangle(scene, corners[0], corners[1], corners[2]);
    }
    return scene;
}

/// Moeller and Trumbore 1997, in double precision: whether the segment a + t (b - a), t in (nearest, farthest), meets
/// the triangle.
inline bool crosses(dvec3 a, dvec3 b, dvec3 p, dvec3 q, dvec3 r, double nearest, double farthest) {
    const dvec3 along = b - a, u = q - p, v = r - p;
    const dvec3 h = glm::cross(along, v);
    const double determinant = glm::dot(u, h);
    if (determinant == 0.0) return false;
    const dvec3 s = (a - p) / determinant;
    const double x = glm::dot(s, h);
    const dvec3 k = glm::cross(s, u);
    const double y = glm::dot(along, k);
    const double t = glm::dot(v, k);
    return x >= 0.0 && y >= 0.0 && x + y <= 1.0 && t > nearest && t < farthest;
}

inline bool any_crosses(const Scene& scene, vec3 a, vec3 b, double nearest, double farthest) {
    for (const uvec3 t : scene.triangles)
        if (crosses(a, b, scene.positions[t.x], scene.positions[t.y], scene.positions[t.z], nearest, farthest))
            return true;
    return false;
}

inline Light point_light(vec3 position, vec3 intensity = vec3(1.0f)) {
    Light light;
    light.position = position;
    light.intensity = intensity;
    return light;
}

inline Camera camera_at(vec3 position, vec3 target) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    return camera;
}

inline std::shared_ptr<const EmbreeScene> built(const Scene& scene, EmbreeUse use = EmbreeUse::reference) {
    Progress progress;
    return build_embree_scene(scene, use, 2, progress);
}

inline SurfaceBuffer seen(const Scene& scene, const EmbreeScene& embree, const Camera& camera, ImageSize size,
                          int threads = 2) {
    Progress progress;
    return visible_surfaces(scene, embree, camera, size, threads, progress);
}

}  // namespace sightlines::test
