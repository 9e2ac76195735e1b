// The tree of a moment, over that of what stands still, against the tree of all.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "techniques/rays/embree_scene.h"
#include "techniques/rays/ray_tree.h"
#include "tests/rays/test_scenes.h"

namespace sightlines::test {
namespace {

const Box3 around{vec3(-1.5f), vec3(1.5f)};

Part part(std::uint32_t first, std::uint32_t count, bool moves) {
    Part made;
    made.first_triangle = first;
    made.triangle_count = count;
    made.moves = moves;
    return made;
}

/// Triangles of which those in the middle are `offset` away from where they were.
Scene moving_soup(vec3 offset) {
    Scene scene = triangle_soup(600);
    scene.parts = {part(0, 200, false), part(200, 150, true), part(350, 250, false)};
    for (std::uint32_t t = 200; t < 350; ++t)
        for (int corner = 0; corner < 3; ++corner) scene.positions[scene.triangles[t][corner]] += offset;
    for (const vec3 position : scene.positions) scene.bounds.add(position);
    return scene;
}

std::shared_ptr<const EmbreeScene> fixed_tree(const Scene& scene, EmbreeUse use = EmbreeUse::reference) {
    Progress progress;
    return build_embree_scene(scene, use, 2, progress, PartChoice::fixed);
}

std::shared_ptr<const EmbreeScene> moment_tree(const Scene& scene, std::shared_ptr<const EmbreeScene> fixed) {
    Progress progress;
    return build_moment_tree(scene, std::move(fixed), 2, progress);
}

/// Rays between random points are answered alike, to the last bit; returns how many hit something.
int compare_answers(const EmbreeScene& one, const EmbreeScene& other) {
    int hits = 0;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const vec3 from = random_point(around, i, 5), to = random_point(around, i, 6);
        const auto expected = closest_hit(other, from, glm::normalize(to - from), 10.0f);
        const auto hit = closest_hit(one, from, glm::normalize(to - from), 10.0f);
        EXPECT_EQ(hit.has_value(), expected.has_value()) << i;
        EXPECT_EQ(occluded(one, {from, to}, vec3(0.0f, 1.0f, 0.0f)),
                  occluded(other, {from, to}, vec3(0.0f, 1.0f, 0.0f)))
            << i;
        if (!hit || !expected) continue;
        EXPECT_EQ(hit->triangle, expected->triangle) << i;
        EXPECT_EQ(hit->distance_m, expected->distance_m) << i;
        EXPECT_EQ(hit->barycentric, expected->barycentric) << i;
        ++hits;
    }
    return hits;
}

TEST(MomentTree, AnswersAsTheTreeOfAllWhateverMomentItsFixedPartIsFrom) {
    const Scene before = moving_soup(vec3(0.0f)), after = moving_soup(vec3(0.3f, -0.2f, 0.1f));
    for (const EmbreeUse use : {EmbreeUse::reference, EmbreeUse::benchmark}) {
        const auto fixed = fixed_tree(before, use);
        for (const Scene* scene : {&after, &before})
            EXPECT_GT(compare_answers(*moment_tree(*scene, fixed), *built(*scene, use)), 1000);
    }
}

TEST(MomentTree, ShowsTheSurfacesThatTheTreeOfAllShows) {
    const Scene scene = moving_soup(vec3(0.3f, -0.2f, 0.1f));
    const Camera camera = camera_at({0, 0, 4}, {0, 0, 0});
    const SurfaceBuffer expected = seen(scene, *built(scene), camera, {64, 48});
    const SurfaceBuffer surfaces =
        seen(scene, *moment_tree(scene, fixed_tree(moving_soup(vec3(0.0f)))), camera, {64, 48});
    EXPECT_EQ(surfaces.triangle, expected.triangle);
    EXPECT_EQ(surfaces.position, expected.position);
}

TEST(MomentTree, AnswersPacketsAndStreamsAsTheTreeOfAll) {
    const Scene scene = moving_soup(vec3(0.3f, -0.2f, 0.1f));
    const auto tree = moment_tree(scene, fixed_tree(scene)), all = built(scene);
    const SurfaceBuffer surfaces = seen(scene, *all, camera_at({0, 0, 4}, {0, 0, 0}), {64, 48});
    std::vector<Light> lights;
    for (std::uint32_t i = 0; i < 40; ++i) lights.push_back(point_light(random_point(around, i, 7)));
    RenderRequest request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.keep_verdicts = true;
    Progress progress;
    const RenderResult result = render_reference(*tree, request, progress);
    const RenderResult expected = render_reference(*all, request, progress);
    EXPECT_GT(expected.rays, 10'000u);
    EXPECT_EQ(result.verdicts.words, expected.verdicts.words);
    for (const EmbreeVariant variant :
         {EmbreeVariant::single, EmbreeVariant::packet_8, EmbreeVariant::packet_16, EmbreeVariant::stream}) {
        const QueryCount one = count_blocked(*tree, variant, surfaces, lights, 2);
        const QueryCount other = count_blocked(*all, variant, surfaces, lights, 2);
        EXPECT_EQ(one.rays, other.rays);
        EXPECT_EQ(one.blocked, other.blocked);
    }
}

TEST(MomentTree, KeepsTheFixedTreeAlive) {
    const Scene scene = moving_soup(vec3(0.1f));
    auto fixed = fixed_tree(scene);
    const auto tree = moment_tree(scene, fixed);
    fixed.reset();
    EXPECT_GT(compare_answers(*tree, *built(scene)), 1000);
}

TEST(MomentTree, ServesScenesInWhichEverythingMovesOrNothingDoes) {
    for (const bool moves : {true, false}) {
        Scene scene = triangle_soup(300);
        scene.parts = {part(0, 300, moves)};
        EXPECT_GT(compare_answers(*moment_tree(scene, fixed_tree(scene)), *built(scene)), 1000) << moves;
    }
    Scene empty = scene_with_material();
    EXPECT_FALSE(closest_hit(*moment_tree(empty, fixed_tree(empty)), vec3(0.0f), {0, 1, 0}, 10.0f).has_value());
}

/// Two squares of which the left halves are solid; the upper one moves.
TEST(MomentTree, KnowsTheHolesOfWhatStandsAndOfWhatMoves) {
    Scene scene = scene_with_square(AlphaMode::mask);
    add_quad(scene, {2, 2, 0}, {1, 0, 0}, {0, 0, 1});
    scene.parts = {part(0, 2, false), part(2, 2, true)};
    const auto tree = moment_tree(scene, fixed_tree(scene));
    for (const auto& [x, triangle] : {std::pair(0.25f, 1u), std::pair(2.25f, 3u)}) {
        const auto hit = closest_hit(*tree, {x, 0, 0.5f}, {0, 1, 0}, 10.0f);
        ASSERT_TRUE(hit.has_value()) << x;
        EXPECT_EQ(hit->triangle, triangle);
        EXPECT_FALSE(closest_hit(*tree, {x + 0.5f, 0, 0.5f}, {0, 1, 0}, 10.0f).has_value()) << x;
    }
}

TEST(MomentTree, GivesDevicesTheTrianglesOfBoth) {
    const Scene scene = moving_soup(vec3(0.3f, -0.2f, 0.1f));
    const auto tree = moment_tree(scene, fixed_tree(scene));
    EXPECT_EQ(triangle_count(*tree), 600u);
    std::vector<uvec4> listed = list_triangles(*tree).opaque, expected = list_triangles(*built(scene)).opaque;
    ASSERT_EQ(listed.size(), 1800u);
    const auto before = [](uvec4 a, uvec4 b) { return std::tie(a.x, a.y, a.z, a.w) < std::tie(b.x, b.y, b.z, b.w); };
    std::ranges::sort(listed, before);
    std::ranges::sort(expected, before);
    EXPECT_EQ(listed, expected);
    Progress progress;
    EXPECT_EQ(build_ray_tree(*tree, 2, progress).triangles.size(), 1800u);
}

TEST(MomentTree, StopsBuildingWhenCancelled) {
    const Scene scene = moving_soup(vec3(0.0f));
    const auto fixed = fixed_tree(scene);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(build_moment_tree(scene, fixed, 2, progress), Cancelled);
}

}  // namespace
}  // namespace sightlines::test
