// What rays find beside the texels of a mask: against geometry, and against far more rays.
#include "techniques/visibility_field/rim_probes.h"

#include <gtest/gtest.h>

#include "shaders/octahedral.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/casting.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

constexpr int size = 18;
constexpr ProbeLimits limits{64, 1'000'000};
constexpr vec3 up{0.0f, 1.0f, 0.0f};

std::uint64_t bit(int column) { return std::uint64_t{1} << column; }

bool is_set(const MaskRows& rows, int column, int row) {
    return (rows[static_cast<std::size_t>(row)] & bit(column)) != 0;
}

vec3 direction_at(float column, float row) {
    const auto place = [](float at) { return 2.0f * at / static_cast<float>(size) - 1.0f; };
    return kernel::octahedral_direction({place(column), place(row)});
}

/// A mask with the one texel that holds a direction.
MaskRows one_texel(vec3 direction) {
    const kernel::OctahedralTexel texel = kernel::octahedral_texel(kernel::octahedral_place(direction), size);
    MaskRows rows{};
    rows[static_cast<std::size_t>(texel.row)] = bit(texel.column);
    return rows;
}

/// The least and the greatest height of a texel's corners above the horizon of `normal`.
std::pair<float, float> heights(vec3 normal, int column, int row) {
    float least = 1.0f, greatest = -1.0f;
    for (int corner = 0; corner < 4; ++corner) {
        const float height = glm::dot(
            normal, direction_at(static_cast<float>(column + corner % 2), static_cast<float>(row + corner / 2)));
        least = std::min(least, height);
        greatest = std::max(greatest, height);
    }
    return {least, greatest};
}

Scene plane_scene() {
    Scene scene = test::scene_with_material({});
    test::add_quad(scene, {-2.0f, 0.0f, -2.0f}, {0.0f, 0.0f, 4.0f}, {4.0f, 0.0f, 0.0f});
    return scene;
}

class RimProbes : public ::testing::TestWithParam<vec3> {};

TEST_P(RimProbes, SpreadFromOneTexelOverTheOpenHalfOfTheSphereAndNoFarther) {
    const auto embree = test::built(plane_scene());
    const vec3 normal = GetParam();
    const SurfacePoint point{vec3(0.1f, 0.0f, 0.2f), normal, 0};
    MaskPair masks{one_texel(normal), {}};
    const std::uint64_t cast = probe_rims(*embree, {&point, 1}, size, limits, 1, 0, masks);
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const auto [least, greatest] = heights(normal, column, row);
            EXPECT_FALSE(is_set(masks.occluded, column, row));
            EXPECT_TRUE(is_set(masks.visible, column, row) || least < 1e-4f) << column << " " << row;
            EXPECT_FALSE(is_set(masks.visible, column, row) && greatest < 0.0f) << column << " " << row;
        }
    }
    EXPECT_LE(cast, std::uint64_t{64} * size * size);
}

// Downwards the half lies in the square's four corners, which touch only across its edges.
INSTANTIATE_TEST_SUITE_P(Sides, RimProbes, ::testing::Values(up, -up));

TEST(RimProbesOfAWall, FindWhereItEndsToTheTexel) {
    Scene scene = plane_scene();
    test::add_quad(scene, {-500.0f, -0.5f, -1.0f}, {1000.0f, 0.0f, 0.0f}, {0.0f, 1.5f, 0.0f});
    const auto embree = test::built(scene);
    // The wall's top, 1 m up and 1 m away, is a plane at 45 degrees through the point.
    const SurfacePoint point{vec3(0.0f), up, 0};
    MaskPair masks{one_texel(up), one_texel(vec3(0.0f, 0.1f, -1.0f))};
    probe_rims(*embree, {&point, 1}, size, limits, 1, 0, masks);
    const vec3 over_wall = glm::normalize(vec3(0.0f, 1.0f, 1.0f));
    int split = 0;
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const auto [least, greatest] = heights(over_wall, column, row);
            if (heights(up, column, row).first < 0.02f) continue;
            // Not looked at: what a texel has less than a hundredth of.
            EXPECT_TRUE(std::abs(least) < 0.01f || is_set(masks.occluded, column, row) == (least < 0.0f));
            EXPECT_TRUE(std::abs(greatest) < 0.01f || is_set(masks.visible, column, row) == (greatest > 0.0f));
            split += is_set(masks.visible, column, row) && is_set(masks.occluded, column, row);
        }
    }
    EXPECT_GT(split, 8);
}

/// What many rays from each of the points find.
MaskPair brute_force(const EmbreeScene& embree, std::span<const SurfacePoint> points, int steps) {
    MaskPair masks;
    for (int row = 0; row < size * steps; ++row) {
        for (int column = 0; column < size * steps; ++column) {
            const auto middle = [&](int at) { return (static_cast<float>(at) + 0.5f) / static_cast<float>(steps); };
            const vec3 direction = direction_at(middle(column), middle(row));
            for (const SurfacePoint& point : points) {
                if (glm::dot(direction, point.normal) <= 0.0f) continue;
                const bool blocked = is_blocked(embree, lifted_off(embree, point.position, point.normal), direction);
                (blocked ? masks.occluded : masks.visible)[static_cast<std::size_t>(row / steps)] |=
                    bit(column / steps);
            }
        }
    }
    return masks;
}

int missing(const MaskRows& rows, const MaskRows& truth) {
    int count = 0;
    for (std::size_t row = 0; row < size; ++row) count += std::popcount(truth[row] & ~rows[row]);
    return count;
}

TEST(RimProbesInAScene, LeaveOutATenthOfWhatThePointsOwnRaysDo) {
    const Scene scene = testing::courtyard();
    const auto embree = test::built(scene);
    BakeOptions options = testing::small_bake();
    Progress progress;
    const CellPoints points = place_points(scene, make_shape(scene.bounds, 1.0f, size), options, progress);
    const RaySet set = make_ray_set(options.rays);
    CastingRoom room(set);
    int without = 0, with = 0;
    for (std::size_t cell = 0; cell < points.cells.size(); cell += points.cells.size() / 24) {
        const auto own =
            std::span(points.points).subspan(points.first[cell], points.first[cell + 1] - points.first[cell]);
        MaskPair masks;
        for (const SurfacePoint& point : own)
            cast_from(*embree, set, point, size, 7, room, masks.visible, masks.occluded);
        const MaskPair truth = brute_force(*embree, own, 6);
        without += missing(masks.visible, truth.visible) + missing(masks.occluded, truth.occluded);
        const MaskPair before = masks;
        probe_rims(*embree, own, size, {256, 1'000'000}, 1, static_cast<std::uint32_t>(cell), masks);
        with += missing(masks.visible, truth.visible) + missing(masks.occluded, truth.occluded);
        EXPECT_EQ(missing(masks.visible, before.visible) + missing(masks.occluded, before.occluded), 0);
    }
    EXPECT_GT(without, 50);
    EXPECT_LT(10 * with, without) << with << " of " << without;
}

TEST(RimProbesBudget, IsKeptButForSixteenRaysATexel) {
    const Scene scene = testing::courtyard();
    const auto embree = test::built(scene);
    const SurfacePoint point{vec3(1.0f, 0.0f, 1.0f), up, 0};
    const auto cast = [&](std::uint64_t budget) {
        MaskPair masks{one_texel(up), {}};
        return probe_rims(*embree, {&point, 1}, size, {256, budget}, 1, 0, masks);
    };
    const std::uint64_t least = cast(0), all = cast(1'000'000);
    EXPECT_LE(least, 16u * size * size);
    EXPECT_GT(all, 4 * least);
    EXPECT_LE(cast((least + all) / 2), (least + all) / 2 + 16u * size * size);
}

}  // namespace
}  // namespace sightlines::visibility_field
