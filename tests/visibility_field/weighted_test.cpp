// Samples with weights of their own: glossy surfaces and maps with all their contrasts.
#include "techniques/visibility_field/weighted_samples.h"

#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "shaders/weighted_samples.h"
#include "techniques/base/hammersley.h"
#include "techniques/scene/map_sampling.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

EnvironmentLight sunny_light(float radius_deg) {
    SkyOptions options;
    options.size = {128, 64};
    options.sun_radius_deg = radius_deg;
    options.sun_share = 0.8f;
    return turned(make_environment_light(procedural_sky(options)), 40.0f);
}

/// The courtyard, partly metal, under a sky with a sun.
struct Prepared {
    Progress progress;
    Scene scene = courtyard_of_metal();
    std::shared_ptr<const EmbreeScene> embree = test::built(scene);
    SurfaceBuffer surfaces = test::seen(scene, *embree, testing::courtyard_camera(), {40, 24});
    EnvironmentLight light = sunny_light(4.0f);
    SamplePattern pattern;
    EnvironmentRequest request;

    explicit Prepared(int samples = 64) {
        request.surfaces = &surfaces;
        request.distribution = &light.distribution;
        request.light = light.harmonics;
        request.threads = 2;
        request.unshadowed = Unshadowed::sampled;
        set_samples(samples);
    }
    Prepared(const Prepared&) = delete;
    Prepared& operator=(const Prepared&) = delete;

    static Scene courtyard_of_metal() {
        Scene scene = testing::courtyard();
        scene.materials[1].metallic = 1.0f;
        for (Material& material : scene.materials) material.roughness = 0.5f;
        return scene;
    }
    void set_samples(int samples) {
        pattern = make_pattern(samples, 1);
        request.pattern = &pattern;
    }
    EnvironmentResult picture(const VisibilityField* field = nullptr) {
        return render_environment(field, *embree, request, progress);
    }
    EnvironmentResult drawn_by(Sampling sampling, int samples) {
        request.sampling = sampling;
        set_samples(samples);
        return picture();
    }
    double mean(const EnvironmentResult& result) const {
        double sum = 0.0;
        for (const vec3 pixel : result.irradiance.pixels) sum += pixel.x + pixel.y + pixel.z;
        return sum;
    }
    double error(const EnvironmentResult& result, const EnvironmentResult& truth) const {
        return compare_irradiance(result, truth, request).rmse;
    }
};

TEST(WeightedSamples, ByTheCosineAreThePapers) {
    Prepared prepared(48);
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, testing::small_bake());
    for (const VisibilityField* used : {static_cast<const VisibilityField*>(nullptr), &field})
        for (const Culling culling : {Culling::label, Culling::visible, Culling::both}) {
            prepared.request.culling = culling;
            const EnvironmentResult papers = prepared.picture(used);
            const EnvironmentResult weighted =
                render_weighted(used, *prepared.embree, prepared.request, prepared.progress);
            EXPECT_NEAR(static_cast<double>(papers.counts.traced), static_cast<double>(weighted.counts.traced), 3.0);
            EXPECT_EQ(papers.counts.samples, weighted.counts.samples);
            EXPECT_LT(prepared.error(weighted, papers), 1e-3);
        }
}

TEST(WeightedSamples, DrawnInAnyWayComeToTheSamePicture) {
    Prepared prepared;
    prepared.request.map = &prepared.light;
    for (const bool glossy : {false, true}) {
        prepared.request.glossy = glossy;
        const EnvironmentResult brute = prepared.drawn_by(Sampling::cosine, 4096);
        for (const Sampling sampling : {Sampling::brdf, Sampling::map, Sampling::both}) {
            const EnvironmentResult drawn = prepared.drawn_by(sampling, 2048);
            EXPECT_NEAR(prepared.mean(drawn) / prepared.mean(brute), 1.0, 0.006) << glossy << int(sampling);
            EXPECT_LT(prepared.error(drawn, brute),
                      0.1 * compare_irradiance(drawn, brute, prepared.request).mean_reference)
                << glossy << int(sampling);
        }
    }
}

TEST(WeightedSamples, DrawnByTheMapAreLessNoisyUnderASun) {
    Prepared prepared;
    prepared.request.map = &prepared.light;
    const EnvironmentResult truth = prepared.drawn_by(Sampling::both, 4096);
    const double cosine = prepared.error(prepared.drawn_by(Sampling::cosine, 64), truth);
    EXPECT_LT(prepared.error(prepared.drawn_by(Sampling::map, 64), truth), cosine / 3.0);
    EXPECT_LT(prepared.error(prepared.drawn_by(Sampling::both, 64), truth), cosine / 3.0);
}

TEST(WeightedSamples, DrawnByTheSurfaceAreLessNoisyOnGlossyOnes) {
    Prepared prepared;
    prepared.request.map = &prepared.light;
    prepared.request.glossy = true;
    prepared.request.roughness = 0.2f;
    const EnvironmentResult truth = prepared.drawn_by(Sampling::both, 4096);
    const double cosine = prepared.error(prepared.drawn_by(Sampling::cosine, 64), truth);
    const double map = prepared.error(prepared.drawn_by(Sampling::map, 64), truth);
    const double both = prepared.error(prepared.drawn_by(Sampling::both, 64), truth);
    EXPECT_LT(both, cosine / 2.0);
    EXPECT_LT(both, map);
}

TEST(WeightedSamples, FieldsCullThemAsThePapers) {
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.points = 60'000;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, options);
    prepared.request.map = &prepared.light;
    for (const bool glossy : {false, true})
        for (const Sampling sampling : {Sampling::cosine, Sampling::brdf, Sampling::map, Sampling::both}) {
            prepared.request.glossy = glossy;
            prepared.request.sampling = sampling;
            const EnvironmentResult reference = prepared.picture(), ours = prepared.picture(&field);
            EXPECT_LT(ours.counts.traced, reference.counts.traced * 19 / 20) << glossy << int(sampling);
            EXPECT_LT(prepared.error(ours, reference),
                      0.02 * compare_irradiance(ours, reference, prepared.request).mean_reference);
        }
}

TEST(WeightedSamples, OfGlossySurfacesIgnoreLabels) {
    Prepared prepared;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, testing::small_bake());
    prepared.request.glossy = true;
    const EnvironmentResult by_label = prepared.picture(&field);
    prepared.request.culling = Culling::visible;
    const EnvironmentResult by_visible = prepared.picture(&field);
    EXPECT_EQ(by_label.counts, by_visible.counts);
    EXPECT_EQ(by_label.irradiance, by_visible.irradiance);
}

TEST(WeightedSamples, DoNotDependOnThreadsOrTiles) {
    Prepared prepared;
    prepared.request.map = &prepared.light;
    prepared.request.glossy = true;
    prepared.request.sampling = Sampling::both;
    prepared.request.keep_verdicts = true;
    const EnvironmentResult first = prepared.picture();
    prepared.request.threads = 1;
    prepared.request.reverse_tiles = true;
    const EnvironmentResult second = prepared.picture();
    EXPECT_EQ(first.irradiance, second.irradiance);
    EXPECT_EQ(first.verdicts.words, second.verdicts.words);
    EXPECT_EQ(first.counts, second.counts);
}

/// Samples as the scalar compilation draws and weighs them.
std::vector<PixelSample> scalar_samples(const EnvironmentRequest& request, std::size_t index) {
    namespace kernel = scalar_kernel;
    const WeightedTables tables = weighted_tables(request);
    const WeightedPixel pixel = weighted_pixel(request, index);
    const kernel::Surroundings light{tables.texels != nullptr, tables.harmonics, {tables.map, {tables.texels}}};
    kernel::MapDraws draws{};
    if (const MapDistribution* from = tables.draws)
        draws = {from->shape,
                 {from->tables->rows.data()},
                 {from->tables->heights.data()},
                 {from->tables->columns.data()},
                 {from->tables->density.data()}};
    std::vector<PixelSample> samples;
    const auto draw = [&](std::uint32_t way, std::uint32_t count) {
        for (std::uint32_t k = 0; k < count; ++k) {
            const float u = (static_cast<float>(k) + 0.5f) * (1.0f / static_cast<float>(count));
            const float v = radical_inverse(k) + 0.5f / static_cast<float>(std::bit_ceil(count));
            const kernel::DrawnSample drawn = kernel::draw_sample(pixel.surface, draws, way, u, v);
            samples.push_back({-pixel.surface.normal, vec3(0.0f)});
            if (drawn.above)
                samples.back() = {drawn.direction, kernel::weighed(pixel.surface, light, draws, drawn.direction)};
        }
    };
    draw(kernel::drawn_by_cosine, pixel.cosine);
    draw(kernel::drawn_by_facets, pixel.mirrored);
    draw(kernel::drawn_by_map, pixel.map);
    return samples;
}

TEST(WeightedSamples, AreTheSameToTheLastBitByVectorsAndOneByOne) {
    Prepared prepared(45);
    for (const bool by_map : {false, true})
        for (const bool glossy : {false, true})
            for (const Sampling sampling : {Sampling::cosine, Sampling::brdf, Sampling::map, Sampling::both}) {
                prepared.request.map = by_map ? &prepared.light : nullptr;
                prepared.request.glossy = glossy;
                prepared.request.sampling = sampling;
                int compared = 0, differing = 0;
                for (std::size_t p = 0; p < prepared.surfaces.size.pixels(); p += 7) {
                    if (prepared.surfaces.triangle[p] == no_triangle) continue;
                    const std::vector<PixelSample> wide = weighted_samples(prepared.request, p);
                    const std::vector<PixelSample> scalar = scalar_samples(prepared.request, p);
                    ASSERT_EQ(wide.size(), scalar.size());
                    for (std::size_t k = 0; k < wide.size(); ++k) {
                        differing += wide[k].direction != scalar[k].direction || wide[k].adds != scalar[k].adds;
                        ASSERT_NEAR(glm::length(wide[k].direction), 1.0f, 1e-5f);
                        ++compared;
                    }
                }
                EXPECT_EQ(differing, 0) << by_map << glossy << int(sampling);
                EXPECT_GT(compared, 3000);
            }
}

TEST(WeightedSamples, AMirrorShowsTheSky) {
    Material mirror;
    mirror.metallic = 1.0f;
    mirror.base_color = vec3(1.0f);
    Scene scene = test::scene_with_material(mirror);
    test::add_quad(scene, {-5.0f, 0.0f, -5.0f}, {0.0f, 0.0f, 10.0f}, {10.0f, 0.0f, 0.0f});
    const auto embree = test::built(scene);
    const SurfaceBuffer surfaces =
        test::seen(scene, *embree, test::camera_at({0.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 0.0f}), {20, 12});
    Prepared prepared(256);
    const EnvironmentLight even =
        make_environment_light(make_environment("even", ImageRgb({8, 4}, vec3(2.0f, 3.0f, 4.0f))));
    prepared.request.surfaces = &surfaces;
    prepared.request.map = &even;
    prepared.request.glossy = true;
    prepared.request.roughness = 0.1f;
    prepared.request.sampling = Sampling::brdf;
    const EnvironmentResult result = render_environment(nullptr, *embree, prepared.request, prepared.progress);
    for (std::size_t p = 0; p < surfaces.size.pixels(); ++p) {
        if (surfaces.triangle[p] == no_triangle) continue;
        ASSERT_LT(glm::distance(result.radiance.pixels[p], vec3(2.0f, 3.0f, 4.0f)), 0.05f) << p;
    }
}

}  // namespace
}  // namespace sightlines::visibility_field
