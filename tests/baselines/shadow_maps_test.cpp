// Conventional shadow maps: look-ups wide against scalar, errors against Embree, lights in several loads.
#include <gtest/gtest.h>

#include "shaders/shadow_map.h"
#include "techniques/baselines/shadow_maps/map_shapes.h"
#include "techniques/baselines/shadow_maps/rasterizer.h"
#include "techniques/rays/light_records.h"
#include "tests/baselines/pictures.h"

namespace sightlines::baselines {
namespace {

/// Points all over the scene with random normals.
SurfaceBuffer random_surfaces(const Box3& box, std::uint32_t count) {
    std::vector<vec3> points(count), normals(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        points[k] = testing::random_point(box, 41, k);
        normals[k] = sphere_direction(random_unit(42, k, 0), random_unit(42, k, 1));
    }
    return testing::surfaces_of(points, normals);
}

std::vector<Light> lights_of_all_kinds(const Box3& box, std::uint32_t count) {
    std::vector<Light> lights = testing::random_lights(box, count);
    lights[1].kind = LightKind::directional;
    lights[1].direction = glm::normalize(vec3(0.3f, -1.0f, 0.2f));
    lights[2].kind = LightKind::spot;
    return lights;
}

TEST(ShadowMaps, AnswerWideAsScalarOnEveryOfAHundredThousandRays) {
    const Scene scene = testing::scattered_triangles(200, 31);
    const SurfaceBuffer surfaces = random_surfaces(scene.bounds, 20'011);
    const std::vector<Light> lights = lights_of_all_kinds(scene.bounds, 12);
    const ParameterValues parameters{{"resolution", 75.0}, {"normal_offset", 0.5}, {"bias", 0.25}};
    const Technique& technique = shadow_maps();
    const RenderResult result = testing::rendered(technique, testing::built(technique, scene, parameters),
                                                  testing::request_for(surfaces, lights, parameters));
    Progress progress;
    const TriangleClusters clusters = make_clusters(scene, progress);
    std::uint64_t rays = 0, blocked = 0;
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
        const LightRecord record = light_record(lights[light]);
        const ShadowMapShape shape = map_shape(record, scene.bounds, {75, 0.5f, 0.25f, 0.0f});
        const auto map_size = static_cast<std::size_t>(shape.map_pitch);
        std::vector<float> maps(6 * map_size);
        for (int map = 0; map < (shape.directional != 0 ? 1 : 6); ++map)
            rasterize(clusters, shape, map, {0, 0, 74, 74},
                      std::span(maps).subspan(static_cast<std::size_t>(map) * map_size, map_size), progress);
        for (std::size_t k = 0; k < surfaces.position.size(); ++k) {
            const vec3 position = surfaces.position[k], normal = surfaces.normal[k];
            const vec3 to_light = scalar_kernel::to_light(record, position, scene.bounds.diagonal());
            const bool asked = scalar_kernel::is_asked(normal, to_light);
            const bool expected = asked && scalar_kernel::is_in_shadow(shape, {maps.data()}, position, normal);
            ASSERT_EQ(result.verdicts.blocked(k, light), expected) << k << ' ' << light;
            rays += asked;
            blocked += expected;
        }
    }
    EXPECT_GT(rays, 100'000u);
    EXPECT_GT(blocked, rays / 10);
    EXPECT_LT(blocked, rays - rays / 10);
}

TEST(ShadowMaps, ErrLessTheFinerTheyAre) {
    const Scene scene = testing::scattered_triangles(60, 3);
    const SurfaceBuffer surfaces = testing::seen_surfaces(scene, {80, 60});
    const std::vector<Light> lights = lights_of_all_kinds(scene.bounds, 40);
    double coarser = 100.0;
    for (const double resolution : {16.0, 64.0, 256.0, 1024.0}) {
        // With offsets that keep surfaces from shadowing themselves at any slope.
        const double error =
            testing::visibility_error(shadow_maps(), scene, surfaces, lights,
                                      {{"resolution", resolution}, {"normal_offset", 1.0}, {"bias", 0.1}});
        EXPECT_LT(error, 0.6 * coarser) << resolution;
        coarser = error;
    }
    EXPECT_LT(coarser, 0.5);
}

TEST(ShadowMaps, TakeAsManyLightsAtOnceAsFitIntoMemory) {
    EXPECT_EQ(lights_at_once(16, 6), 64u);
    EXPECT_GE(lights_at_once(1024, 6), 1u);
    EXPECT_LE(lights_at_once(1024, 6) * 6u * 1024u * 1024u * sizeof(float), maps_at_once_bytes);
    // More lights than are at hand at once: each is still answered by its own maps.
    const Scene scene = testing::wall_in_a_box(2.0f);
    std::vector<Light> lights(70);
    for (std::size_t k = 0; k < lights.size(); ++k) lights[k].position = {k % 2 == 0 ? 1.5f : -0.5f, 0.0f, 0.0f};
    const vec3 position(-1.5f, 0.0f, 0.0f), normal(1, 0, 0);
    const SurfaceBuffer surfaces = testing::surfaces_of(std::span(&position, 1), std::span(&normal, 1));
    const RenderResult result =
        testing::rendered(shadow_maps(), testing::built(shadow_maps(), scene), testing::request_for(surfaces, lights));
    for (std::uint32_t k = 0; k < lights.size(); ++k) EXPECT_EQ(result.verdicts.blocked(0, k), k % 2 == 0) << k;
}

TEST(ShadowMaps, ShadowASlopingFloorOnlyWithoutOffsets) {
    Scene scene;
    testing::add_quad(scene, {-2, -1, -2}, {4, 2, 0}, {0, 0, 4});
    scene = testing::finished(std::move(scene));
    std::vector<vec3> points, normals;
    const vec3 normal = glm::normalize(vec3(-2.0f, 4.0f, 0.0f));
    for (std::uint32_t k = 0; k < 2000; ++k) {
        const float u = 0.1f + 0.8f * random_unit(51, k, 0), v = 0.1f + 0.8f * random_unit(51, k, 1);
        points.push_back(vec3(-2, -1, -2) + u * vec3(4, 2, 0) + v * vec3(0, 0, 4));
        normals.push_back(normal);
    }
    const Light light{.position = {-1.0f, 1.5f, 0.3f}};
    const SurfaceBuffer surfaces = testing::surfaces_of(points, normals);
    const auto blocked = [&](const ParameterValues& parameters) {
        const RenderResult result = testing::rendered(shadow_maps(), testing::built(shadow_maps(), scene, parameters),
                                                      testing::request_for(surfaces, std::span(&light, 1), parameters));
        int count = 0;
        for (std::size_t k = 0; k < points.size(); ++k) count += result.verdicts.blocked(k, 0);
        return count;
    };
    EXPECT_EQ(blocked({{"normal_offset", 1.0}, {"bias", 0.25}}), 0);
    EXPECT_GT(blocked({{"normal_offset", 0.0}, {"bias", 0.0}}), 500);
}

TEST(MapShape, HoldsTheBoundsInADirectionalLightsMap) {
    const Box3 bounds{vec3(-1, 0, -3), vec3(3, 2.5f, 4)};
    for (std::uint32_t k = 0; k < 50; ++k) {
        const vec3 direction = sphere_direction(random_unit(61, k, 0), random_unit(61, k, 1));
        const ShadowMapShape shape = map_shape(light_record({.kind = LightKind::directional, .direction = direction}),
                                               bounds, {64, 0.0f, 0.0f, 0.0f});
        for (std::uint32_t i = 0; i < 100; ++i) {
            const vec3 point = testing::random_point(bounds, 62, i);
            const scalar_kernel::MapPlace place = scalar_kernel::orthographic_place(shape, point - shape.light);
            ASSERT_TRUE(place.x >= 0.9f && place.x <= 63.1f && place.y >= 0.9f && place.y <= 63.1f);
            ASSERT_GT(place.nearness, 0.0f);
        }
    }
}

}  // namespace
}  // namespace sightlines::baselines
