// The kernels as GLSL on a Vulkan device against their scalar compilation.
#include <bit>
#include <cstring>

#include <gtest/gtest.h>

#include "shaders/ray_triangle.h"
#include "shaders/shadow_map.h"
#include "techniques/base/files.h"
#include "techniques/baselines/imperfect_shadow_maps/splatting.h"
#include "techniques/baselines/marching/voxel_grid.h"
#include "techniques/baselines/shadow_maps/map_shapes.h"
#include "techniques/baselines/shadow_maps/rasterizer.h"
#include "techniques/compute/dispatch.h"
#include "techniques/rays/light_records.h"
#include "tests/baselines/pictures.h"

namespace sightlines::baselines {
namespace {

struct ShaderRay {
    vec3 position, normal, light;
};

/// Push constants of kernels.comp.
struct ShaderJob {
    VkDeviceAddress grid, bits, distances, shapes, cube, paraboloids, rays, answers;
    std::uint32_t count, padding;
};

template <class T>
compute::Buffer buffer_of(const std::shared_ptr<const compute::Device>& device, const std::vector<T>& values) {
    compute::Buffer buffer = compute::make_buffer(device, values.size() * sizeof(T), compute::MemoryPlace::host);
    std::memcpy(buffer.mapped.data(), values.data(), values.size() * sizeof(T));
    return buffer;
}

std::vector<std::uint32_t> shader_words() {
    const std::vector<std::uint8_t> bytes = read_file(SIGHTLINES_TEST_SHADER, 1u << 20u);
    std::vector<std::uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
}

/// One scene, all structures, one light.
struct Prepared {
    Scene scene = testing::scattered_triangles(200, 35);
    Light light{.position = {4.0f, 3.0f, 5.0f}};
    Voxelization voxels;
    VoxelGrid grid;
    std::vector<ShadowMapShape> shapes;
    std::vector<float> cube, paraboloids;

    Prepared() {
        Progress progress;
        VoxelOptions options;
        options.resolution = 70;
        options.distances = true;
        voxels = voxelize(scene, options, progress);
        grid = make_query(voxels, {});
        shapes = {map_shape(light_record(light), scene.bounds, {100, 0.5f, 0.25f, 0.0f}),
                  map_shape(light_record(light), scene.bounds, {90, 0.25f, 0.5f, 0.1f})};
        const auto face = static_cast<std::size_t>(shapes[0].map_pitch);
        cube.resize(6 * face);
        const TriangleClusters clusters = make_clusters(scene, progress);
        for (int map = 0; map < 6; ++map)
            rasterize(clusters, shapes[0], map, {0, 0, 99, 99},
                      std::span(cube).subspan(static_cast<std::size_t>(map) * face, face), progress);
        paraboloids.resize(2 * static_cast<std::size_t>(shapes[1].map_pitch));
        PullPushScratch scratch;
        draw_imperfect_maps(sample_points(scene, 5000, 1, 1, 0, progress), 0, shapes[1], {}, paraboloids, scratch);
    }
    std::uint32_t scalar_answer(const ShaderRay& ray) const {
        const bool hits = scalar_kernel::meets_triangle(ray.light, ray.position, vec3(0.0f, -9.0f, -9.0f),
                                                        vec3(0.0f, 9.0f, -9.0f), vec3(0.0f, 0.0f, 9.0f));
        const Segment segment{ray.position, ray.light};
        return std::uint32_t{is_blocked_by_voxels(voxels, grid, segment, ray.normal)} |
               std::uint32_t{is_blocked_by_rows(voxels, grid, segment, ray.normal)} << 1u |
               std::uint32_t{scalar_kernel::is_in_shadow(shapes[0], {cube.data()}, ray.position, ray.normal)} << 2u |
               std::uint32_t{
                   scalar_kernel::is_in_imperfect_shadow(shapes[1], {paraboloids.data()}, ray.position, ray.normal)}
                   << 3u |
               std::uint32_t{hits} << 4u;
    }
};

TEST(BaselineShaders, AnswerAsTheScalarKernelsButForRounding) {
    if (compute::list_devices().empty() || !compute::list_devices().front().lacks.empty())
        GTEST_SKIP() << "no usable Vulkan device";
    const Prepared prepared;
    std::vector<ShaderRay> rays(20'000);
    for (std::uint32_t k = 0; k < rays.size(); ++k)
        rays[k] = {testing::random_point(prepared.scene.bounds, 81, k) - vec3(2.0f, 0.0f, 0.0f),
                   sphere_direction(random_unit(82, k, 0), random_unit(82, k, 1)), prepared.light.position};
    const auto device = compute::open_device();
    const compute::Buffer grid = buffer_of(device, std::vector{prepared.grid}),
                          bits = buffer_of(device, prepared.voxels.bits),
                          distances = buffer_of(device, prepared.voxels.distances),
                          shapes = buffer_of(device, prepared.shapes), cube = buffer_of(device, prepared.cube),
                          paraboloids = buffer_of(device, prepared.paraboloids), asked = buffer_of(device, rays),
                          answers = buffer_of(device, std::vector<std::uint32_t>(rays.size()));
    const compute::Pipeline pipeline = compute::make_pipeline(device, shader_words(), sizeof(ShaderJob), {}, 0);
    const ShaderJob job{grid.address,
                        bits.address,
                        distances.address,
                        shapes.address,
                        cube.address,
                        paraboloids.address,
                        asked.address,
                        answers.address,
                        static_cast<std::uint32_t>(rays.size()),
                        0};
    compute::dispatch(pipeline, std::as_bytes(std::span(&job, 1)),
                      {static_cast<std::uint32_t>((rays.size() + 63) / 64), 1, 1});
    std::array<int, 5> different{}, set{};
    for (std::size_t k = 0; k < rays.size(); ++k) {
        std::uint32_t answer = 0;
        std::memcpy(&answer, answers.mapped.data() + 4 * k, 4);
        const std::uint32_t expected = prepared.scalar_answer(rays[k]);
        for (std::size_t kernel = 0; kernel < 5; ++kernel) {
            different[kernel] += ((answer ^ expected) >> kernel) & 1u;
            set[kernel] += (expected >> kernel) & 1u;
        }
    }
    for (std::size_t kernel = 0; kernel < 5; ++kernel) {
        EXPECT_LE(different[kernel], 20) << "kernel " << kernel;  // a thousandth
        EXPECT_GT(set[kernel], 1000) << "kernel " << kernel;
        EXPECT_LT(set[kernel], 19'000) << "kernel " << kernel;
    }
}

}  // namespace
}  // namespace sightlines::baselines
