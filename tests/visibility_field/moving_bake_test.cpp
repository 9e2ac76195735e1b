// Fields of scenes that move, against casting everything anew.
#include "techniques/visibility_field/moving_bake.h"

#include <gtest/gtest.h>

#include "shaders/octahedral.h"
#include "techniques/base/error.h"
#include "techniques/visibility_field/casting.h"
#include "techniques/visibility_field/moving_reach.h"
#include "techniques/visibility_field/visibility_field.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

/// Makes what was added since the last part one more.
void close_part(Scene& scene, bool moves) {
    Part part;
    if (!scene.parts.empty())
        part.first_triangle = scene.parts.back().first_triangle + scene.parts.back().triangle_count;
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size()) - part.first_triangle;
    part.mesh = static_cast<std::uint32_t>(scene.parts.size());
    part.moves = moves;
    scene.parts.push_back(part);
}

/// The courtyard with a box that slides along its floor: 3 m in 3 s.
Scene moving_courtyard(float time_s) {
    Scene scene = testing::courtyard();
    close_part(scene, false);
    const float x = -1.9f + time_s;
    test::add_box(scene, {x, 0.05f, 2.3f}, {x + 0.8f, 0.9f, 3.1f});
    close_part(scene, true);
    scene.texture_coordinates[0].clear();
    scene.time_s = time_s;
    scene.motion_bounds = scene.bounds;
    return scene;
}

VisibilityField moment_of(const Scene& scene, const FixedField& fixed, const BakeOptions& options,
                          CellPoints* points = nullptr) {
    Progress progress;
    return bake_moment(fixed, scene, *test::built(scene), options, progress, points);
}

/// The masks of a cell's samples, all cast at the whole scene.
FinishedMasks cast_plainly(const CellPoints& samples, const EmbreeScene& embree, const BakeOptions& options) {
    FinishedMasks masks;
    const RaySet set = make_ray_set(options.rays);
    CastingRoom room(set);
    MaskPair parts;
    for (const SurfacePoint& point : samples.points)
        cast_from(embree, set, point, casting_size(options), options.seed ^ casting_seed, room, parts.visible,
                  parts.occluded);
    add_cell(parts, options, masks);
    return masks;
}

class MovingBake : public ::testing::TestWithParam<Placement> {};

TEST_P(MovingBake, GivesTheMasksOfCastingAllSamplesAtTheWholeScene) {
    BakeOptions options = testing::small_bake();
    options.placement = GetParam();
    Progress progress;
    const auto fixed = bake_fixed(moving_courtyard(0.0f), options, progress);
    for (const float time_s : {0.0f, 0.7f, 3.0f}) {
        const Scene scene = moving_courtyard(time_s);
        const auto embree = test::built(scene, EmbreeUse::benchmark);
        CellPoints points;
        const VisibilityField field = bake_moment(*fixed, scene, *embree, options, progress, &points);
        std::size_t other = 0, samples = 0;
        for (const OccupiedCell& cell : occupied_cells(field)) {
            const CellPoints own = samples_in(field.shape, cell.place, points, &fixed->points);
            samples += own.points.size();
            const FinishedMasks expected = cast_plainly(own, *embree, options);
            const auto words = std::span(expected.words);
            other += !std::ranges::equal(mask_words(field, cell.index, 0), words.first(11)) ||
                     !std::ranges::equal(mask_words(field, cell.index, 1), words.last(11)) ||
                     cell.label != expected.labels[0];
        }
        EXPECT_EQ(samples, field.points);
        // Rays start a millionth of the scene higher or lower: a grazing one may end otherwise.
        EXPECT_LE(other, 1u) << time_s;
        EXPECT_GT(field.kept_cells, field.cells / 4) << time_s;
        EXPECT_LT(field.rays_again, field.rays / 5) << time_s;
    }
}

INSTANTIATE_TEST_SUITE_P(Placements, MovingBake, ::testing::Values(Placement::random, Placement::stratified));

TEST(MovingBakeMoments, AreTheSameFromWhateverMomentTheyStarted) {
    const BakeOptions options = testing::small_bake();
    Progress progress;
    const Scene scene = moving_courtyard(2.0f);
    const auto early = bake_fixed(moving_courtyard(0.0f), options, progress);
    const auto now = bake_fixed(scene, options, progress);
    ASSERT_TRUE(serves(*now, scene, options));
    const VisibilityField a = moment_of(scene, *early, options), b = moment_of(scene, *now, options);
    EXPECT_EQ(a.masks, b.masks);
    EXPECT_EQ(a.mask_numbers, b.mask_numbers);
    EXPECT_EQ(a.points, b.points);
    EXPECT_NE(a.masks, moment_of(moving_courtyard(0.0f), *early, options).masks);
}

TEST(MovingBakeMoments, BakeNothingAgainThatAWallHidesFromWhatMoves) {
    // A hall, divided by a wall; something turns in its left half only.
    const auto hall = [](float at) {
        Scene scene = testing::one_sided_scene();
        test::add_box(scene, {-6.0f, -0.5f, -3.0f}, {6.0f, 0.0f, 3.0f});
        test::add_box(scene, {-6.0f, 3.0f, -3.0f}, {0.0f, 3.5f, 3.0f});
        test::add_box(scene, {-0.1f, 0.0f, -3.0f}, {0.1f, 9.0f, 3.0f});
        test::add_box(scene, {-6.0f, 0.0f, -3.0f}, {0.0f, 3.0f, -2.8f});
        test::add_box(scene, {-6.0f, 0.0f, 2.8f}, {0.0f, 3.0f, 3.0f});
        close_part(scene, false);
        test::add_box(scene, {-3.0f + at, 1.0f, -0.5f}, {-2.4f + at, 1.6f, 0.5f});
        close_part(scene, true);
        scene.motion_bounds = scene.bounds;
        return scene;
    };
    Progress progress;
    const BakeOptions options = testing::small_bake();
    const auto fixed = bake_fixed(hall(0.0f), options, progress);
    const Scene scene = hall(1.0f);
    const VisibilityField field = moment_of(scene, *fixed, options);
    std::size_t right = 0, kept_right = 0;
    const MovingReach reach = make_reach(field.shape, changing_boxes(scene, 32));
    for (const OccupiedCell& cell : occupied_cells(field)) {
        const Box3 box = cell_box(field.shape, cell.place);
        if (box.centre().x < 1.0f || box.centre().y > 2.0f) continue;
        ++right;
        kept_right += boxes_in_reach(reach, box, mask_words(field, cell.index, 0)) == 0;
    }
    EXPECT_GT(right, 100u);
    EXPECT_GT(kept_right, right / 3);
    EXPECT_GT(field.kept_cells, right / 3);
    EXPECT_LT(field.kept_cells, field.cells);
}

TEST(MovingBakeMoments, AreBakedWholeWhereEverythingMovesAndNotAgainWhereNothingIsThatMoves) {
    Scene all = testing::courtyard();
    close_part(all, true);
    all.motion_bounds = all.bounds;
    Progress progress;
    const BakeOptions options = testing::small_bake();
    EXPECT_EQ(changing_share(all), std::numeric_limits<double>::infinity());
    const VisibilityField field = moment_of(all, *bake_fixed(all, options, progress), options);
    EXPECT_EQ(field.kept_cells, 0u);
    EXPECT_EQ(field.rays_again, field.rays);
    EXPECT_NEAR(static_cast<double>(field.points), options.points, 0.05 * options.points);

    Scene flat = testing::courtyard();
    close_part(flat, false);
    close_part(flat, true);
    flat.motion_bounds = flat.bounds;
    const VisibilityField still = moment_of(flat, *bake_fixed(flat, options, progress), options);
    EXPECT_EQ(still.kept_cells, still.cells);
    EXPECT_EQ(still.rays_again, 0u);
}

TEST(MovingBakeMoments, KeepWhatTheyShareWithTheNext) {
    const Scene first = moving_courtyard(0.0f), next = moving_courtyard(1.5f);
    Progress progress;
    BuildRequest request;
    request.parameters = {{"points", 4000}, {"rays_per_point", 64}};
    request.scene = &first;
    const Structure at_first = technique().build(request, progress);
    request.scene = &next;
    const Structure anew = technique().build(request, progress);
    request.kept = technique().kept(at_first);
    const Structure with_kept = technique().build(request, progress);
    EXPECT_EQ(built_field(anew).field.masks, built_field(with_kept).field.masks);
    EXPECT_EQ(built_field(anew).field.mask_numbers, built_field(with_kept).field.mask_numbers);
    EXPECT_EQ(built_field(with_kept).fixed, built_field(at_first).fixed);
    EXPECT_NE(built_field(anew).fixed, built_field(at_first).fixed);
    const Scene still = testing::courtyard();
    request.scene = &still;
    request.kept = {};
    EXPECT_FALSE(technique().kept(technique().build(request, progress)).has_value());
}

TEST(MovingBakeMoments, StopWhenCancelled) {
    const Scene scene = moving_courtyard(0.0f);
    const BakeOptions options = testing::small_bake();
    Progress progress;
    const auto fixed = bake_fixed(scene, options, progress);
    Progress cancelled;
    cancelled.cancel();
    EXPECT_THROW(bake_fixed(scene, options, cancelled), Cancelled);
    EXPECT_THROW(bake_moment(*fixed, scene, *test::built(scene), options, cancelled), Cancelled);
}

TEST(ChangingShare, IsAPowerOfTwoThatSmallChangesLeave) {
    const auto share_with = [](float side_m) {
        Scene scene = testing::one_sided_scene();
        test::add_quad(scene, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 10.0f}, {10.0f, 0.0f, 0.0f});
        close_part(scene, false);
        test::add_quad(scene, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, side_m}, {side_m, 0.0f, 0.0f});
        close_part(scene, true);
        return changing_share(scene);
    };
    EXPECT_EQ(share_with(1.0f), 0.0);
    EXPECT_EQ(share_with(5.0f), 0.25);
    EXPECT_EQ(share_with(5.3f), 0.25);
    EXPECT_EQ(share_with(10.0f), 1.0);
}

/// Whether the line from `origin` along `direction` passes through the box ahead.
bool meets(const Box3& box, vec3 origin, vec3 direction) {
    float nearest = 0.0f, farthest = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const float a = (box.lowest[axis] - origin[axis]) / direction[axis];
        const float b = (box.highest[axis] - origin[axis]) / direction[axis];
        nearest = std::max(nearest, std::min(a, b));
        farthest = std::min(farthest, std::max(a, b));
    }
    return nearest <= farthest;
}

TEST(MovingReach, FindsEveryCellThatHasARayToABox) {
    for (const int size : {8, 17, 18, 40}) {
        const FieldShape shape = make_shape({vec3(0.0f), vec3(8.0f)}, 0.5f, size);
        MovingReach reach = make_reach(shape, {});
        int met = 0, out_of_reach = 0;
        for (std::uint32_t k = 0; k < 20'000; ++k) {
            const auto random = [&](std::uint32_t which) { return random_unit(3, k, which); };
            const vec3 corner(8.0f * random(0), 8.0f * random(1), 8.0f * random(2));
            const Box3 box{corner, corner + vec3(random(3), random(4), random(5))};
            const ivec3 place(16.0f * vec3(random(6), random(7), random(8)));
            const Box3 cell = cell_box(shape, place);
            const vec3 origin = cell.lowest + cell.size() * vec3(random(9), random(10), random(11));
            const vec3 at_box = box.lowest + box.size() * vec3(random(12), random(13), random(14));
            const vec3 direction =
                k % 2 == 0 ? glm::normalize(at_box - origin) : sphere_direction(random(12), random(13));
            const auto texel = scalar_kernel::octahedral_texel(scalar_kernel::octahedral_place(direction), size);
            std::vector<std::uint32_t> visible(static_cast<std::size_t>(shape.words_per_mask));
            const int number = texel.row * size + texel.column;
            visible[static_cast<std::size_t>(number / 32)] = 1u << (number % 32);
            reach.boxes = {box};
            const bool may = boxes_in_reach(reach, cell, visible) != 0;
            if (meets(box, origin, direction)) {
                ++met;
                ASSERT_TRUE(may) << size << " " << k;
            }
            out_of_reach += !may;
        }
        EXPECT_GT(met, 9'000);
        EXPECT_GT(out_of_reach, 5'000);
    }
}

TEST(MovingReach, HasNothingToSeeWhereAllIsOccluded) {
    const FieldShape shape = make_shape({vec3(0.0f), vec3(8.0f)}, 0.5f, 18);
    const std::vector<std::uint32_t> none(11), all(11, ~0u);
    const MovingReach reach = make_reach(shape, {{vec3(0.0f), vec3(8.0f)}});
    EXPECT_EQ(boxes_in_reach(reach, cell_box(shape, {2, 2, 2}), none), 0u);
    EXPECT_EQ(boxes_in_reach(reach, cell_box(shape, {2, 2, 2}), all), 1u);
    EXPECT_EQ(boxes_in_reach(make_reach(shape, {}), cell_box(shape, {2, 2, 2}), all), 0u);
}

}  // namespace
}  // namespace sightlines::visibility_field
