// The Vulkan backend against the CPU backend: the same samples and masks, hence the same answers but for rays that
// graze.
#include "techniques/visibility_field/vulkan_backend.h"

#include <bit>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "techniques/compute/device.h"
#include "techniques/scene/environment_light.h"
#include "techniques/scene/harmonics.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

#define NEEDS_VULKAN                                                                       \
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty()) \
    GTEST_SKIP() << "no usable Vulkan device"

#define NEEDS_RAY_QUERIES \
    NEEDS_VULKAN;         \
    if (!compute::list_devices().front().queries_rays) GTEST_SKIP() << "no Vulkan device with ray queries"

/// The courtyard, a field of it on both backends, and what is asked.
struct Case {
    Progress progress;
    Scene scene;
    std::shared_ptr<const EmbreeScene> embree;
    SurfaceBuffer surfaces;
    SamplePattern pattern;
    VisibilityField field;
    std::shared_ptr<const FieldOnDevice> device;
    EnvironmentRequest request;

    explicit Case(int samples = 40, bool with_field = true, DeviceRays rays = DeviceRays::tree,
                  Scene scene_ = testing::courtyard())
        : scene(std::move(scene_)),
          embree(test::built(scene)),
          surfaces(test::seen(scene, *embree, testing::courtyard_camera(), {75, 43})),
          pattern(make_pattern(samples, 1)),
          field(testing::baked(scene, *embree, testing::small_bake())),
          device(give_to_vulkan(with_field ? &field : nullptr, *embree, 2, progress, rays)) {
        request.surfaces = &surfaces;
        request.pattern = &pattern;
        request.light.coefficient = {vec3(3.0f, 3.2f, 3.5f),
                                     vec3(1.2f),
                                     vec3(-0.4f),
                                     vec3(0.5f, 0.4f, 0.1f),
                                     vec3(0.2f),
                                     vec3(-0.1f),
                                     vec3(0.3f),
                                     vec3(0.15f),
                                     vec3(-0.2f)};
        request.threads = 2;
        request.keep_verdicts = true;
    }
    EnvironmentResult on_vulkan() { return render_on_vulkan(*device, request, progress); }
    EnvironmentResult on_cpu(bool with_field = true) {
        return render_environment(with_field ? &field : nullptr, *embree, request, progress);
    }
};

/// At most one answer in 50,000 differs; pixels without such rays differ by rounding. Where samples have weights of
/// their own (`share`: of a pixel, by which it may differ) one in 500 may differ by more: a sample at the edge of a
/// map's texel.
void expect_alike(const Case& asked, const EnvironmentResult& cpu, const EnvironmentResult& vulkan,
                  float share = 0.0f) {
    std::uint64_t differing = 0, alike = 0, beyond = 0;
    for (std::size_t p = 0; p < asked.surfaces.size.pixels(); ++p) {
        std::uint64_t differing_here = 0;
        for (std::size_t w = 0; w < cpu.verdicts.words_per_pixel; ++w) {
            const std::size_t at = p * cpu.verdicts.words_per_pixel + w;
            differing_here +=
                static_cast<std::uint64_t>(std::popcount(cpu.verdicts.words[at] ^ vulkan.verdicts.words[at]));
        }
        differing += differing_here;
        if (differing_here > 0 || asked.surfaces.triangle[p] == no_triangle) continue;
        ++alike;
        const float apart = glm::distance(cpu.irradiance.pixels[p], vulkan.irradiance.pixels[p]);
        beyond += apart >= 2e-5f + share * glm::length(cpu.irradiance.pixels[p]);
        const float radiance_apart = glm::distance(cpu.radiance.pixels[p], vulkan.radiance.pixels[p]);
        beyond += radiance_apart >= 1e-5f + share * glm::length(cpu.radiance.pixels[p]);
        ASSERT_FLOAT_EQ(cpu.shadow.pixels[p], vulkan.shadow.pixels[p]) << p;
    }
    EXPECT_LE(beyond, share > 0.0f ? alike / 500 : 0);
    EXPECT_LE(differing, cpu.counts.samples / 50'000);
    EXPECT_GT(alike, 1500u);
    EXPECT_EQ(cpu.counts.samples, vulkan.counts.samples);
    // A direction along the surface or between two texels may fall to either side.
    const auto near = [&](std::uint64_t a, std::uint64_t b) {
        EXPECT_NEAR(static_cast<double>(a), static_cast<double>(b), static_cast<double>(cpu.counts.samples) / 20'000);
    };
    near(cpu.counts.below, vulkan.counts.below);
    near(cpu.counts.traced, vulkan.counts.traced);
    near(cpu.counts.traced_blocked, vulkan.counts.traced_blocked);
    near(cpu.counts.outside, vulkan.counts.outside);
}

TEST(FieldOnVulkan, AgreesWithTheCpuHoweverRaysAreCulled) {
    NEEDS_VULKAN;
    Case asked;
    for (const Culling culling : {Culling::label, Culling::visible, Culling::both})
        for (const Unshadowed unshadowed : {Unshadowed::analytic, Unshadowed::sampled}) {
            asked.request.culling = culling;
            asked.request.unshadowed = unshadowed;
            const EnvironmentResult cpu = asked.on_cpu(), vulkan = asked.on_vulkan();
            EXPECT_LT(cpu.counts.traced, cpu.counts.samples * 9 / 10);
            expect_alike(asked, cpu, vulkan);
        }
}

TEST(FieldOnVulkan, AgreesWithTheCpuOnSamplesOfAnyNumber) {
    NEEDS_VULKAN;
    for (const int samples : {1, 31, 32, 100}) {
        Case asked(samples);
        expect_alike(asked, asked.on_cpu(), asked.on_vulkan());
    }
}

TEST(FieldOnVulkan, TracesAllSamplesWithoutAField) {
    NEEDS_VULKAN;
    Case asked(40, false);
    const EnvironmentResult vulkan = asked.on_vulkan();
    EXPECT_EQ(vulkan.counts.traced, vulkan.counts.samples - vulkan.counts.below);
    expect_alike(asked, asked.on_cpu(false), vulkan);
}

TEST(FieldOnVulkan, GivesTheSamePixelsInAnyOrderOfTilesAndTellsOfEach) {
    NEEDS_VULKAN;
    Case asked;
    const EnvironmentResult once = asked.on_vulkan();
    asked.request.reverse_tiles = true;
    std::size_t reported = 0;
    asked.request.on_region = [&](const EnvironmentResult&, PixelRect changed) {
        reported += static_cast<std::size_t>(changed.width) * static_cast<std::size_t>(changed.height);
    };
    const EnvironmentResult again = asked.on_vulkan();
    EXPECT_EQ(once.irradiance, again.irradiance);
    EXPECT_EQ(once.verdicts.words, again.verdicts.words);
    EXPECT_EQ(once.counts, again.counts);
    EXPECT_EQ(reported, asked.surfaces.size.pixels());
}

TEST(FieldOnVulkan, AnswersSamplesThatHaveWeightsOfTheirOwn) {
    NEEDS_VULKAN;
    Case asked;
    const EnvironmentLight sky = make_environment_light(procedural_sky({}));
    asked.request.distribution = &sky.distribution;
    for (const bool from_map : {false, true})
        for (const bool glossy : {false, true})
            for (const Sampling sampling : {Sampling::cosine, Sampling::brdf, Sampling::map, Sampling::both}) {
                asked.request.map = from_map ? &sky : nullptr;
                asked.request.glossy = glossy;
                asked.request.sampling = sampling;
                const EnvironmentResult cpu = asked.on_cpu();
                EXPECT_LT(cpu.counts.traced, cpu.counts.samples * 9 / 10);
                expect_alike(asked, cpu, asked.on_vulkan(), 1e-4f);
            }
}

/// The courtyard with a sheet whose texture has holes: bars.
Scene courtyard_with_holes() {
    Scene scene = testing::courtyard();
    Texture bars;
    bars.texels = Image<glm::u8vec4>({4, 1}, glm::u8vec4(255));
    bars.texels.at(1, 0).a = bars.texels.at(2, 0).a = 0;
    scene.textures.push_back(bars);
    scene.materials[1].alpha_mode = AlphaMode::mask;
    scene.materials[1].base_color_texture = TextureLookup{.texture = 0, .scale = vec2(9.0f)};
    // Spheres have none of their own.
    scene.texture_coordinates[0].assign(scene.positions.size(), vec2(0.0f));
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        if (scene.triangle_materials[t] == 1)
            for (int corner = 0; corner < 3; ++corner) {
                const vec3 at = scene.positions[scene.triangles[t][corner]];
                scene.texture_coordinates[0][scene.triangles[t][corner]] = {at.z, at.y};
            }
    return scene;
}

TEST(FieldOnVulkan, AgreesWithTheCpuByRayQueries) {
    NEEDS_RAY_QUERIES;
    for (const bool holes : {false, true}) {
        Case asked(100, true, DeviceRays::queries, holes ? courtyard_with_holes() : testing::courtyard());
        ASSERT_EQ(rays_used(*asked.device).rays, DeviceRays::queries);
        for (const Culling culling : {Culling::label, Culling::both}) {
            asked.request.culling = culling;
            expect_alike(asked, asked.on_cpu(), asked.on_vulkan());
        }
    }
    Case all(40, false, DeviceRays::queries);
    expect_alike(all, all.on_cpu(false), all.on_vulkan());
}

TEST(FieldOnVulkan, WantsRayQueriesOfHardwareAndWhatItIsTold) {
    using compute::DeviceKind;
    EXPECT_EQ(device_rays_wanted(DeviceKind::discrete_gpu), DeviceRays::queries);
    EXPECT_EQ(device_rays_wanted(DeviceKind::cpu), DeviceRays::tree);
    setenv("SIGHTLINES_RAY_QUERIES", "0", 1);
    const DeviceRays refused = device_rays_wanted(DeviceKind::discrete_gpu);
    setenv("SIGHTLINES_RAY_QUERIES", "1", 1);
    const DeviceRays asked = device_rays_wanted(DeviceKind::cpu);
    unsetenv("SIGHTLINES_RAY_QUERIES");
    EXPECT_EQ(refused, DeviceRays::tree);
    EXPECT_EQ(asked, DeviceRays::queries);
}

TEST(FieldOnVulkan, SaysWhetherRayQueriesAnswered) {
    NEEDS_RAY_QUERIES;
    Case by_tree, by_queries(40, true, DeviceRays::queries);
    EXPECT_NE(by_tree.on_vulkan().device.find("ray tree"), std::string::npos);
    EXPECT_NE(by_queries.on_vulkan().device.find("ray queries"), std::string::npos);
    EXPECT_GT(rays_used(*by_tree.device).bytes, 10'000u);
    EXPECT_GT(rays_used(*by_queries.device).bytes, 10'000u);
}

TEST(FieldOnVulkan, StopsWhenCancelled) {
    NEEDS_VULKAN;
    Case asked;
    asked.progress.cancel();
    EXPECT_THROW(asked.on_vulkan(), Cancelled);
}

}  // namespace
}  // namespace sightlines::visibility_field
