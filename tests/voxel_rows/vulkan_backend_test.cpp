// The Vulkan backend against the CPU backend: the same kernel, hence the same answers.
#include "techniques/voxel_rows/vulkan_backend.h"

#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "techniques/compute/device.h"
#include "techniques/voxel_rows/dictionary.h"
#include "techniques/voxel_rows/query.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

#define NEEDS_VULKAN                                                                       \
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty()) \
    GTEST_SKIP() << "no usable Vulkan device"

/// Points all over the scene's box with normals all over the sphere; every 50th pixel shows the background.
SurfaceBuffer scattered_surfaces(const Box3& box, ImageSize size) {
    SurfaceBuffer surfaces;
    surfaces.size = size;
    for (std::uint32_t pixel = 0; pixel < size.pixels(); ++pixel) {
        surfaces.position.push_back(testing::random_point(box, 11, pixel));
        surfaces.normal.push_back(sphere_direction(random_unit(12, pixel, 0), random_unit(12, pixel, 1)));
        surfaces.albedo.push_back(vec3(0.2f, 0.5f, 0.8f));
        surfaces.emission.push_back(vec3(pixel % 7 == 0 ? 0.25f : 0.0f));
        surfaces.triangle.push_back(pixel % 50 == 0 ? no_triangle : 0);
    }
    surfaces.shading_normal = surfaces.normal;
    return surfaces;
}

std::vector<Light> scattered_lights(const Box3& box, std::uint32_t count, bool of_all_kinds) {
    std::vector<Light> lights(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        lights[k].position = testing::random_point(box, 13, k);
        lights[k].intensity = vec3(1.0f, 2.0f, 3.0f) * (0.5f + random_unit(14, k, 0));
        if (!of_all_kinds) continue;
        lights[k].kind = static_cast<LightKind>(k % 3);
        lights[k].direction = sphere_direction(random_unit(15, k, 0), random_unit(15, k, 1));
        lights[k].inner_cone_deg = 20.0f;
        lights[k].outer_cone_deg = 60.0f;
        if (k % 5 == 0) lights[k].position += 3.0f * box.size();  // outside the bounds
    }
    return lights;
}

/// An array, what is asked of it, and where it lies on the device.
struct Case {
    Scene scene = testing::scattered_triangles(150, 5);
    RowArray array;
    SurfaceBuffer surfaces;
    std::vector<Light> lights;
    std::shared_ptr<const VulkanRows> on_device;
    RenderRequest request;

    Case(int resolution, std::uint32_t light_count, bool of_all_kinds) {
        Progress progress;
        BuildOptions options;
        options.resolution = resolution;
        options.angle_step_deg = 6.0;
        array = build_from_fragments(scene, options, progress);
        surfaces = scattered_surfaces(scene.bounds, {150, 70});
        lights = scattered_lights(scene.bounds, light_count, of_all_kinds);
        on_device = give_to_vulkan(array, progress);
        request.surfaces = &surfaces;
        request.lights = lights;
        request.keep_verdicts = true;
    }
    /// The same rays asked of the array with a dictionary.
    void compress_array(std::uint32_t dictionary_rows, bool packed) {
        Progress progress;
        array = compress(array, {.rows = dictionary_rows, .packed = packed}, progress);
        on_device = give_to_vulkan(array, progress);
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    RenderResult on_vulkan() const {
        Progress progress;
        return render_on_vulkan(*on_device, array, request, progress);
    }
    RenderResult on_cpu() const {
        Progress progress;
        return render_on_cpu(array, request, progress);
    }
};

std::uint64_t differing_verdicts(const RenderResult& a, const RenderResult& b) {
    std::uint64_t differing = 0;
    for (std::size_t k = 0; k < a.verdicts.words.size(); ++k)
        differing += static_cast<std::uint64_t>(std::popcount(a.verdicts.words[k] ^ b.verdicts.words[k]));
    return differing;
}

/// At least 99.9 % of the rays judged alike, and pictures that differ by no more than those rays and rounding.
void expect_alike(const Case& asked) {
    const RenderResult cpu = asked.on_cpu(), vulkan = asked.on_vulkan();
    ASSERT_GT(cpu.rays, 0u);
    EXPECT_EQ(vulkan.rays_asked, cpu.rays_asked);
    EXPECT_EQ(vulkan.rays, cpu.rays);
    ASSERT_EQ(vulkan.verdicts.words.size(), cpu.verdicts.words.size());
    EXPECT_LE(differing_verdicts(cpu, vulkan), cpu.rays / 1000);
    for (std::size_t pixel = 0; pixel < cpu.radiance.pixels.size(); ++pixel) {
        if (cpu.shadow.pixels[pixel] != vulkan.shadow.pixels[pixel]) continue;
        const vec3 expected = cpu.radiance.pixels[pixel], got = vulkan.radiance.pixels[pixel];
        ASSERT_LE(glm::length(got - expected), 1e-4f * glm::length(expected) + 1e-6f) << "pixel " << pixel;
    }
}

TEST(VulkanBackend, AgreesWithTheCpuOnPointLights) {
    NEEDS_VULKAN;
    expect_alike(Case(128, 100, false));
}

TEST(VulkanBackend, AgreesWithTheCpuOnRowsShorterThanFourWords) {
    NEEDS_VULKAN;
    expect_alike(Case(40, 33, false));
}

TEST(VulkanBackend, AgreesWithTheCpuOnLightsOfAllKindsInsideAndOutsideTheBounds) {
    NEEDS_VULKAN;
    expect_alike(Case(128, 70, true));
}

TEST(VulkanBackend, AgreesWithTheCpuOnTwoRowsPerRay) {
    NEEDS_VULKAN;
    Case asked(128, 40, false);
    asked.request.parameters["subrays"] = 2.0;
    expect_alike(asked);
}

TEST(VulkanBackend, AgreesWithTheCpuOnCompressedRows) {
    NEEDS_VULKAN;
    for (const bool packed : {true, false}) {
        for (const int resolution : {30, 40, 128, 150}) {
            Case asked(resolution, 40, false);
            asked.compress_array(3000, packed);
            expect_alike(asked);
        }
    }
}

TEST(VulkanBackend, GivesTheSamePixelsInAnyOrderOfTilesAndWhenWatched) {
    NEEDS_VULKAN;
    Case asked(64, 65, false);
    const RenderResult once = asked.on_vulkan();
    asked.request.reverse_tiles = true;
    const RenderResult backwards = asked.on_vulkan();
    std::int64_t reported_pixels = 0;
    asked.request.on_region = [&](const RenderResult&, PixelRect changed) {
        reported_pixels += static_cast<std::int64_t>(changed.width) * changed.height;
    };
    const RenderResult watched = asked.on_vulkan();
    for (const RenderResult* other : {&backwards, &watched}) {
        EXPECT_EQ(other->radiance, once.radiance);
        EXPECT_EQ(other->shadow, once.shadow);
        EXPECT_EQ(other->verdicts.words, once.verdicts.words);
    }
    EXPECT_GE(reported_pixels, 150 * 70);
}

TEST(VulkanBackend, CountsWhatItRenders) {
    NEEDS_VULKAN;
    const Case asked(128, 50, false);
    const RenderResult rendered = asked.on_vulkan();
    std::uint64_t blocked = 0;
    for (const std::uint32_t word : rendered.verdicts.words) blocked += static_cast<std::uint64_t>(std::popcount(word));
    const QueryCount count = count_blocked_on_vulkan(*asked.on_device, asked.array, asked.request);
    EXPECT_EQ(count.rays, rendered.rays);
    EXPECT_EQ(count.blocked, blocked);
    EXPECT_GT(count.blocked, 0u);
    EXPECT_LT(count.blocked, count.rays);
}

TEST(VulkanBackend, ShowsOnlyEmissionWithoutLights) {
    NEEDS_VULKAN;
    const Case asked(32, 0, false);
    const RenderResult dark = asked.on_vulkan();
    EXPECT_EQ(dark.rays, 0u);
    EXPECT_EQ(dark.radiance.pixels[7], vec3(0.25f));
    EXPECT_EQ(dark.radiance.pixels[8], vec3(0.0f));
}

TEST(VulkanBackend, StopsWhenCancelled) {
    NEEDS_VULKAN;
    const Case asked(32, 10, false);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(render_on_vulkan(*asked.on_device, asked.array, asked.request, progress), Cancelled);
}

}  // namespace
}  // namespace sightlines::voxel_rows
