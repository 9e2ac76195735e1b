// The ray tree for devices: against answers known beforehand, the simplest ray tracer and Embree; and its GLSL against
// its scalar compilation.
#include "techniques/rays/ray_tree.h"

#include <cmath>

#include <gtest/gtest.h>

#include "shaders/ray_tree.h"
#include "techniques/rays/open_rays.h"
#include "techniques/scene/builtin_scenes.h"
#include "tests/rays/device_rays.h"
#include "tests/rays/recorded_ray_tree.h"

namespace sightlines {
namespace {

using test::buffer_of;
using test::random_rays;
using test::scene_with_holes;
using test::test_shader;
using test::TestRay;

RayTree tree_of(const EmbreeScene& embree) {
    Progress progress;
    return build_ray_tree(embree, 2, progress);
}

bool is_blocked_in(const RayTree& tree, const TestRay& ray) {
    return scalar_kernel::is_blocked_by_tree(
        {{tree.nodes.data()}, {tree.triangles.data()}, {tree.cutouts.data()}, tree.node_count()}, ray.origin,
        ray.direction);
}

TEST(RayTree, AnswersRaysAtABoxOfWhichTheAnswersAreKnown) {
    Scene scene = test::scene_with_material();
    test::add_box(scene, {-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f});
    const auto embree = test::built(scene);
    const RayTree tree = tree_of(*embree);
    const auto blocked = [&](vec3 origin, vec3 direction) { return is_blocked_in(tree, {origin, direction}); };
    EXPECT_TRUE(blocked({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}));
    EXPECT_TRUE(blocked({0.2f, 5.0f, 0.1f}, {0.0f, -1.0f, 0.0f}));
    EXPECT_TRUE(blocked({0.2f, 5.0f, 0.1f}, {-0.0f, -1.0f, -0.0f}));
    EXPECT_FALSE(blocked({0.2f, 5.0f, 0.1f}, {0.0f, 1.0f, 0.0f}));  // behind it
    EXPECT_FALSE(blocked({1.5f, 5.0f, 0.1f}, {0.0f, -1.0f, 0.0f}));
    EXPECT_FALSE(blocked({5.0f, 1.001f, 0.0f}, {-1.0f, 0.0f, 0.0f}));
    EXPECT_TRUE(blocked({5.0f, 0.999f, 0.0f}, {-1.0f, 0.0f, 0.0f}));
    EXPECT_TRUE(blocked({1.0e5f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}));
    EXPECT_FALSE(blocked({1.0e5f, 0.0f, 0.0f}, glm::normalize(vec3(-1.0f, 1.0e-3f, 0.0f))));
}

TEST(RayTree, OfNothingBlocksNothing) {
    const Scene scene = test::scene_with_material();
    const RayTree tree = tree_of(*test::built(scene));
    EXPECT_EQ(tree.node_count(), 0u);
    EXPECT_FALSE(is_blocked_in(tree, {vec3(0.0f), vec3(0.0f, 1.0f, 0.0f)}));
}

TEST(RayTree, LetsNoRayOutOfAClosedBall) {
    Scene scene = test::scene_with_material();
    test::add_sphere(scene, {3.0f, -2.0f, 1.0f}, 1.7f, 64);
    const RayTree tree = tree_of(*test::built(scene));
    int leaks = 0;
    // At the vertices and the middles of edges, where neighbours meet, and anywhere.
    for (std::uint32_t k = 0; k < scene.triangles.size(); ++k) {
        const uvec3 t = scene.triangles[k];
        const vec3 origin(3.1f, -2.2f, 0.7f);
        for (const vec3 aim : {scene.positions[t.x], 0.5f * (scene.positions[t.x] + scene.positions[t.y]),
                               0.3f * scene.positions[t.x] + 0.7f * scene.positions[t.z]})
            leaks += !is_blocked_in(tree, {origin, glm::normalize(aim - origin)});
    }
    for (const TestRay& ray : random_rays({vec3(2.5f, -2.5f, 0.5f), vec3(3.5f, -1.5f, 1.5f)}, 20'000))
        leaks += !is_blocked_in(tree, ray);
    EXPECT_EQ(leaks, 0);
}

TEST(RayTree, AnswersAsTheSimplestRayTracerDoes) {
    const Scene scene = test::triangle_soup(60);
    const RayTree tree = tree_of(*test::built(scene));
    int hits = 0, differing = 0;
    for (const TestRay& ray : random_rays(scene.bounds, 5000)) {
        const bool expected = test::any_crosses(scene, ray.origin, ray.origin + 10.0f * ray.direction, 0.0, 1.0);
        hits += expected;
        differing += expected != is_blocked_in(tree, ray);
    }
    EXPECT_EQ(differing, 0);
    EXPECT_GT(hits, 500);
    EXPECT_LT(hits, 4500);
}

/// How many of the rays the tree answers otherwise than Embree does.
int differing_from_embree(const Scene& scene, std::uint32_t count, int& hits) {
    const auto embree = test::built(scene);
    const RayTree tree = tree_of(*embree);
    int differing = 0;
    for (const TestRay& ray : random_rays(scene.bounds, count)) {
        const bool expected = is_blocked(*embree, ray.origin, ray.direction);
        hits += expected;
        differing += expected != is_blocked_in(tree, ray);
    }
    return differing;
}

TEST(RayTree, AnswersAsEmbreeDoesInBuiltInScenes) {
    for (const char* name : {"cornell", "atrium", "trees", "garden"}) {
        Progress progress;
        const Scene scene = find_scene(name, progress).at(0.0);
        int hits = 0;
        const int differing = differing_from_embree(scene, 20'000, hits);
        EXPECT_LE(differing, 5) << name;  // rays that graze
        EXPECT_GT(hits, 1000) << name;
        RecordProperty(std::string(name) + "_differing", differing);
    }
}

TEST(RayTree, KnowsTheHolesOfTextures) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp}) {
        const Scene scene = scene_with_holes(wrap);
        int hits = 0;
        EXPECT_LE(differing_from_embree(scene, 20'000, hits), 4);
        Scene closed = scene;
        closed.materials[1].alpha_mode = AlphaMode::opaque;
        int hits_closed = 0;
        differing_from_embree(closed, 20'000, hits_closed);
        EXPECT_LT(hits, hits_closed - 500);
    }
}

TEST(RayTree, HoldsEachTriangleOnceAndNodesInDepthFirstOrder) {
    const Scene scene = test::triangle_soup(1000);
    const RayTree tree = tree_of(*test::built(scene));
    EXPECT_EQ(tree.triangles.size(), 3000u);
    std::uint32_t next_triangle = 0;
    for (std::uint32_t n = 0; n < tree.node_count(); ++n) {
        const std::uint32_t after = tree.nodes[2 * n].w, leaf = tree.nodes[2 * n + 1].w;
        ASSERT_GT(after, n);
        ASSERT_LE(after, tree.node_count());
        if (leaf == 0) continue;
        ASSERT_EQ(after, n + 1);
        ASSERT_EQ(leaf / leaf_scale, next_triangle);
        next_triangle += leaf % leaf_scale;
    }
    EXPECT_EQ(next_triangle, 1000u);
}

TEST(RayTree, RecordsTheTriangleInTheWay) {
    Scene scene = test::scene_with_material();
    test::add_quad(scene, {-1.0f, 2.0f, -1.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f});
    const RayTree tree = tree_of(*test::built(scene));
    const test::RecordedTreeRay hit = test::recorded_tree_ray(tree, vec3(0.1f, 0.0f, 0.2f), {0.0f, 1.0f, 0.0f});
    EXPECT_TRUE(hit.blocked);
    ASSERT_EQ(hit.steps.size(), 2u);
    EXPECT_EQ(hit.steps[0].paper, "Ray tree, triangle");
    const test::RecordedTreeRay miss = test::recorded_tree_ray(tree, vec3(0.1f, 0.0f, 0.2f), {0.0f, -1.0f, 0.0f});
    EXPECT_FALSE(miss.blocked);
    EXPECT_EQ(miss.steps.size(), 1u);
}

TEST(RayTree, StopsWhenCancelled) {
    const auto embree = test::built(test::triangle_soup(100));
    Progress progress;
    progress.cancel();
    EXPECT_THROW(build_ray_tree(*embree, 2, progress), Cancelled);
}

/// Push constants of ray_tree.comp.
struct ShaderJob {
    VkDeviceAddress nodes, triangles, cutouts;
    std::uint32_t node_count, count;
    VkDeviceAddress rays, answers;
};

std::vector<std::uint32_t> answers_of_device(const RayTree& tree, const std::vector<TestRay>& rays, bool as_texels) {
    const auto device = compute::open_device();
    const compute::Buffer nodes = buffer_of(device, tree.nodes), triangles = buffer_of(device, tree.triangles),
                          cutouts = buffer_of(device, tree.cutouts), asked = buffer_of(device, rays),
                          answers = buffer_of(device, std::vector<std::uint32_t>(rays.size(), 7));
    const compute::Pipeline pipeline = compute::make_pipeline(
        device, test_shader(as_texels ? "ray_tree_texels" : "ray_tree"), sizeof(ShaderJob), {}, as_texels ? 3 : 0);
    std::optional<compute::BoundTexels> texels;
    const std::array<compute::TexelSource, 3> sources{{{&nodes, VK_FORMAT_R32G32B32A32_UINT},
                                                       {&triangles, VK_FORMAT_R32G32B32A32_UINT},
                                                       {&cutouts, VK_FORMAT_R32G32B32A32_UINT}}};
    if (as_texels) texels = compute::bind_texels(pipeline, sources);
    const auto count = static_cast<std::uint32_t>(rays.size());
    const ShaderJob job{nodes.address, triangles.address, cutouts.address, tree.node_count(),
                        count,         asked.address,     answers.address};
    compute::dispatch(pipeline, std::as_bytes(std::span(&job, 1)), {(count + 63) / 64, 1, 1},
                      texels ? &*texels : nullptr);
    std::vector<std::uint32_t> result(rays.size());
    std::memcpy(result.data(), answers.mapped.data(), result.size() * 4);
    return result;
}

TEST(RayTree, AnswersAlikeOnADevice) {
    NEEDS_VULKAN;
    Progress progress;
    for (const Scene& scene : {scene_with_holes(Wrap::repeat), scene_with_holes(Wrap::mirrored_repeat),
                               scene_with_holes(Wrap::clamp), find_scene("atrium", progress).at(0.0)}) {
        const RayTree tree = tree_of(*test::built(scene));
        const std::vector<TestRay> rays = random_rays(scene.bounds, 10'000);
        for (const bool as_texels : {false, true}) {
            const std::vector<std::uint32_t> answers = answers_of_device(tree, rays, as_texels);
            int differing = 0, hits = 0;
            for (std::size_t k = 0; k < rays.size(); ++k) {
                differing += answers[k] != std::uint32_t{is_blocked_in(tree, rays[k])};
                hits += answers[k] == 1;
            }
            EXPECT_LE(differing, 5) << scene.name;
            EXPECT_GT(hits, 1000);
            EXPECT_LT(hits, 9990);
        }
    }
}

}  // namespace
}  // namespace sightlines
