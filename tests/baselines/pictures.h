// Small scenes, surfaces and lights for the tests of the baselines, and a way to ask any of them.
#pragma once

#include <gtest/gtest.h>

#include "techniques/baselines/baselines.h"
#include "techniques/rays/reference.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::baselines::testing {

using voxel_rows::testing::add_triangle;
using voxel_rows::testing::finished;
using voxel_rows::testing::random_point;
using voxel_rows::testing::scattered_triangles;
using voxel_rows::testing::wall_in_a_box;

inline void add_quad(Scene& scene, vec3 corner, vec3 u, vec3 v) {
    add_triangle(scene, corner, corner + u, corner + u + v);
    add_triangle(scene, corner, corner + u + v, corner + v);
}

/// A closed sphere about the origin, of `slices` x `slices` quads, in a box of 4 m.
inline Scene sphere_in_a_box(float radius, int slices) {
    Scene scene;
    const auto point = [&](int i, int j) {
        const float polar = 3.14159265f * static_cast<float>(i) / static_cast<float>(slices);
        const float azimuth = 6.28318531f * static_cast<float>(j % slices) / static_cast<float>(slices);
        // The sine of pi is not zero in floats; the poles must be one point.
        const float ring = i == 0 || i == slices ? 0.0f : std::sin(polar);
        return radius * vec3(ring * std::cos(azimuth), std::cos(polar), ring * std::sin(azimuth));
    };
    for (int i = 0; i < slices; ++i) {
        for (int j = 0; j < slices; ++j) {
            if (i > 0) add_triangle(scene, point(i, j), point(i + 1, j + 1), point(i, j + 1));
            if (i + 1 < slices) add_triangle(scene, point(i, j), point(i + 1, j), point(i + 1, j + 1));
        }
    }
    scene.bounds.add(vec3(-2.0f));
    scene.bounds.add(vec3(2.0f));
    return finished(std::move(scene));
}

/// A wall across the middle of a box of 4 m with a slit `width_m` wide that runs along y, at z = 0.
inline Scene wall_with_a_slit(float width_m) {
    Scene scene;
    const float half = 0.5f * width_m;
    add_quad(scene, {0, -2, -2}, {0, 4, 0}, {0, 0, 2 - half});
    add_quad(scene, {0, -2, half}, {0, 4, 0}, {0, 0, 2 - half});
    scene.bounds.add(vec3(-2.0f));
    scene.bounds.add(vec3(2.0f));
    return finished(std::move(scene));
}

/// The points as a picture one pixel high.
inline SurfaceBuffer surfaces_of(std::span<const vec3> points, std::span<const vec3> normals) {
    SurfaceBuffer surfaces;
    surfaces.size = {static_cast<int>(points.size()), 1};
    surfaces.position.assign(points.begin(), points.end());
    surfaces.normal.assign(normals.begin(), normals.end());
    surfaces.shading_normal = surfaces.normal;
    surfaces.albedo.assign(points.size(), vec3(0.5f));
    surfaces.emission.assign(points.size(), vec3(0.0f));
    surfaces.triangle.assign(points.size(), 0u);
    return surfaces;
}

/// What a camera outside the scene sees of it.
inline SurfaceBuffer seen_surfaces(const Scene& scene, ImageSize size) {
    Progress progress;
    const auto embree = build_embree_scene(scene, EmbreeUse::reference, 0, progress);
    return visible_surfaces(scene, *embree, framing_camera(scene.bounds), size, 0, progress);
}

inline std::vector<Light> random_lights(const Box3& box, std::uint32_t count) {
    std::vector<Light> lights(count);
    for (std::uint32_t k = 0; k < count; ++k) lights[k].position = random_point(box, 13, k);
    return lights;
}

inline Structure built(const Technique& technique, const Scene& scene, const ParameterValues& parameters = {}) {
    Progress progress;
    return technique.build({&scene, parameters, Backend::cpu, 0}, progress);
}

inline RenderRequest request_for(const SurfaceBuffer& surfaces, std::span<const Light> lights,
                                 const ParameterValues& parameters = {}) {
    RenderRequest request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.parameters = parameters;
    request.keep_verdicts = true;
    return request;
}

inline RenderResult rendered(const Technique& technique, const Structure& structure, const RenderRequest& request) {
    Progress progress;
    return technique.render(structure, request, progress);
}

/// Whether the technique finds something between the surface point and the light.
inline bool is_blocked(const Technique& technique, const Structure& structure, vec3 position, vec3 normal,
                       const Light& light, const ParameterValues& parameters = {}) {
    const SurfaceBuffer surfaces = surfaces_of(std::span(&position, 1), std::span(&normal, 1));
    const RenderResult result = rendered(technique, structure, request_for(surfaces, std::span(&light, 1), parameters));
    EXPECT_EQ(result.rays, 1u) << "the light is behind the surface";
    return result.verdicts.blocked(0, 0);
}

/// Against Embree: the share of asked rays that are judged wrongly, in percent.
inline double visibility_error(const Technique& technique, const Scene& scene, const SurfaceBuffer& surfaces,
                               std::span<const Light> lights, const ParameterValues& parameters) {
    Progress progress;
    const RenderRequest request = request_for(surfaces, lights, parameters);
    const auto embree = build_embree_scene(scene, EmbreeUse::reference, 0, progress);
    const RenderResult truth = render_reference(*embree, request, progress);
    return compare(rendered(technique, built(technique, scene, parameters), request), truth).visibility_percent;
}

}  // namespace sightlines::baselines::testing
