// The row of the catalog against the library that it stands on.
#include <numbers>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/compute/device.h"
#include "techniques/visibility_field/visibility_field.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

constexpr ImageSize size{40, 24};

/// The courtyard, built and asked by the technique's own row.
struct Asked {
    Scene scene = testing::courtyard();
    std::shared_ptr<const EmbreeScene> embree = test::built(scene);
    SurfaceBuffer surfaces = test::seen(scene, *embree, testing::courtyard_camera(), size);
    EnvironmentLight light = make_environment_light(procedural_sky({}));
    ParameterValues parameters{{"points", 6000.0}, {"rays_per_point", 64.0}, {"samples", 48.0}};
    Structure structure;
    std::any samples;
    RenderRequest request;
    Progress progress;

    explicit Asked(const ParameterValues& more = {}) {
        for (const auto& [name, value] : more) parameters[name] = value;
        structure = technique().build({.scene = &scene, .parameters = parameters, .threads = 2}, progress);
        samples = technique().environment->samples(parameters, 1);
        request.surfaces = &surfaces;
        request.scene = &scene;
        request.samples = &samples;
        request.environment = &light;
        request.parameters = parameters;
        request.keep_verdicts = true;
        request.threads = 2;
    }
    RenderResult picture() { return technique().render(structure, request, progress); }
    RenderResult reference() { return technique().environment->reference(*embree, request, progress); }
    bool shows_surface(std::size_t pixel) const { return surfaces.triangle[pixel] != no_triangle; }
};

TEST(FieldTechnique, PaintsWhatTheLibraryPaints) {
    Asked asked;
    const SamplePattern pattern = make_pattern(48, 1);
    EnvironmentRequest request;
    request.surfaces = &asked.surfaces;
    request.pattern = &pattern;
    request.light = asked.light.harmonics;
    request.unshadowed = Unshadowed::sampled;
    BakeOptions options = testing::small_bake();
    options.dilation = 0.33f;
    const auto embree = build_embree_scene(asked.scene, EmbreeUse::benchmark, 2, asked.progress);
    const VisibilityField field = bake(asked.scene, *embree, options, asked.progress);
    const EnvironmentResult expected = render_environment(&field, *embree, request, asked.progress);
    asked.request.samples = nullptr;  // made by itself
    const RenderResult ours = asked.picture();
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        if (!asked.shows_surface(p)) continue;
        ASSERT_EQ(ours.radiance.pixels[p], glm::max(expected.radiance.pixels[p], vec3(0.0f)));
        ASSERT_EQ(ours.traced.pixels[p], expected.rays_traced.pixels[p]);
    }
    EXPECT_EQ(ours.rays_traced, expected.counts.traced);
    EXPECT_EQ(ours.rays, expected.counts.samples - expected.counts.below);
    EXPECT_LT(ours.rays_traced, ours.rays);
}

TEST(FieldTechnique, DiffersFromTheReferenceOnlyWhereAnAnswerDoes) {
    for (const double culling : {0.0, 1.0, 2.0}) {
        Asked asked({{"culling", culling}});
        const RenderResult ours = asked.picture(), truth = asked.reference();
        ASSERT_EQ(ours.verdicts.words_per_pixel, 2u);
        std::size_t alike = 0;
        for (std::size_t p = 0; p < size.pixels(); ++p) {
            if (!asked.shows_surface(p)) {
                ASSERT_EQ(ours.radiance.pixels[p], truth.radiance.pixels[p]);
                ASSERT_EQ(ours.rays_asked.pixels[p], 0u);
                continue;
            }
            ASSERT_EQ(ours.rays_asked.pixels[p], truth.rays_asked.pixels[p]);
            ASSERT_EQ(truth.traced.pixels[p], truth.rays_asked.pixels[p]);
            std::uint32_t blocked = 0;
            bool same = true;
            for (std::uint32_t k = 0; k < 48; ++k) {
                blocked += ours.verdicts.blocked(p, k);
                same = same && ours.verdicts.blocked(p, k) == truth.verdicts.blocked(p, k);
            }
            ASSERT_FLOAT_EQ(ours.shadow.pixels[p] * static_cast<float>(ours.rays_asked.pixels[p]),
                            static_cast<float>(blocked));
            if (!same) continue;
            ++alike;
            ASSERT_LT(glm::distance(ours.radiance.pixels[p], truth.radiance.pixels[p]), 1e-4f) << culling;
        }
        EXPECT_GT(alike, size.pixels() / 4);
        EXPECT_LT(compare(ours, truth).visibility_percent, 3.0);
    }
}

TEST(FieldTechnique, TracesWhatItPaints) {
    for (const double culling : {0.0, 2.0}) {
        Asked asked({{"culling", culling}});
        const RenderResult ours = asked.picture();
        int rays = 0;
        for (std::size_t p = 0; p < size.pixels(); p += 3) {
            if (!asked.shows_surface(p)) continue;
            const std::vector<Light> samples = technique().environment->lights(asked.request, p);
            ASSERT_EQ(samples.size(), 48u);
            for (std::uint32_t k = 0; k < samples.size(); ++k) {
                if (glm::dot(asked.surfaces.normal[p], samples[k].direction) >= 0.0f) continue;
                const Trace trace = technique().trace(
                    asked.structure,
                    {asked.surfaces.position[p], asked.surfaces.normal[p], samples[k], asked.parameters});
                ASSERT_EQ(trace.blocked, ours.verdicts.blocked(p, k)) << p << " " << k;
                ++rays;
            }
        }
        EXPECT_GT(rays, 5000);
    }
}

TEST(FieldTechnique, PaintsOnVulkanWhatItPaintsOnTheCpuWhereverItWasBuilt) {
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty())
        GTEST_SKIP() << "no usable Vulkan device";
    Asked asked;
    const RenderResult cpu = asked.picture();
    asked.request.backend = Backend::vulkan;
    const RenderResult built_for_cpu = asked.picture();
    asked.structure = technique().build(
        {.scene = &asked.scene, .parameters = asked.parameters, .backend = Backend::vulkan, .threads = 2},
        asked.progress);
    const RenderResult built_for_vulkan = asked.picture();
    EXPECT_EQ(built_for_cpu.verdicts.words, built_for_vulkan.verdicts.words);
    EXPECT_NE(built_for_vulkan.device, cpu.device);
    EXPECT_EQ(built_for_vulkan.rays, cpu.rays);
    EXPECT_LT(built_for_vulkan.rays_traced, built_for_vulkan.rays);
    EXPECT_LT(compare(built_for_vulkan, cpu).visibility_percent, 0.1);
    EXPECT_LT(compare(built_for_vulkan, cpu).rmse, 1e-3);
}

TEST(FieldTechnique, AddsUpTheSamplesThatItTellsOfHoweverTheyAreDrawn) {
    for (const ParameterValues& more :
         {ParameterValues{{"sampling", 2.0}, {"light_from", 1.0}}, ParameterValues{{"surface", 1.0}, {"sampling", 3.0}},
          ParameterValues{{"surface", 1.0}, {"sampling", 1.0}, {"roughness", 0.3}, {"light_from", 1.0}}}) {
        Asked asked(more);
        const RenderResult ours = asked.picture(), truth = asked.reference();
        EXPECT_LT(compare(ours, truth).visibility_percent, 3.0);
        const bool glossy = more.contains("surface");
        for (std::size_t p = 0; p < size.pixels(); p += 7) {
            if (!asked.shows_surface(p)) continue;
            const std::vector<Light> samples = technique().environment->lights(asked.request, p);
            vec3 sum(0.0f);
            for (std::uint32_t k = 0; k < samples.size(); ++k) {
                if (glm::dot(asked.surfaces.normal[p], samples[k].direction) >= 0.0f) continue;
                if (!ours.verdicts.blocked(p, k)) sum += samples[k].intensity;
                const Trace trace = technique().trace(
                    asked.structure,
                    {asked.surfaces.position[p], asked.surfaces.normal[p], samples[k], asked.parameters});
                ASSERT_EQ(trace.blocked, ours.verdicts.blocked(p, k));
            }
            const vec3 share = glossy ? vec3(1.0f) : asked.surfaces.albedo[p];
            const vec3 expected = glm::max(vec3(0.0f), share * sum / std::numbers::pi_v<float>);
            ASSERT_LT(glm::distance(ours.radiance.pixels[p], expected), 1e-4f + 1e-4f * glm::length(expected));
        }
    }
}

TEST(FieldTechnique, TakesNoiseOutWhereAsked) {
    Asked noisy({{"samples", 16.0}}), smooth({{"samples", 16.0}, {"denoise", 2.0}}), fine({{"samples", 256.0}});
    const RenderResult truth = fine.picture();
    EXPECT_EQ(noisy.picture().verdicts.words, smooth.picture().verdicts.words);
    const auto error = [&](const RenderResult& result) {
        double sum = 0.0;
        for (std::size_t p = 0; p < size.pixels(); ++p)
            sum += glm::distance(result.radiance.pixels[p], truth.radiance.pixels[p]);
        return sum;
    };
    EXPECT_LT(error(smooth.picture()), 0.9 * error(noisy.picture()));
}

TEST(FieldTechnique, LightsSurfacesByEachOtherOnBothBackendsWhereAsked) {
    const auto sum = [](const RenderResult& result) {
        double all = 0.0;
        for (const vec3 each : result.radiance.pixels) all += each.y;
        return all;
    };
    Asked direct, indirect({{"indirect", 1.0}});
    const RenderResult ours = indirect.picture(), truth = indirect.reference();
    EXPECT_GT(sum(ours), 1.02 * sum(direct.picture()));
    EXPECT_EQ(ours.verdicts.words, direct.picture().verdicts.words);
    EXPECT_NEAR(sum(ours), sum(truth), 0.01 * sum(truth));
    EXPECT_GT(ours.rays, direct.picture().rays);
    EXPECT_LT(ours.rays_traced, truth.rays_traced);
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty())
        GTEST_SKIP() << "no usable Vulkan device";
    indirect.request.backend = Backend::vulkan;
    EXPECT_LT(compare(indirect.picture(), ours).rmse, 2e-3);
}

TEST(FieldTechnique, GoesOnInTheTraceWithWhatABlockedSampleHit) {
    Asked asked({{"indirect", 1.0}});
    const RenderResult ours = asked.picture();
    int followed = 0;
    for (std::size_t p = 0; p < size.pixels(); p += 11) {
        if (!asked.shows_surface(p)) continue;
        const std::vector<Light> samples = technique().environment->lights(asked.request, p);
        for (std::uint32_t k = 0; k < samples.size(); k += 5) {
            if (glm::dot(asked.surfaces.normal[p], samples[k].direction) >= 0.0f) continue;
            const Trace trace =
                technique().trace(asked.structure, {asked.surfaces.position[p], asked.surfaces.normal[p], samples[k],
                                                    asked.parameters, &asked.scene, &asked.light, asked.request.seed});
            const bool goes_on = trace.steps.back().paper == "Section 6, indirect illumination";
            ASSERT_TRUE(!goes_on || ours.verdicts.blocked(p, k));
            followed += goes_on;
        }
    }
    EXPECT_GT(followed, 50);
}

TEST(FieldTechnique, TellsInTheTraceWhichSampleShouldHaveSeenAWrongRay) {
    Asked asked({{"points", 1000.0}, {"rays_per_point", 16.0}, {"dilation", 0.0}});
    const RenderResult ours = asked.picture(), truth = asked.reference();
    int told = 0;
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        if (!asked.shows_surface(p)) continue;
        for (std::uint32_t k = 0; k < 48; ++k) {
            if (ours.verdicts.blocked(p, k) == truth.verdicts.blocked(p, k)) continue;
            const Light sample = technique().environment->lights(asked.request, p)[k];
            const Trace trace = technique().trace(
                asked.structure, {asked.surfaces.position[p], asked.surfaces.normal[p], sample, asked.parameters});
            told += trace.steps.back().sentence.find("nearest point sample") != std::string::npos;
        }
    }
    EXPECT_GT(told, 20);
}

TEST(FieldTechnique, NamesCellMasksDecisionAndWhatTheSampleAddsInTheTrace) {
    Asked asked;
    const std::size_t p = 18 * 40 + 20;
    const Light sample = technique().environment->lights(asked.request, p)[7];
    const Trace trace = technique().trace(
        asked.structure, {asked.surfaces.position[p], asked.surfaces.normal[p], sample, asked.parameters});
    std::string all;
    for (const TraceStep& step : trace.steps)
        for (const TraceValue& value : step.values) all += value.name + ";";
    for (const char* name : {"cell.index", "cell.label", "place.u", "place.v", "texel.column", "texel.row",
                             "bits.visible", "bits.occluded", "decision.trace", "blocked", "adds"})
        EXPECT_NE(all.find(name), std::string::npos) << name << " in " << all;
}

TEST(FieldTechnique, DenoisesGlossySurfacesWithoutTheirTexture) {
    const ParameterValues glossy{{"surface", 1.0}, {"sampling", 1.0}, {"denoise", 3.0}};
    Asked even(glossy), striped(glossy);
    for (vec3& albedo : even.surfaces.albedo) albedo = vec3(0.3f);
    for (std::size_t p = 0; p < size.pixels(); ++p) striped.surfaces.albedo[p] = vec3(p % 2 == 0 ? 0.3f : 0.33f);
    const RenderResult without = even.picture(), with = striped.picture();
    double sums[2][2] = {};
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        if (!even.shows_surface(p)) continue;
        sums[0][p % 2] += without.radiance.pixels[p].y;
        sums[1][p % 2] += with.radiance.pixels[p].y;
    }
    // The filter, which takes so little for noise, would make both about 1.04.
    EXPECT_LT(sums[1][0] / sums[0][0], 1.02);
    EXPECT_GT(sums[1][1] / sums[0][1], 1.06);
}

TEST(FieldTechnique, AnswersAlikeInBothLayouts) {
    Asked packed, dense({{"layout", 1.0}});
    EXPECT_EQ(packed.picture().verdicts.words, dense.picture().verdicts.words);
    const Statistics small = technique().statistics(packed.structure), large = technique().statistics(dense.structure);
    EXPECT_EQ(large.structure_bytes, small.uncompressed_bytes);
    EXPECT_LT(4 * small.structure_bytes, large.structure_bytes);
}

TEST(FieldTechnique, DoesNotDependOnThreadsTilesOrWhoWatches) {
    Asked asked;
    const RenderResult once = asked.picture();
    asked.request.threads = 1;
    asked.request.reverse_tiles = true;
    std::size_t seen = 0;
    asked.request.on_region = [&](const RenderResult& so_far, PixelRect changed) {
        seen += static_cast<std::size_t>(changed.width) * static_cast<std::size_t>(changed.height);
        EXPECT_EQ(so_far.radiance.at(changed.x, changed.y), once.radiance.at(changed.x, changed.y));
    };
    const RenderResult again = asked.picture();
    EXPECT_EQ(again.radiance.pixels, once.radiance.pixels);
    EXPECT_EQ(again.verdicts.words, once.verdicts.words);
    EXPECT_EQ(again.shadow.pixels, once.shadow.pixels);
    EXPECT_EQ(seen, size.pixels());
}

TEST(FieldTechnique, ShowsTheTurnedEnvironmentBehindTheScene) {
    Asked asked;
    asked.surfaces.triangle.assign(size.pixels(), no_triangle);
    asked.light = turned(asked.light, 90.0f);
    const RenderResult picture = asked.picture();
    const Segment ray = camera_ray(asked.surfaces.camera, size, {20.5f, 2.5f}, 1.0f);
    const vec3 direction = glm::normalize(ray.target - ray.origin);
    // Turned from -Z towards +X: what is seen in a direction stood a quarter further left.
    const vec3 before(direction.z, direction.y, -direction.x);
    const vec3 expected = radiance_from(*asked.light.map, before);
    EXPECT_LT(glm::distance(picture.radiance.at(20, 2), expected), 1e-3f * glm::length(expected));
    EXPECT_EQ(picture.rays, 0u);
}

TEST(FieldTechnique, RefusesCellsThatNeedMoreMemoryThanThereIs) {
    Scene scene = testing::courtyard();
    Progress progress;
    const auto build = [&](const ParameterValues& parameters) {
        technique().build({.scene = &scene, .parameters = parameters}, progress);
    };
    EXPECT_THROW(build({{"cell_size", 0.0}}), InputError);
    scene.positions.push_back(vec3(1e5f));
    scene.bounds.add(vec3(1e5f));
    EXPECT_THROW(build({{"cell_size", 0.01}}), EnvironmentError);
}

}  // namespace
}  // namespace sightlines::visibility_field
