// Pictures with a field against pictures without, and against plain loops.
#include "techniques/visibility_field/render.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "shaders/harmonic_light.h"
#include "shaders/hemisphere.h"
#include "techniques/base/error.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/measure.h"
#include "techniques/visibility_field/trace.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

Harmonics sunny() {
    Harmonics light;
    light.coefficient = {vec3(3.0f, 3.2f, 3.5f),
                         vec3(1.2f),
                         vec3(-0.4f),
                         vec3(0.5f, 0.4f, 0.1f),
                         vec3(0.2f),
                         vec3(-0.1f),
                         vec3(0.3f),
                         vec3(0.15f),
                         vec3(-0.2f)};
    return light;
}

struct Prepared {
    Scene scene = testing::courtyard();
    std::shared_ptr<const EmbreeScene> embree = test::built(scene);
    SurfaceBuffer surfaces;
    SamplePattern pattern;
    EnvironmentRequest request;
    Progress progress;

    explicit Prepared(int samples = 48, ImageSize size = {75, 43})
        : surfaces(test::seen(scene, *embree, testing::courtyard_camera(), size)), pattern(make_pattern(samples, 1)) {
        request.surfaces = &surfaces;
        request.pattern = &pattern;
        request.light = sunny();
        request.threads = 2;
    }
    EnvironmentResult picture(const VisibilityField* field) {
        return render_environment(field, *embree, request, progress);
    }
    VisibilityField field(std::uint32_t points, int mask_size = 18) {
        BakeOptions options = testing::small_bake();
        options.points = points;
        options.mask_size = mask_size;
        return testing::baked(scene, *embree, options);
    }
};

TEST(SamplePattern, HoldsUnitDirectionsWhoseMeanIsTheCosines) {
    const SamplePattern pattern = make_pattern(100, 1);
    ASSERT_EQ(pattern.x.size(), 112u);
    dvec3 mean(0.0);
    for (std::size_t k = 0; k < 100; ++k) {
        const vec3 direction(pattern.x[k], pattern.y[k], pattern.z[k]);
        ASSERT_NEAR(glm::length(direction), 1.0f, 1e-6f);
        mean += dvec3(direction) / 100.0;
    }
    EXPECT_NEAR(mean.z, 2.0 / 3.0, 0.01);
    EXPECT_NEAR(mean.x, 0.0, 0.02);
    EXPECT_EQ(pattern.turns.size(), 4096u);
    EXPECT_THROW(make_pattern(0, 1), InputError);
    EXPECT_THROW(make_pattern(4097, 1), InputError);
}

TEST(HarmonicLight, SendsWhatTheHarmonicsDo) {
    const Harmonics harmonics = sunny();
    const HarmonicLight light = harmonic_light(harmonics);
    for (std::uint32_t k = 0; k < 100; ++k) {
        const vec3 direction = sphere_direction(random_unit(41, k, 0), random_unit(41, k, 1));
        scalar_kernel::HarmonicMoments moments = scalar_kernel::no_moments();
        scalar_kernel::add_direction(moments, direction, 1.0f);
        vec3 sum(0.0f);
        for (int term = 0; term < harmonic_terms; ++term) sum += moments.of[term] * light.term[term];
        EXPECT_LT(glm::distance(sum, radiance(harmonics, direction)), 1e-5f);
    }
}

/// The pixel's irradiance and how many samples are blocked, one ray after the other.
vec3 plainly(const Prepared& prepared, std::size_t pixel, std::uint32_t& asked) {
    const SamplePattern& pattern = prepared.pattern;
    const SurfaceBuffer& surfaces = prepared.surfaces;
    const auto x = static_cast<int>(pixel) % surfaces.size.width, y = static_cast<int>(pixel) / surfaces.size.width;
    const vec2 turn = pattern.turns[pattern.tile_place(x, y)];
    const scalar_kernel::HemisphereFrame frame =
        scalar_kernel::frame_about(surfaces.shading_normal[pixel], turn.x, turn.y);
    const vec3 start = lifted_off(*prepared.embree, surfaces.position[pixel], surfaces.normal[pixel]);
    vec3 sum(0.0f);
    asked = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(pattern.samples); ++k) {
        const vec3 direction = scalar_kernel::direction_in(frame, pattern.x[k], pattern.y[k], pattern.z[k]);
        if (glm::dot(direction, surfaces.normal[pixel]) <= 0.0f) continue;
        ++asked;
        if (!is_blocked(*prepared.embree, start, direction)) sum += radiance(prepared.request.light, direction);
    }
    return sum * (pi / static_cast<float>(pattern.samples));
}

TEST(EnvironmentPicture, WithoutAFieldIsThatOfPlainLoops) {
    for (const int samples : {1, 48, 100}) {
        Prepared prepared(samples);
        const EnvironmentResult result = prepared.picture(nullptr);
        std::uint64_t all = 0, lit = 0;
        for (std::size_t p = 0; p < prepared.surfaces.size.pixels(); ++p) {
            if (prepared.surfaces.triangle[p] == no_triangle) {
                ASSERT_EQ(result.irradiance.pixels[p], vec3(0.0f));
                continue;
            }
            std::uint32_t asked = 0;
            const vec3 expected = plainly(prepared, p, asked);
            ASSERT_LT(glm::distance(result.irradiance.pixels[p], expected), 1e-4f) << p;
            const vec3 radiance = prepared.surfaces.albedo[p] * result.irradiance.pixels[p] / pi;
            ASSERT_LT(glm::distance(result.radiance.pixels[p], radiance), 1e-5f);
            ASSERT_EQ(result.rays_traced.pixels[p], asked);
            all += asked;
            lit += expected.x > 0.0f;
        }
        EXPECT_EQ(result.counts.traced, all);
        EXPECT_EQ(result.counts.outside, all);
        EXPECT_GT(lit, 1000u);
    }
}

TEST(EnvironmentPicture, OfAnOpenPlaneIsTheUnshadowedIrradiance) {
    Scene scene = testing::one_sided_scene();
    test::add_quad(scene, {-2.0f, 0.0f, -2.0f}, {0.0f, 0.0f, 4.0f}, {4.0f, 0.0f, 0.0f});
    const auto embree = test::built(scene);
    const SurfaceBuffer surfaces =
        test::seen(scene, *embree, test::camera_at({0.0f, 5.0f, 3.0f}, {0.0f, 0.0f, 0.0f}), {60, 40});
    const SamplePattern pattern = make_pattern(256, 1);
    const VisibilityField field = testing::baked(scene, *embree, testing::small_bake());
    EnvironmentRequest request;
    request.surfaces = &surfaces;
    request.pattern = &pattern;
    request.light = sunny();
    Progress progress;
    const vec3 expected = irradiance(request.light, {0.0f, 1.0f, 0.0f});
    const EnvironmentResult with = render_environment(&field, *embree, request, progress);
    const EnvironmentResult without = render_environment(nullptr, *embree, request, progress);
    EXPECT_EQ(with.counts.traced, 0u);  // every cell is open, so that only the occluded region would be traced
    for (std::size_t p = 0; p < surfaces.size.pixels(); ++p) {
        if (surfaces.triangle[p] == no_triangle) continue;
        ASSERT_LT(glm::distance(with.irradiance.pixels[p], expected), 1e-5f);
        ASSERT_LT(glm::distance(without.irradiance.pixels[p], expected), 0.01f * expected.x);
    }
}

class Cullings : public ::testing::TestWithParam<Culling> {};

TEST_P(Cullings, TraceFewerRaysAndGiveThePictureOfTheSameSamples) {
    Prepared prepared;
    prepared.request.culling = GetParam();
    prepared.request.unshadowed = Unshadowed::sampled;
    const VisibilityField field = prepared.field(60'000);
    const EnvironmentResult reference = prepared.picture(nullptr), ours = prepared.picture(&field);
    const IrradianceError error = compare_irradiance(ours, reference, prepared.request);
    EXPECT_LT(error.rmse_percent(), 0.3);
    EXPECT_GT(error.mean_unshadowed, error.mean_reference);
    EXPECT_LT(ours.counts.traced, reference.counts.traced * 9 / 10);
    EXPECT_EQ(ours.counts.samples, reference.counts.samples);
    EXPECT_EQ(ours.counts.below, reference.counts.below);
    EXPECT_LT(ours.counts.outside, ours.counts.traced / 10);
}

TEST_P(Cullings, DifferFromTheReferenceWhereARayIsListedAsWrongOnly) {
    Prepared prepared;
    prepared.request.culling = GetParam();
    prepared.request.unshadowed = Unshadowed::sampled;
    const VisibilityField field = prepared.field(1500);
    const EnvironmentResult reference = prepared.picture(nullptr), ours = prepared.picture(&field);
    const WrongRays wrong = find_wrong_rays(field, *prepared.embree, prepared.request, 1'000'000, prepared.progress);
    EXPECT_EQ(wrong.discarded, ours.counts.discarded());
    ASSERT_EQ(wrong.wrong, wrong.first.size());
    EXPECT_GT(wrong.wrong, 10u);
    std::vector<vec3> expected = reference.irradiance.pixels;
    for (const WrongRay& ray : wrong.first) {
        const float sign = ray.taken_for_blocked ? -1.0f : 1.0f;
        expected[ray.pixel] +=
            sign * pi / static_cast<float>(prepared.pattern.samples) * radiance(prepared.request.light, ray.direction);
    }
    for (std::size_t p = 0; p < expected.size(); ++p)
        ASSERT_LT(glm::distance(ours.irradiance.pixels[p], expected[p]), 2e-4f) << p;
    EXPECT_EQ(find_wrong_rays(field, *prepared.embree, prepared.request, 3, prepared.progress).first.size(), 3u);
}

TEST_P(Cullings, AreTheSameOnAnyThreadsTilesAndLayout) {
    Prepared prepared;
    prepared.request.culling = GetParam();
    const VisibilityField field = prepared.field(6000);
    const EnvironmentResult first = prepared.picture(&field);
    prepared.request.threads = 1;
    prepared.request.reverse_tiles = true;
    const EnvironmentResult second = prepared.picture(&field);
    EXPECT_EQ(first.irradiance, second.irradiance);
    EXPECT_EQ(first.counts, second.counts);
    const DenseField dense = to_dense(field);
    prepared.request.dense = &dense;
    const EnvironmentResult third = prepared.picture(&field);
    EXPECT_EQ(first.irradiance, third.irradiance);
    EXPECT_EQ(first.rays_traced, third.rays_traced);
}

INSTANTIATE_TEST_SUITE_P(All, Cullings, ::testing::Values(Culling::label, Culling::visible, Culling::both));

TEST(EnvironmentPicture, ByBothMasksTracesNoMoreThanByTheLabel) {
    Prepared prepared;
    const VisibilityField field = prepared.field(30'000);
    const EnvironmentResult by_label = prepared.picture(&field);
    prepared.request.culling = Culling::both;
    const EnvironmentResult by_both = prepared.picture(&field);
    EXPECT_LT(by_both.counts.traced, by_label.counts.traced);
}

TEST(EnvironmentPicture, AnalyticUnshadowedIrradianceChangesOnlyCellsOfLabelZero) {
    Prepared prepared;
    const VisibilityField field = prepared.field(30'000);
    const EnvironmentResult analytic = prepared.picture(&field);
    prepared.request.unshadowed = Unshadowed::sampled;
    const EnvironmentResult sampled = prepared.picture(&field);
    int changed = 0, kept = 0;
    for (int y = 0; y < prepared.surfaces.size.height; ++y) {
        for (int x = 0; x < prepared.surfaces.size.width; ++x) {
            const auto p = static_cast<std::size_t>(y * prepared.surfaces.size.width + x);
            if (prepared.surfaces.triangle[p] == no_triangle) continue;
            const SampleTrace traced = trace_sample(field, *prepared.embree, prepared.request, x, y, 0);
            const float difference = glm::distance(analytic.irradiance.pixels[p], sampled.irradiance.pixels[p]);
            ASSERT_TRUE(traced.label == 0 || difference == 0.0f);
            ASSERT_LT(difference, 0.1f);
            (difference > 0.0f ? changed : kept) += 1;
        }
    }
    EXPECT_GT(changed, 100);
    EXPECT_GT(kept, 100);
}

TEST(EnvironmentPicture, OutsideTheCellsOfAFieldEverythingIsTraced) {
    Prepared prepared;
    const VisibilityField nothing = prepared.field(0);
    const EnvironmentResult reference = prepared.picture(nullptr), ours = prepared.picture(&nothing);
    EXPECT_EQ(ours.irradiance, reference.irradiance);
    EXPECT_EQ(ours.counts.outside, reference.counts.traced);
}

TEST(EnvironmentPicture, CountingSamplesCountsWhatRenderingTraces) {
    Prepared prepared;
    const VisibilityField field = prepared.field(6000);
    double seconds = 0.0;
    SampleCounts counted = count_samples(&field, prepared.request, seconds);
    const SampleCounts rendered = prepared.picture(&field).counts;
    counted.traced_blocked = rendered.traced_blocked;
    EXPECT_EQ(counted, rendered);
    EXPECT_GT(rendered.traced_blocked, 0u);
    EXPECT_GT(seconds, 0.0);
}

TEST(EnvironmentPicture, IsTheSameInEveryOrderOfRays) {
    Prepared prepared;
    const VisibilityField field = prepared.field(6000);
    prepared.request.order = RayOrder::direction;
    const EnvironmentResult sorted = prepared.picture(&field), sorted_without = prepared.picture(nullptr);
    prepared.request.order = RayOrder::pixel;
    EXPECT_EQ(prepared.picture(&field).irradiance, sorted.irradiance);
    EXPECT_EQ(prepared.picture(nullptr).irradiance, sorted_without.irradiance);
}

TEST(EnvironmentPicture, MeasuringComparesBothWays) {
    Prepared prepared;
    const FieldMeasurement measured =
        measure(prepared.field(6000), *prepared.embree, prepared.request, 2, prepared.progress);
    EXPECT_LT(measured.with.traced, measured.without.traced);
    EXPECT_EQ(measured.with.samples, measured.without.samples);
    EXPECT_GT(measured.seconds_sampling, 0.0);
    EXPECT_GT(measured.seconds_with, 0.0);
    EXPECT_GT(measured.error.mean_unshadowed, measured.error.mean_reference);
    EXPECT_GT(measured.error.mean_reference, 0.0);
}

TEST(EnvironmentPicture, StopsWhenCancelled) {
    Prepared prepared;
    prepared.progress.cancel();
    EXPECT_THROW(prepared.picture(nullptr), Cancelled);
}

}  // namespace
}  // namespace sightlines::visibility_field
