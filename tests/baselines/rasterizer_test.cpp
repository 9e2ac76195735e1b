// The rasteriser against rays shot through the middle of every texel.
#include "techniques/baselines/shadow_maps/rasterizer.h"

#include <gtest/gtest.h>

#include "techniques/baselines/shadow_maps/map_shapes.h"
#include "techniques/rays/light_records.h"
#include "tests/baselines/pictures.h"

namespace sightlines::baselines {
namespace {

std::vector<float> drawn(const Scene& scene, const ShadowMapShape& shape, int map, MapRect rect) {
    Progress progress;
    std::vector<float> numbers(static_cast<std::size_t>(shape.map_pitch), -1.0f);
    rasterize(make_clusters(scene, progress), shape, map, rect, numbers, progress);
    return numbers;
}

MapRect whole(const ShadowMapShape& shape) { return {0, 0, shape.resolution - 1, shape.resolution - 1}; }

/// The share of `way` at which the ray meets a triangle first; 0 where it meets none.
double first_hit(const Scene& scene, dvec3 origin, dvec3 way) {
    double nearest = 0.0;
    for (const uvec3 corners : scene.triangles) {
        const dvec3 a(scene.positions[corners.x]), b(scene.positions[corners.y]), c(scene.positions[corners.z]);
        const dvec3 normal = glm::cross(b - a, c - a);
        const double share = glm::dot(a - origin, normal) / glm::dot(way, normal);
        if (!(share > 0.0) || (nearest > 0.0 && share >= nearest)) continue;
        const dvec3 point = origin + share * way;
        const bool inside = glm::dot(glm::cross(b - a, point - a), normal) >= 0.0 &&
                            glm::dot(glm::cross(c - b, point - b), normal) >= 0.0 &&
                            glm::dot(glm::cross(a - c, point - c), normal) >= 0.0;
        if (inside) nearest = share;
    }
    return nearest;
}

/// Texels that differ from what a ray through their middle finds, of all that either sees something in.
struct Comparison {
    int seen = 0, different = 0;
};

Comparison compared(const Scene& scene, const ShadowMapShape& shape, int map) {
    const std::vector<float> numbers = drawn(scene, shape, map, whole(shape));
    Comparison comparison;
    for (int y = 0; y < shape.resolution; ++y) {
        for (int x = 0; x < shape.resolution; ++x) {
            // Two points of the texel's ray, whatever the projection.
            const bool directional = shape.directional != 0;
            const dvec3 a =
                directional ? dvec3(held_point(shape, map, x, y, 2.0f * shape.reach_m, false)) : dvec3(shape.light);
            const dvec3 b(held_point(shape, map, x, y, directional ? 0.0f : 1.0f, false));
            const double share = first_hit(scene, a, b - a);
            const double expected = share == 0.0  ? 0.0
                                    : directional ? 2.0 * shape.reach_m * (1.0 - share)
                                                  : 1.0 / share;
            const double held = numbers[static_cast<std::size_t>(y * shape.pitch + x)];
            if (expected == 0.0 && held == 0.0) continue;
            ++comparison.seen;
            comparison.different += std::abs(held - expected) > 1e-3 * std::max(expected, held);
        }
    }
    return comparison;
}

TEST(Rasterizer, DrawsWhatRaysThroughTheMiddleOfEachTexelFind) {
    const Scene scene = testing::scattered_triangles(400, 21);
    const LightRecord light = light_record({.position = {4.1f, 2.9f, 5.2f}});  // amid the triangles
    const ShadowMapShape shape = map_shape(light, scene.bounds, {90, 0.0f, 0.0f, 0.0f});
    int seen = 0, different = 0;
    for (int map = 0; map < 6; ++map) {
        const Comparison comparison = compared(scene, shape, map);
        seen += comparison.seen;
        different += comparison.different;
    }
    EXPECT_GT(seen, 20000);
    EXPECT_LE(different, 10);  // rays along an edge
}

TEST(Rasterizer, DrawsADirectionalLightsMap) {
    const Scene scene = testing::scattered_triangles(400, 22);
    for (const vec3 direction : {vec3(0.3f, -0.8f, 0.4f), vec3(0.0f, -1.0f, 0.0f), vec3(1.0f, 0.0f, 0.0f)}) {
        const LightRecord light =
            light_record({.kind = LightKind::directional, .direction = glm::normalize(direction)});
        const ShadowMapShape shape = map_shape(light, scene.bounds, {120, 0.0f, 0.0f, 0.0f});
        const Comparison comparison = compared(scene, shape, 0);
        EXPECT_GT(comparison.seen, 2000);
        EXPECT_LE(comparison.different, 5);
    }
}

TEST(Rasterizer, LeavesNoCracksInAClosedSurface) {
    const Scene scene = testing::sphere_in_a_box(1.0f, 60);
    for (const vec3 place : {vec3(0.0f), vec3(0.7f, 0.3f, -0.2f), vec3(-0.05f, 0.95f, 0.02f)}) {
        for (const int resolution : {16, 100, 257}) {
            const ShadowMapShape shape =
                map_shape(light_record({.position = place}), scene.bounds, {resolution, 0.0f, 0.0f, 0.0f});
            for (int map = 0; map < 6; ++map) {
                const std::vector<float> numbers = drawn(scene, shape, map, whole(shape));
                for (int y = 0; y < resolution; ++y)
                    for (int x = 0; x < resolution; ++x)
                        ASSERT_GT(numbers[static_cast<std::size_t>(y * shape.pitch + x)], 0.4f)
                            << map << ' ' << x << ' ' << y;
            }
        }
    }
}

TEST(Rasterizer, DrawsARectangleAsItDrawsTheWhole) {
    const Scene scene = testing::scattered_triangles(300, 23);
    const ShadowMapShape shape =
        map_shape(light_record({.position = {1.0f, 2.0f, 9.0f}}), scene.bounds, {100, 0.0f, 0.0f, 0.0f});
    const MapRect rect{37, 20, 61, 90};
    for (int map = 0; map < 6; ++map) {
        const std::vector<float> all = drawn(scene, shape, map, whole(shape)), part = drawn(scene, shape, map, rect);
        for (int y = rect.first_y; y <= rect.last_y; ++y)
            for (int x = rect.first_x; x <= rect.last_x; ++x) {
                const auto at = static_cast<std::size_t>(y * shape.pitch + x);
                ASSERT_EQ(all[at], part[at]) << map << ' ' << x << ' ' << y;
            }
    }
}

TEST(Rasterizer, KeepsEveryTriangleOfTheScene) {
    const Scene scene = testing::scattered_triangles(300, 24);
    Progress progress;
    const TriangleClusters clusters = make_clusters(scene, progress);
    EXPECT_EQ(clusters.triangles, 300u);
    EXPECT_EQ(clusters.corners[0][0].size(), 384u);
    double area = 0.0, expected = 0.0;
    const auto area_of = [](dvec3 a, dvec3 b, dvec3 c) { return glm::length(glm::cross(b - a, c - a)); };
    for (std::size_t t = 0; t < clusters.corners[0][0].size(); ++t) {
        dvec3 corners[3];
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis) corners[k][axis] = clusters.corners[k][axis][t];
        area += area_of(corners[0], corners[1], corners[2]);
    }
    for (const uvec3 t : scene.triangles)
        expected += area_of(scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]);
    EXPECT_NEAR(area, expected, 1e-6 * expected);
}

}  // namespace
}  // namespace sightlines::baselines
