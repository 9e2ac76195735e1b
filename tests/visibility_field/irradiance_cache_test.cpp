// Few pixels are asked and the rest interpolated, but nowhere across an edge, and nothing else is noticed of it.
#include "techniques/visibility_field/irradiance_cache.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/visibility_field/visibility_field.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Light of the same radiance from everywhere.
Harmonics even_light(float radiance) {
    Harmonics light;
    light.coefficient[0] = vec3(radiance * 2.0f * std::sqrt(pi));
    return light;
}

Scene floor_only() {
    Scene scene = test::scene_with_material();
    test::add_quad(scene, {-20.0f, 0.0f, -20.0f}, {0.0f, 0.0f, 40.0f}, {40.0f, 0.0f, 0.0f});
    return scene;
}

Scene box_on_floor() {
    Scene scene = floor_only();
    test::add_box(scene, {-1.0f, 0.0f, -1.0f}, {1.0f, 1.5f, 1.0f});
    return scene;
}

/// A scene as one camera sees it, asked without a field.
struct Asked {
    Scene scene;
    std::shared_ptr<const EmbreeScene> embree;
    SurfaceBuffer surfaces;
    SamplePattern pattern;
    EnvironmentRequest request;
    Progress progress;

    Asked(Scene made, const Camera& camera, ImageSize size, int samples)
        : scene(std::move(made)),
          embree(test::built(scene)),
          surfaces(test::seen(scene, *embree, camera, size)),
          pattern(make_pattern(samples, 1)) {
        request.surfaces = &surfaces;
        request.pattern = &pattern;
        request.light = even_light(0.5f);
        request.threads = 2;
    }
    Renderer renderer() {
        return [this](const EnvironmentRequest& each) { return render_environment(nullptr, *embree, each, progress); };
    }
    EnvironmentResult all() { return renderer()(request); }
    EnvironmentResult cached(int spacing, float tolerance) {
        return render_cached({spacing, tolerance}, request, renderer());
    }
    double share(const EnvironmentResult& result) const {
        std::size_t seen = 0;
        for (const std::uint32_t triangle : surfaces.triangle) seen += triangle != no_triangle ? 1 : 0;
        return static_cast<double>(result.counts.samples) /
               static_cast<double>(seen * static_cast<std::size_t>(pattern.samples));
    }
};

Camera above_floor() { return test::camera_at({0.0f, 6.0f, 0.1f}, {0.0f, 0.0f, 0.0f}); }
Camera beside_box() { return test::camera_at({3.0f, 3.5f, 4.5f}, {0.0f, 0.4f, 0.0f}); }

void expect_same_pictures(const EnvironmentResult& one, const EnvironmentResult& other) {
    EXPECT_EQ(one.irradiance.pixels, other.irradiance.pixels);
    EXPECT_EQ(one.radiance.pixels, other.radiance.pixels);
    EXPECT_EQ(one.shadow.pixels, other.shadow.pixels);
    EXPECT_EQ(one.rays_traced.pixels, other.rays_traced.pixels);
    EXPECT_EQ(one.counts, other.counts);
}

TEST(IrradianceCache, WithoutToleranceAsksEveryPixelOnceAndChangesNoBit) {
    Asked asked(testing::courtyard(), testing::courtyard_camera(), {45, 31}, 32);
    const EnvironmentResult all = asked.all(), cached = asked.cached(8, 0.0f);
    expect_same_pictures(cached, all);
    EXPECT_EQ(cached.rays_asked.pixels, all.rays_asked.pixels);
    EXPECT_LT(asked.share(asked.cached(8, 0.1f)), 0.9);
}

TEST(IrradianceCache, OfAFlatEvenlyLitFloorAsksOnePixelOfEachBlockAndIsExactEverywhere) {
    for (const int spacing : {2, 4, 8, 16}) {
        Asked asked(floor_only(), above_floor(), {129, 65}, 32);
        const EnvironmentResult cached = asked.cached(spacing, 0.05f);
        const int across = 128 / spacing + 1, down = 64 / spacing + 1;
        EXPECT_EQ(cached.counts.samples, static_cast<std::uint64_t>(32 * across * down));
        for (std::size_t p = 0; p < cached.irradiance.pixels.size(); ++p) {
            ASSERT_NE(asked.surfaces.triangle[p], no_triangle);
            ASSERT_NEAR(cached.irradiance.pixels[p].y, 0.5f * pi, 1e-4f) << p;
            const vec3 reflected = asked.surfaces.emission[p] + asked.surfaces.albedo[p] * 0.5f;
            ASSERT_NEAR(cached.radiance.pixels[p].y, reflected.y, 1e-4f);
            ASSERT_EQ(cached.rays_asked.pixels[p], 32u);
            ASSERT_EQ(cached.shadow.pixels[p], 0.0f);
        }
    }
}

TEST(IrradianceCache, RoundsItsSpacingDownToAPowerOfTwoAndIsOffBelowTwo) {
    Asked asked(floor_only(), above_floor(), {65, 33}, 16);
    expect_same_pictures(asked.cached(15, 0.05f), asked.cached(8, 0.05f));
    expect_same_pictures(asked.cached(1, 0.05f), asked.all());
    EXPECT_EQ(asked.share(asked.cached(1, 0.05f)), 1.0);
}

TEST(IrradianceCache, OfPicturesWhoseSizeIsNoMultipleOfItReachesTheLastRowAndColumn) {
    for (const ImageSize size : {ImageSize{1, 1}, ImageSize{3, 2}, ImageSize{17, 9}, ImageSize{30, 19}}) {
        Asked asked(floor_only(), above_floor(), size, 16);
        const EnvironmentResult cached = asked.cached(8, 0.05f);
        for (const vec3& irradiance : cached.irradiance.pixels) ASSERT_NEAR(irradiance.y, 0.5f * pi, 1e-4f);
    }
}

TEST(IrradianceCache, KeepsTheLightOfBoxAndFloorApart) {
    Asked asked(box_on_floor(), beside_box(), {160, 96}, 256);
    const EnvironmentResult all = asked.all(), cached = asked.cached(8, 0.1f);
    EXPECT_LT(asked.share(cached), 0.3);
    // An upright side of the box gets half of the light at most, but for the noise. Mixed with the top's it would have
    // more.
    const auto is_side = [&](std::size_t pixel) {
        return asked.surfaces.triangle[pixel] != no_triangle && std::fabs(asked.surfaces.normal[pixel].y) < 0.5f;
    };
    float brightest_side = 0.0f;
    for (std::size_t p = 0; p < all.irradiance.pixels.size(); ++p)
        if (is_side(p)) brightest_side = std::max(brightest_side, all.irradiance.pixels[p].y);
    EXPECT_LT(brightest_side, 0.6f * 0.5f * pi);
    std::size_t sides = 0, tops = 0;
    double squares = 0.0;
    for (std::size_t p = 0; p < all.irradiance.pixels.size(); ++p) {
        if (asked.surfaces.triangle[p] == no_triangle) continue;
        const float ours = cached.irradiance.pixels[p].y, truth = all.irradiance.pixels[p].y;
        ASSERT_NEAR(ours, truth, 0.12f * 0.5f * pi) << p;
        squares += static_cast<double>(ours - truth) * static_cast<double>(ours - truth);
        if (is_side(p)) {
            ++sides;
            ASSERT_LE(ours, brightest_side + 1e-5f) << p;
        } else if (asked.surfaces.position[p].y > 1.0f) {
            ++tops;
            ASSERT_NEAR(ours, 0.5f * pi, 1e-3f) << p;
        }
    }
    EXPECT_GT(sides, 1000u);
    EXPECT_GT(tops, 400u);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(all.irradiance.pixels.size())), 0.02 * 0.5 * pi);
}

TEST(IrradianceCache, AsksMoreWhereTheToleranceIsLess) {
    Asked asked(box_on_floor(), beside_box(), {160, 96}, 64);
    const double strict = asked.share(asked.cached(8, 0.01f)), usual = asked.share(asked.cached(8, 0.04f)),
                 lax = asked.share(asked.cached(8, 1.0f));
    EXPECT_GT(strict, 2.0 * usual);
    EXPECT_GT(usual, 1.01 * lax);
}

TEST(IrradianceCache, TracesNothingWhereItInterpolates) {
    Asked asked(box_on_floor(), beside_box(), {160, 96}, 64);
    const EnvironmentResult all = asked.all(), cached = asked.cached(8, 0.1f);
    std::uint64_t traced = 0;
    std::size_t untraced = 0;
    for (std::size_t p = 0; p < all.irradiance.pixels.size(); ++p) {
        traced += cached.rays_traced.pixels[p];
        if (cached.rays_traced.pixels[p] == 0) {
            ++untraced;
            continue;
        }
        ASSERT_EQ(cached.irradiance.pixels[p], all.irradiance.pixels[p]);
        ASSERT_EQ(cached.shadow.pixels[p], all.shadow.pixels[p]);
    }
    EXPECT_EQ(traced, cached.counts.traced);
    EXPECT_GT(untraced, all.irradiance.pixels.size() / 2);
}

TEST(IrradianceCache, DoesNotDependOnThreadsTilesOrWhoWatches) {
    Asked asked(testing::courtyard(), testing::courtyard_camera(), {100, 70}, 32);
    const EnvironmentResult once = asked.cached(8, 0.1f);
    asked.request.threads = 1;
    asked.request.reverse_tiles = true;
    int passes = 0;
    std::size_t dark = 0;
    asked.request.on_region = [&](const EnvironmentResult& so_far, PixelRect changed) {
        EXPECT_EQ(changed, (PixelRect{0, 0, 100, 70}));
        if (++passes == 1)
            for (std::size_t p = 0; p < so_far.irradiance.pixels.size(); ++p)
                dark += asked.surfaces.triangle[p] != no_triangle && so_far.irradiance.pixels[p] == vec3(0.0f);
        if (passes == 4) {
            EXPECT_EQ(so_far.irradiance.pixels, once.irradiance.pixels);
        }
    };
    const EnvironmentResult again = asked.cached(8, 0.1f);
    expect_same_pictures(again, once);
    EXPECT_EQ(again.rays_asked.pixels, once.rays_asked.pixels);
    EXPECT_EQ(passes, 4);
    EXPECT_LT(dark, again.irradiance.pixels.size() / 50);  // the first pass fills in what it has not asked
}

TEST(IrradianceCache, GivesVerdictsOfEveryPixelButTheSamePicture) {
    Asked asked(testing::courtyard(), testing::courtyard_camera(), {60, 40}, 48);
    const EnvironmentResult without = asked.cached(4, 0.1f);
    asked.request.keep_verdicts = true;
    const EnvironmentResult with = asked.cached(4, 0.1f), all = asked.all();
    expect_same_pictures(with, without);
    EXPECT_TRUE(without.verdicts.words.empty());
    EXPECT_EQ(with.verdicts.words, all.verdicts.words);
    EXPECT_EQ(with.rays_asked.pixels, all.rays_asked.pixels);
    EXPECT_LT(with.counts.samples, all.counts.samples);
}

TEST(IrradianceCache, AsksGlossySurfacesEverywhere) {
    Asked asked(floor_only(), above_floor(), {64, 48}, 32);
    asked.request.sampling = Sampling::brdf;
    EXPECT_LT(asked.share(asked.cached(8, 0.5f)), 0.5);
    asked.request.glossy = true;
    asked.request.roughness = 0.4f;
    expect_same_pictures(asked.cached(8, 0.5f), asked.all());
    EXPECT_EQ(asked.share(asked.cached(8, 0.5f)), 1.0);
}

/// The technique's own row, built over the courtyard.
struct Courtyard {
    Scene scene = testing::courtyard();
    std::shared_ptr<const EmbreeScene> embree = test::built(scene);
    SurfaceBuffer surfaces = test::seen(scene, *embree, testing::courtyard_camera(), {80, 48});
    EnvironmentLight light = make_environment_light(procedural_sky({}));
    Progress progress;
    Structure structure;

    RenderRequest request(const ParameterValues& more) {
        RenderRequest made;
        made.parameters = {{"points", 6000.0}, {"rays_per_point", 64.0}, {"samples", 48.0}};
        for (const auto& [name, value] : more) made.parameters[name] = value;
        made.surfaces = &surfaces;
        made.scene = &scene;
        made.environment = &light;
        made.threads = 2;
        if (!structure.has_value())
            structure = technique().build({.scene = &scene, .parameters = made.parameters, .threads = 2}, progress);
        return made;
    }
    RenderResult picture(const ParameterValues& more) {
        const RenderRequest made = request(more);
        return technique().render(structure, made, progress);
    }
};

TEST(IrradianceCache, IsOffByDefaultAndNeverTheReferences) {
    Courtyard field;
    const RenderResult usual = field.picture({}), off = field.picture({{"cache_spacing", 0.0}}),
                       on = field.picture({{"cache_spacing", 8.0}});
    EXPECT_EQ(usual.radiance.pixels, off.radiance.pixels);
    EXPECT_LT(on.rays, usual.rays * 9 / 10);
    EXPECT_LT(on.rays_traced, usual.rays_traced);
    const RenderRequest with = field.request({{"cache_spacing", 8.0}}), without = field.request({});
    const auto reference = technique().environment->reference;
    EXPECT_EQ(reference(*field.embree, with, field.progress).radiance.pixels,
              reference(*field.embree, without, field.progress).radiance.pixels);
}

TEST(IrradianceCache, HoldsLightByWayOfOtherSurfacesAndIsDenoisedAfterwards) {
    Courtyard field;
    const ParameterValues wide{{"cache_spacing", 8.0}};
    const auto with = [](ParameterValues values, const char* name, double value) {
        values[name] = value;
        return values;
    };
    const RenderResult direct = field.picture(wide), indirect = field.picture(with(wide, "indirect", 1.0)),
                       all = field.picture({{"indirect", 1.0}}), smooth = field.picture(with(wide, "denoise", 2.0));
    double direct_sum = 0.0, indirect_sum = 0.0, all_sum = 0.0;
    for (std::size_t p = 0; p < all.radiance.pixels.size(); ++p) {
        direct_sum += static_cast<double>(direct.radiance.pixels[p].y);
        indirect_sum += static_cast<double>(indirect.radiance.pixels[p].y);
        all_sum += static_cast<double>(all.radiance.pixels[p].y);
    }
    EXPECT_GT(indirect_sum, 1.02 * direct_sum);
    EXPECT_NEAR(indirect_sum / all_sum, 1.0, 0.02);
    EXPECT_LT(indirect.rays, all.rays);
    EXPECT_NE(smooth.radiance.pixels, direct.radiance.pixels);
    EXPECT_EQ(smooth.rays, direct.rays);
    EXPECT_EQ(field.picture(with(with(wide, "indirect", 1.0), "cache_tolerance", 0.0)).radiance.pixels,
              all.radiance.pixels);
}

TEST(IrradianceCache, RefusesParametersOutOfRange) {
    const auto refuses = [](const char* name, const char* text) {
        try {
            parse_parameter(technique().parameters, name, text);
            return false;
        } catch (const InputError&) {
            return true;
        }
    };
    for (const char* text : {"-1", "17", "2.5", "wide"}) EXPECT_TRUE(refuses("cache_spacing", text)) << text;
    for (const char* text : {"-0.1", "101", "nan"}) EXPECT_TRUE(refuses("cache_tolerance", text)) << text;
    EXPECT_FALSE(refuses("cache_spacing", "16"));
    EXPECT_FALSE(refuses("cache_tolerance", "2.5"));
    Courtyard field;
    for (const ParameterValues& bad : {ParameterValues{{"cache_spacing", 17.0}}, {{"cache_tolerance", -1.0}}})
        EXPECT_THROW(technique().build({.scene = &field.scene, .parameters = bad, .threads = 2}, field.progress),
                     InputError);
}

}  // namespace
}  // namespace sightlines::visibility_field
