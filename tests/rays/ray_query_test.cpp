// The device's own ray queries over a scene's triangles: against answers known beforehand and Embree. Skipped by name
// where the device has none.
#include "techniques/compute/ray_scene.h"

#include <array>
#include <cstdlib>

#include "shaders/ray_tree_data.h"
#include "techniques/rays/open_rays.h"
#include "techniques/rays/ray_tree.h"
#include "techniques/scene/builtin_scenes.h"
#include "tests/rays/device_rays.h"

namespace sightlines {
namespace {

using test::buffer_of;
using test::TestRay;

#define NEEDS_RAY_QUERIES \
    NEEDS_VULKAN;         \
    if (!compute::list_devices().front().queries_rays) GTEST_SKIP() << "no Vulkan device with ray queries"

/// Push constants of ray_queries.comp.
struct ShaderJob {
    VkDeviceAddress nodes, triangles, cutouts;
    std::uint32_t node_count, count;
    VkDeviceAddress rays, answers, ray_scene;
};

/// Whether each ray is blocked.
std::vector<std::uint32_t> answers(const std::shared_ptr<const compute::Device>& device, const EmbreeScene& embree,
                                   const std::vector<TestRay>& rays) {
    const TriangleTables tables = list_triangles(embree);
    const compute::Buffer opaque = buffer_of(device, tables.opaque, compute::holds_triangles),
                          masked = buffer_of(device, tables.masked, compute::holds_triangles),
                          cutouts = buffer_of(device, tables.cutouts), asked = buffer_of(device, rays),
                          given = buffer_of(device, std::vector<std::uint32_t>(rays.size(), 7));
    const auto count = [](const std::vector<uvec4>& corners) { return static_cast<std::uint32_t>(corners.size() / 3); };
    const std::array<compute::TriangleList, 2> lists{
        {{&opaque, sizeof(uvec4), count(tables.opaque), true}, {&masked, sizeof(uvec4), count(tables.masked), false}}};
    const compute::RayScene scene = compute::build_ray_scene(device, lists);
    const compute::Pipeline pipeline =
        compute::make_pipeline(device, test::test_shader("ray_queries"), sizeof(ShaderJob));
    const auto ray_count = static_cast<std::uint32_t>(rays.size());
    const ShaderJob job{0,         masked.address, cutouts.address, 0,
                        ray_count, asked.address,  given.address,   scene.address()};
    compute::dispatch(pipeline, std::as_bytes(std::span(&job, 1)), {(ray_count + 63) / 64, 1, 1});
    std::vector<std::uint32_t> result(rays.size());
    std::memcpy(result.data(), given.mapped.data(), result.size() * 4);
    return result;
}

std::vector<std::uint32_t> answers(const Scene& scene, const std::vector<TestRay>& rays) {
    return answers(compute::open_device(), *test::built(scene), rays);
}

TEST(RayQueries, AnswerRaysAtABoxOfWhichTheAnswersAreKnown) {
    NEEDS_RAY_QUERIES;
    Scene scene = test::scene_with_material();
    test::add_box(scene, {-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f});
    EXPECT_EQ(answers(scene, {{{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}},
                              {{0.2f, 5.0f, 0.1f}, {0.0f, -1.0f, 0.0f}},
                              {{0.2f, 5.0f, 0.1f}, {0.0f, 1.0f, 0.0f}},
                              {{1.5f, 5.0f, 0.1f}, {0.0f, -1.0f, 0.0f}},
                              {{5.0f, 1.001f, 0.0f}, {-1.0f, 0.0f, 0.0f}},
                              {{5.0f, 0.999f, 0.0f}, {-1.0f, 0.0f, 0.0f}},
                              {{1.0e5f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}}}),
              (std::vector<std::uint32_t>{1, 1, 0, 0, 0, 1, 1}));
}

TEST(RayQueries, OfNothingAreBlockedByNothing) {
    NEEDS_RAY_QUERIES;
    EXPECT_EQ(answers(test::scene_with_material(), {{vec3(0.0f), vec3(0.0f, 1.0f, 0.0f)}}),
              std::vector<std::uint32_t>{0});
}

/// How many answers differ from Embree's. `hits`: rays that are blocked.
int differing_from_embree(const Scene& scene, std::uint32_t count, int& hits) {
    const auto embree = test::built(scene);
    const std::vector<TestRay> rays = test::random_rays(scene.bounds, count);
    const std::vector<std::uint32_t> found = answers(compute::open_device(), *embree, rays);
    int differing = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        differing += found[k] != std::uint32_t{is_blocked(*embree, rays[k].origin, rays[k].direction)};
        hits += found[k] == 1;
    }
    return differing;
}

TEST(RayQueries, AnswerAsEmbreeDoesInBuiltInScenes) {
    NEEDS_RAY_QUERIES;
    for (const char* name : {"cornell", "atrium", "trees", "garden"}) {
        Progress progress;
        int hits = 0;
        const int differing = differing_from_embree(find_scene(name, progress).at(0.0), 20'000, hits);
        EXPECT_LE(differing, 5) << name;  // rays that graze
        EXPECT_GT(hits, 1000) << name;
        RecordProperty(std::string(name) + "_differing", differing);
    }
}

TEST(RayQueries, KnowTheHolesOfTextures) {
    NEEDS_RAY_QUERIES;
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp}) {
        Scene scene = test::scene_with_holes(wrap);
        int hits = 0, hits_closed = 0;
        EXPECT_LE(differing_from_embree(scene, 20'000, hits), 4);
        scene.materials[1].alpha_mode = AlphaMode::opaque;
        differing_from_embree(scene, 20'000, hits_closed);
        EXPECT_LT(hits, hits_closed - 500);
    }
}

TEST(RayQueries, AnswerInScenesThatAreTinyOrHuge) {
    NEEDS_RAY_QUERIES;
    for (const float size_m : {1.0e-4f, 1.0e5f}) {
        Scene scene = test::scene_with_material();
        for (std::uint32_t k = 0; k < 60; ++k) {
            const vec3 corner = test::random_point({vec3(0.0f), vec3(size_m)}, k, 61);
            const vec3 u = sphere_direction(random_unit(62, k, 0), random_unit(62, k, 1));
            test::add_quad(scene, corner, 0.3f * size_m * u, 0.3f * size_m * glm::cross(u, vec3(0.3f, 0.8f, 0.5f)));
        }
        int hits = 0;
        EXPECT_LE(differing_from_embree(scene, 10'000, hits), 2) << size_m;
        EXPECT_GT(hits, 1000);
        EXPECT_LT(hits, 9900);
    }
}

TEST(RayQueries, PassTheValidationLayer) {
    NEEDS_RAY_QUERIES;
    setenv("SIGHTLINES_VULKAN_VALIDATION", "1", 1);
    const auto device = compute::open_device();
    unsetenv("SIGHTLINES_VULKAN_VALIDATION");
    if (!device->messenger) GTEST_SKIP() << "vulkan-validationlayers is not installed";
    EXPECT_GT(device->most_query_triangles, 1'000'000u);
    answers(device, *test::built(test::scene_with_holes(Wrap::repeat)), {{vec3(0.0f), vec3(0.0f, 1.0f, 0.0f)}});
    EXPECT_EQ(device->validation_errors, 0);
}

}  // namespace
}  // namespace sightlines
