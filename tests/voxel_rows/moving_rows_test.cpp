#include "techniques/voxel_rows/moving_rows.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "techniques/scene/builtin_mesh.h"
#include "techniques/scene/moving_parts.h"

namespace sightlines::voxel_rows {
namespace {

/// A floor and a wall that stand still, and a box that flies past.
Scene scene_at(float x_m) {
    Scene scene;
    scene.materials = {diffuse("stone", vec3(0.5f))};
    Mesh still, box;
    add_quad(still, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, 0);
    add_quad(still, {-4, 0, 1}, {8, 0, 0}, {0, 4, 0}, 0);
    add_box(box, {vec3(-0.6f), vec3(0.6f)}, 0);
    add_part(scene, still, "still", 0, mat4(1.0f));
    add_part(scene, box, "box", 1, placed({x_m, 2, -1}, 20.0f * x_m));
    scene.parts[1].moves = true;
    scene.bounds = tight_bounds(scene);
    scene.motion_bounds = {vec3(-4, 0, -4), vec3(4, 4, 4)};
    return scene;
}

BuildOptions small_build() {
    BuildOptions options;
    options.resolution = 48;
    options.angle_step_deg = 6.0;
    options.threads = 2;
    return options;
}

bool same_words(const RowArray& a, const RowArray& b) { return std::ranges::equal(a.words.words, b.words.words); }

/// What is set in either.
RowArray united(const RowArray& a, const RowArray& b) {
    RowArray both = a;
    both.words = allocate_huge(a.words.words.size());
    for (std::size_t k = 0; k < both.words.words.size(); ++k) both.words.words[k] = a.words.words[k] | b.words.words[k];
    return both;
}

TEST(MovingRows, AMomentHoldsWhatStandsStillAndWhatMoves) {
    Progress progress;
    const Scene scene = scene_at(1.0f);
    const auto shared = build_fixed(scene, small_build(), progress);
    const MomentArray now = build_moment(shared, scene, small_build(), progress);
    const RowArray moving = build_from_fragments(changing_scene(scene), small_build(), progress);
    EXPECT_TRUE(same_words(now.array, united(shared->fixed, moving)));
    EXPECT_FALSE(same_words(now.array, shared->fixed));
}

TEST(MovingRows, AMomentDoesNotDependOnTheOnesBefore) {
    Progress progress;
    const auto shared = build_fixed(scene_at(0.0f), small_build(), progress);
    const std::uint32_t* first_memory = nullptr;
    {
        const MomentArray before = build_moment(shared, scene_at(-3.0f), small_build(), progress);
        first_memory = before.array.words.words.data();
    }
    const MomentArray again = build_moment(shared, scene_at(2.0f), small_build(), progress);
    EXPECT_EQ(again.array.words.words.data(), first_memory);  // the memory of the moment before
    const auto other = build_fixed(scene_at(2.0f), small_build(), progress);
    const MomentArray alone = build_moment(other, scene_at(2.0f), small_build(), progress);
    EXPECT_TRUE(same_words(again.array, alone.array));
}

TEST(MovingRows, TwoMomentsMayLiveAtTheSameTime) {
    Progress progress;
    const auto shared = build_fixed(scene_at(0.0f), small_build(), progress);
    const MomentArray first = build_moment(shared, scene_at(-3.0f), small_build(), progress);
    const MomentArray second = build_moment(shared, scene_at(3.0f), small_build(), progress);
    EXPECT_NE(first.array.words.words.data(), second.array.words.words.data());
    EXPECT_FALSE(same_words(first.array, second.array));
}

TEST(MovingRows, WhatStandsStillIsTheSameAtEveryMoment) {
    Progress progress;
    EXPECT_TRUE(same_words(build_fixed(scene_at(-3.0f), small_build(), progress)->fixed,
                           build_fixed(scene_at(3.0f), small_build(), progress)->fixed));
}

TEST(MovingRows, ACancelledMomentLeavesTheNextOneRight) {
    Progress progress;
    const auto shared = build_fixed(scene_at(0.0f), small_build(), progress);
    { const MomentArray before = build_moment(shared, scene_at(-3.0f), small_build(), progress); }
    Progress cancelled;
    cancelled.cancel();
    EXPECT_THROW(build_moment(shared, scene_at(0.0f), small_build(), cancelled), Cancelled);
    const MomentArray next = build_moment(shared, scene_at(2.0f), small_build(), progress);
    const auto other = build_fixed(scene_at(2.0f), small_build(), progress);
    EXPECT_TRUE(same_words(next.array, build_moment(other, scene_at(2.0f), small_build(), progress).array));
}

}  // namespace
}  // namespace sightlines::voxel_rows
