// Light by way of one other surface, against analytic answers and the plainest loop.
#include "techniques/visibility_field/one_bounce.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/trace.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

Harmonics even(vec3 radiance) {
    Harmonics light;
    light.coefficient[0] = 2.0f * std::sqrt(pi) * radiance;
    return light;
}

struct Prepared {
    Scene scene;
    std::shared_ptr<const EmbreeScene> embree;
    SurfaceBuffer surfaces;
    SamplePattern pattern;
    EnvironmentRequest request;
    Progress progress;

    Prepared(Scene of, const Camera& camera, int samples, ImageSize size)
        : scene(std::move(of)),
          embree(test::built(scene)),
          surfaces(test::seen(scene, *embree, camera, size)),
          pattern(make_pattern(samples, 1)) {
        request.surfaces = &surfaces;
        request.pattern = &pattern;
        request.light = even(vec3(1.0f));
        request.threads = 2;
    }
    Prepared() : Prepared(testing::courtyard(), testing::courtyard_camera(), 32, {44, 30}) {
        request.light.coefficient[1] = vec3(0.8f, 0.4f, 0.1f);
    }
    EnvironmentResult direct(const VisibilityField* field) {
        return render_environment(field, *embree, request, progress);
    }
    EnvironmentResult lit(const VisibilityField* field) {
        return with_one_bounce(
            field, *embree, scene, request,
            [&](const EnvironmentRequest& asked) { return render_environment(field, *embree, asked, progress); },
            progress);
    }
    VisibilityField field() { return testing::baked(scene, *embree, testing::small_bake()); }
};

TEST(OneBounce, LightsAFloorByAWallAsTheirViewFactorsSay) {
    // Under even light of radiance 1 both see half of the sky and half of each other: irradiance pi / 2, of which the
    // wall's share of the floor's hemisphere, a half, gets albedo times as much again.
    Material grey;
    grey.base_color = vec3(0.6f, 0.3f, 0.9f);
    Scene scene = test::scene_with_material(grey);
    test::add_quad(scene, {0.0f, 0.0f, -2000.0f}, {0.0f, 0.0f, 4000.0f}, {2000.0f, 0.0f, 0.0f});
    test::add_quad(scene, {0.0f, 0.0f, -2000.0f}, {0.0f, 2000.0f, 0.0f}, {0.0f, 0.0f, 4000.0f});
    Prepared corner(std::move(scene), test::camera_at({6.0f, 8.0f, 0.0f}, {6.0f, 0.0f, 0.1f}), 64, {24, 24});
    const EnvironmentResult direct = corner.direct(nullptr), lit = corner.lit(nullptr);
    dvec3 mean_direct(0.0), mean_gained(0.0);
    for (std::size_t p = 0; p < 24 * 24; ++p) {
        ASSERT_NE(corner.surfaces.triangle[p], no_triangle);
        mean_direct += dvec3(direct.irradiance.pixels[p]) / 576.0;
        mean_gained += dvec3(lit.irradiance.pixels[p] - direct.irradiance.pixels[p]) / 576.0;
    }
    EXPECT_NEAR(mean_direct.x, pi / 2, 0.02);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(mean_gained[channel], grey.base_color[channel] * pi / 4, 0.02) << channel;
}

TEST(OneBounce, AddsNothingWhereNothingIsHitOrNoLightComes) {
    Scene floor = test::scene_with_material();
    test::add_quad(floor, {-50.0f, 0.0f, -50.0f}, {0.0f, 0.0f, 100.0f}, {100.0f, 0.0f, 0.0f});
    Prepared open(std::move(floor), test::camera_at({0.0f, 5.0f, 0.1f}, {0.0f, 0.0f, 0.0f}), 32, {16, 16});
    EXPECT_EQ(open.lit(nullptr).irradiance.pixels, open.direct(nullptr).irradiance.pixels);
    EXPECT_EQ(open.lit(nullptr).second_rays, SampleCounts{});
    Prepared dark;
    dark.request.light = {};
    const EnvironmentResult black = dark.lit(nullptr);
    EXPECT_GT(black.second_rays.samples, 1000u);
    for (const vec3 each : black.irradiance.pixels) ASSERT_EQ(each, vec3(0.0f));
}

TEST(OneBounce, IsThatOfThePlainestLoop) {
    Prepared yard;
    yard.request.keep_verdicts = true;
    const EnvironmentResult direct = yard.direct(nullptr), lit = yard.lit(nullptr);
    EXPECT_EQ(lit.verdicts.words, direct.verdicts.words);
    std::uint64_t followed = 0;
    for (std::size_t p = 0; p < yard.surfaces.triangle.size(); ++p) {
        if (yard.surfaces.triangle[p] == no_triangle) continue;
        const vec3 start = lifted_off(*yard.embree, yard.surfaces.position[p], yard.surfaces.normal[p]);
        vec3 expected = direct.irradiance.pixels[p];
        for (int k = 0; k < 32; ++k) {
            const vec3 along = sample_ray(yard.request, p, k).direction;
            if (glm::dot(along, yard.surfaces.normal[p]) <= 0.0f) continue;
            const auto hit = closest_hit(*yard.embree, start, along, 1e9f);
            if (!hit) continue;
            ++followed;
            const SecondRay second = second_ray(yard.scene, yard.request, *hit, start, along, yard.pattern.seed);
            ASSERT_GE(glm::dot(second.direction, second.surface.shading_normal), 0.0f);
            if (glm::dot(second.direction, second.surface.normal) <= 0.0f) continue;
            const vec3 from = lifted_off(*yard.embree, second.surface.position, second.surface.normal);
            if (is_blocked(*yard.embree, from, second.direction)) continue;
            expected += pi / 32.0f * second.surface.albedo * radiance(yard.request.light, second.direction);
        }
        ASSERT_LT(glm::distance(lit.irradiance.pixels[p], expected), 1e-4f) << p;
    }
    EXPECT_EQ(lit.second_rays.samples, followed);
    EXPECT_EQ(lit.second_rays.traced, followed - lit.second_rays.below);
    EXPECT_GT(followed, 5000u);
}

TEST(OneBounce, FieldsSaveSecondRaysAndChangeLittle) {
    Prepared yard;
    const VisibilityField field = yard.field();
    const EnvironmentResult without = yard.lit(nullptr);
    for (const Culling culling : {Culling::label, Culling::visible, Culling::both}) {
        yard.request.culling = culling;
        const EnvironmentResult with = yard.lit(&field);
        const SampleCounts& rays = with.second_rays;
        EXPECT_LT(10 * rays.traced, 9 * (rays.samples - rays.below));
        EXPECT_NEAR(static_cast<double>(rays.samples), static_cast<double>(without.second_rays.samples),
                    0.01 * static_cast<double>(without.second_rays.samples));
        EXPECT_LT(compare_irradiance(with, without, yard.request).rmse_percent(), 1.5);
        std::uint64_t traced = 0;
        for (const std::uint32_t each : with.rays_traced.pixels) traced += each;
        EXPECT_EQ(traced, with.counts.traced + rays.traced);
    }
}

TEST(OneBounce, GainsTheSameLightHoweverSamplesAndSecondRaysAreDrawn) {
    Prepared yard;
    const EnvironmentLight sky = make_environment_light(procedural_sky({}));
    yard.request.light = sky.harmonics;
    const auto mean_gain = [&] {
        const EnvironmentResult direct = yard.direct(nullptr), lit = yard.lit(nullptr);
        double sum = 0.0;
        for (std::size_t p = 0; p < lit.irradiance.pixels.size(); ++p)
            sum += lit.irradiance.pixels[p].y - direct.irradiance.pixels[p].y;
        return sum / static_cast<double>(lit.irradiance.pixels.size());
    };
    const double by_cosine = mean_gain();
    EXPECT_GT(by_cosine, 0.05);
    yard.request.distribution = &sky.distribution;
    yard.request.sampling = Sampling::both;
    EXPECT_NEAR(mean_gain(), by_cosine, 0.03 * by_cosine);
    // The map's sun is small, so that only rays drawn by the map meet it steadily.
    yard.request.map = &sky;
    const double by_map = mean_gain();
    yard.pattern = make_pattern(32, 9);
    EXPECT_NEAR(mean_gain(), by_map, 0.05 * by_map);
}

TEST(OneBounce, DoesNotDependOnThreadsTilesOrderOrVerdicts) {
    Prepared yard;
    const VisibilityField field = yard.field();
    const EnvironmentResult once = yard.lit(&field);
    EXPECT_TRUE(once.verdicts.words.empty());
    yard.request.threads = 1;
    yard.request.reverse_tiles = true;
    yard.request.order = RayOrder::pixel;
    yard.request.keep_verdicts = true;
    const EnvironmentResult again = yard.lit(&field);
    EXPECT_EQ(again.irradiance.pixels, once.irradiance.pixels);
    EXPECT_EQ(again.radiance.pixels, once.radiance.pixels);
    EXPECT_EQ(again.second_rays, once.second_rays);
    EXPECT_FALSE(again.verdicts.words.empty());
}

TEST(OneBounce, IsWhatTheTracesOfThePixelsSamplesAddUpTo) {
    Prepared yard;
    yard.request.culling = Culling::visible;
    const VisibilityField field = yard.field();
    const EnvironmentResult lit = yard.lit(&field);
    std::size_t second_rays = 0;
    for (std::size_t p = 0; p < yard.surfaces.triangle.size(); p += 5) {
        if (yard.surfaces.triangle[p] == no_triangle) continue;
        vec3 sum(0.0f);
        for (int k = 0; k < 32; ++k) {
            const SampleRay ray = sample_ray(yard.request, p, k);
            SampleTrace traced = trace_sample(field, *yard.embree, yard.request.culling, ray);
            const std::size_t steps = traced.trace.steps.size();
            if (traced.trace.blocked && traced.fate != Fate::below_surface)
                add_second_ray(field, *yard.embree, yard.scene, yard.request, yard.pattern.seed, ray, traced);
            second_rays += traced.trace.steps.size() > steps ? 1 : 0;
            sum += traced.adds + pi / 32.0f * traced.comes_back;
        }
        ASSERT_LT(glm::distance(sum, lit.irradiance.pixels[p]), 1e-4f) << p;
    }
    EXPECT_GT(second_rays, 1000u);
}

}  // namespace
}  // namespace sightlines::visibility_field
