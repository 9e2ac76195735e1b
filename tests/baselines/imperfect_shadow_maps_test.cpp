// Imperfect shadow maps: the points, their splats, and look-ups wide against scalar.
#include <cmath>

#include <gtest/gtest.h>

#include "shaders/shadow_map.h"
#include "techniques/baselines/imperfect_shadow_maps/splatting.h"
#include "techniques/baselines/shadow_maps/map_shapes.h"
#include "techniques/rays/light_records.h"
#include "tests/baselines/pictures.h"

namespace sightlines::baselines {
namespace {

PointSamples sampled(const Scene& scene, std::size_t points, std::size_t sets, std::uint64_t seed = 1,
                     int threads = 0) {
    Progress progress;
    return sample_points(scene, points, sets, seed, threads, progress);
}

vec3 point_of(const PointSamples& samples, std::size_t set, std::size_t k) {
    const std::size_t at = set * samples.padded() + k;
    return {samples.position[0][at], samples.position[1][at], samples.position[2][at]};
}

TEST(PointSamples, LieOnTheSurfaceInProportionToItsArea) {
    Scene scene;
    testing::add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 1});  // 3 m^2
    testing::add_quad(scene, {0, 5, 0}, {1, 0, 0}, {0, 0, 1});  // 1 m^2
    const PointSamples samples = sampled(testing::finished(scene), 1000, 4);
    EXPECT_NEAR(samples.area_m2, 4.0, 1e-6);
    EXPECT_NEAR(samples.side_m(), std::sqrt(0.004f), 1e-6f);
    for (std::size_t set = 0; set < 4; ++set) {
        int on_small = 0;
        for (std::size_t k = 0; k < 1000; ++k) {
            const vec3 point = point_of(samples, set, k);
            ASSERT_TRUE(std::abs(point.y) < 1e-5f || std::abs(point.y - 5.0f) < 1e-5f);
            ASSERT_TRUE(point.x >= 0.0f && point.x <= 3.0f && point.z >= 0.0f && point.z <= 1.0f);
            on_small += point.y > 1.0f;
        }
        EXPECT_NEAR(on_small, 250, 1);
    }
}

TEST(PointSamples, DifferFromSetToSetAndFromSeedToSeedButNotWithThreads) {
    const Scene scene = testing::scattered_triangles(50, 2);
    const PointSamples samples = sampled(scene, 500, 3, 1, 1);
    EXPECT_NE(point_of(samples, 0, 7), point_of(samples, 1, 7));
    const PointSamples others = sampled(scene, 500, 3, 2), again = sampled(scene, 500, 3, 1, 2);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(samples.position[axis], again.position[axis]);
        EXPECT_NE(samples.position[axis], others.position[axis]);
    }
}

TEST(PointSamples, AreNoneWithoutSurface) {
    EXPECT_EQ(sampled(Scene{}, 100, 2).points, 0u);
    Scene scene;
    testing::add_triangle(scene, vec3(1.0f), vec3(1.0f), vec3(1.0f));
    EXPECT_EQ(sampled(testing::finished(scene), 100, 2).points, 0u);
}

TEST(Paraboloids, HoldEveryDirectionInOneOfTheirTwoDiscs) {
    const ShadowMapShape shape = map_shape(light_record({.position = {1, 2, 3}}), {}, {128, 0.0f, 0.0f, 0.0f});
    for (std::uint32_t k = 0; k < 5000; ++k) {
        const float distance = 0.1f + 9.0f * random_unit(71, k, 2);
        const vec3 from_light = distance * sphere_direction(random_unit(71, k, 0), random_unit(71, k, 1));
        const scalar_kernel::MapPlace place = scalar_kernel::paraboloid_place(shape, from_light);
        ASSERT_EQ(place.map, from_light.y < 0.0f ? 1 : 0);
        ASSERT_NEAR(place.nearness, 1.0f / distance, 1e-4f / distance);
        ASSERT_LE(std::hypot(place.x - 64.0f, place.y - 64.0f), 64.01f);
        // The middle of the texel, put back into space, is within a texel's angle of the point.
        const vec3 back =
            held_point(shape, place.map, static_cast<int>(place.x), static_cast<int>(place.y), place.nearness, true);
        ASSERT_LT(glm::distance(back - shape.light, from_light), 0.05f * distance);
    }
}

TEST(ImperfectMaps, HoldTheDistanceOfASphereAllAround) {
    const Scene scene = testing::sphere_in_a_box(1.0f, 60);
    const PointSamples samples = sampled(scene, 11000, 1);
    const ShadowMapShape shape = map_shape(light_record(Light{}), scene.bounds, {128, 0.0f, 0.0f, 0.0f});
    std::vector<float> maps(2 * static_cast<std::size_t>(shape.map_pitch));
    PullPushScratch scratch;
    draw_imperfect_maps(samples, 0, shape, {}, maps, scratch);
    for (int map = 0; map < 2; ++map) {
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                if (std::hypot(static_cast<float>(x) - 63.5f, static_cast<float>(y) - 63.5f) > 63.0f) continue;
                const float held = maps[static_cast<std::size_t>(map * shape.map_pitch + y * shape.pitch + x)];
                ASSERT_NEAR(held, 1.0f, 0.02f) << map << ' ' << x << ' ' << y;
            }
        }
    }
}

TEST(ImperfectMaps, AnswerWideAsScalarOnEveryOfAHundredThousandRays) {
    const Scene scene = testing::scattered_triangles(200, 33);
    std::vector<vec3> points(20'011), normals(points.size());
    for (std::uint32_t k = 0; k < points.size(); ++k) {
        points[k] = testing::random_point(scene.bounds, 43, k);
        normals[k] = sphere_direction(random_unit(44, k, 0), random_unit(44, k, 1));
    }
    const SurfaceBuffer surfaces = testing::surfaces_of(points, normals);
    std::vector<Light> lights = testing::random_lights(scene.bounds, 12);
    lights[1].kind = LightKind::directional;
    // One set, so that every light draws it.
    const ParameterValues parameters{{"points", 3000.0}, {"point_sets", 1.0},     {"resolution", 70.0},
                                     {"bias", 0.5},      {"normal_offset", 0.25}, {"splat_size", 0.75}};
    const Technique& technique = imperfect_shadow_maps();
    const RenderResult result = testing::rendered(technique, testing::built(technique, scene, parameters),
                                                  testing::request_for(surfaces, lights, parameters));
    const PointSamples samples = sampled(scene, 3000, 1);
    PullPushScratch scratch;
    SplatOptions options;
    options.size = 0.75f;
    std::uint64_t rays = 0, blocked = 0;
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
        const LightRecord record = light_record(lights[light]);
        const ShadowMapShape shape = map_shape(record, scene.bounds, {70, 0.25f, 0.5f, 0.75f * samples.side_m()});
        std::vector<float> maps(static_cast<std::size_t>(imperfect_maps_of(shape) * shape.map_pitch));
        draw_imperfect_maps(samples, 0, shape, options, maps, scratch);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const vec3 to_light = scalar_kernel::to_light(record, points[k], scene.bounds.diagonal());
            const bool asked = scalar_kernel::is_asked(normals[k], to_light);
            const bool expected =
                asked && scalar_kernel::is_in_imperfect_shadow(shape, {maps.data()}, points[k], normals[k]);
            ASSERT_EQ(result.verdicts.blocked(k, light), expected) << k << ' ' << light;
            rays += asked;
            blocked += expected;
        }
    }
    EXPECT_GT(rays, 100'000u);
    EXPECT_GT(blocked, rays / 10);
    EXPECT_LT(blocked, rays - rays / 10);
}

TEST(ImperfectMaps, ErrLessWithMorePointsAndFinerMaps) {
    const Scene scene = testing::scattered_triangles(60, 3);
    const SurfaceBuffer surfaces = testing::seen_surfaces(scene, {80, 60});
    const std::vector<Light> lights = testing::random_lights(scene.bounds, 40);
    double coarser = 100.0;
    for (const double scale : {1.0, 4.0, 14.0}) {
        // With offsets that keep surfaces from shadowing themselves at any slope but the steepest.
        const double error = testing::visibility_error(imperfect_shadow_maps(), scene, surfaces, lights,
                                                       {{"points", 1000.0 * scale * scale},
                                                        {"resolution", 32.0 * scale},
                                                        {"point_sets", 8.0},
                                                        {"normal_offset", 1.0},
                                                        {"bias", 2.0}});
        EXPECT_LT(error, 0.8 * coarser) << scale;
        coarser = error;
    }
    EXPECT_LT(coarser, 12.0);
}

TEST(ImperfectMaps, DependOnTheSeedOfTheRequest) {
    const Scene scene = testing::scattered_triangles(60, 3);
    const SurfaceBuffer surfaces = testing::seen_surfaces(scene, {64, 48});
    const std::vector<Light> lights = testing::random_lights(scene.bounds, 20);
    const Structure structure = testing::built(imperfect_shadow_maps(), scene);
    RenderRequest request = testing::request_for(surfaces, lights);
    const RenderResult one = testing::rendered(imperfect_shadow_maps(), structure, request);
    request.seed = 2;
    EXPECT_NE(one.verdicts.words, testing::rendered(imperfect_shadow_maps(), structure, request).verdicts.words);
}

}  // namespace
}  // namespace sightlines::baselines
