// The pieces of shaders/voxel_rows.h against plain mathematics.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "techniques/voxel_rows/row_array.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

namespace kernel = scalar_kernel;

constexpr Box3 room{vec3(-1.0f, 0.0f, -3.0f), vec3(3.0f, 2.5f, 4.0f)};

TEST(VoxelRowsKernel, RoundsEveryLineToADirectionWithinTheDiagonalOfHalfAStep) {
    for (const double step_deg : {1.0, 2.0, 4.0, 6.0}) {
        const RowGrid grid = make_grid(room, 32, step_deg);
        const RowShape shape = make_shape(grid);
        const double half_step = 0.5 * std::numbers::pi / grid.angles;
        for (std::uint32_t k = 0; k < 20000; ++k) {
            const vec3 line = sphere_direction(random_unit(7, k, 0), random_unit(7, k, 1)) * 3.0f;
            const kernel::Direction direction = kernel::discretize_direction(shape, line);
            ASSERT_TRUE(direction.theta >= 0 && direction.theta < grid.angles);
            ASSERT_TRUE(direction.phi >= 0 && direction.phi < grid.angles);
            const vec3 axis =
                glm::normalize(grid.frames[static_cast<std::size_t>(kernel::frame_index(shape, direction))].u);
            const double error = std::atan2(glm::length(glm::cross(glm::dvec3(line), glm::dvec3(axis))),
                                            std::abs(glm::dot(glm::dvec3(line), glm::dvec3(axis))));
            ASSERT_LE(error, half_step * std::numbers::sqrt2 + 1e-4) << line.x << ' ' << line.y << ' ' << line.z;
        }
    }
}

TEST(VoxelRowsKernel, GivesALineAndItsReverseTheSameDirection) {
    const RowShape shape = make_shape(make_grid(room, 32, 2.0));
    int different = 0;
    for (std::uint32_t k = 0; k < 20000; ++k) {
        const vec3 line = sphere_direction(random_unit(8, k, 0), random_unit(8, k, 1));
        const kernel::Direction there = kernel::discretize_direction(shape, line);
        const kernel::Direction back = kernel::discretize_direction(shape, -line);
        different += there.theta != back.theta || there.phi != back.phi;
    }
    EXPECT_EQ(different, 0);
}

TEST(VoxelRowsKernel, DiscretizesTheAxesAndNoLengthWithoutLeavingTheTable) {
    const RowGrid grid = make_grid(room, 32, 2.0);
    const RowShape shape = make_shape(grid);
    for (const vec3 line : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1),
                            vec3(0), vec3(1e-30f, 0, 0), vec3(-1, 0, -1e-20f), vec3(-1, 1e-20f, 1e-20f)}) {
        const int index = kernel::frame_index(shape, kernel::discretize_direction(shape, line));
        ASSERT_TRUE(index >= 0 && index < grid.angles * grid.angles);
        if (glm::length(line) < 0.5f) continue;
        EXPECT_NEAR(std::abs(glm::dot(glm::normalize(grid.frames[static_cast<std::size_t>(index)].u), line)), 1.0,
                    1e-5);
    }
}

TEST(VoxelRowsKernel, GivesEveryRowAPlaceOfItsOwn) {
    for (const int resolution : {32, 40, 45}) {
        const RowGrid grid = make_grid(room, resolution, 6.0);
        const RowShape shape = make_shape(grid);
        std::vector<bool> taken(grid.rows());
        for (int theta = 0; theta < grid.angles; ++theta)
            for (int phi = 0; phi < grid.angles; ++phi)
                for (int v = 0; v < resolution; ++v)
                    for (int w = 0; w < resolution; ++w) {
                        const std::uint32_t row = kernel::row_index(shape, {theta, phi}, v, w);
                        ASSERT_LT(row, taken.size());
                        ASSERT_FALSE(taken[row]);
                        taken[row] = true;
                    }
    }
}

TEST(VoxelRowsKernel, KeepsExactlyTheBitsOfTheExtent) {
    for (int first = -3; first <= 131; ++first) {
        for (int last = -3; last <= 131; ++last) {
            for (int word = 0; word < 4; ++word) {
                std::uint32_t expected = 0;
                for (int bit = 0; bit < 32; ++bit)
                    if (32 * word + bit >= first && 32 * word + bit <= last) expected |= 1u << bit;
                ASSERT_EQ(kernel::kept_bits(0xffffffffu, word, first, last), expected)
                    << first << ".." << last << " word " << word;
            }
        }
    }
}

TEST(VoxelRowsKernel, ClipsASegmentToTheBounds) {
    const RowShape shape = make_shape(make_grid(room, 32, 6.0));
    vec3 a(0.0f, 1.0f, 0.0f), b(0.0f, 11.0f, 0.0f);
    kernel::clip_to_bounds(shape, a, b);
    EXPECT_FLOAT_EQ(a.y, 1.0f);
    EXPECT_FLOAT_EQ(b.y, 2.5f);
    for (std::uint32_t k = 0; k < 10000; ++k) {
        vec3 from = testing::random_point(room, 3, k);
        vec3 to = from + 20.0f * sphere_direction(random_unit(4, k, 0), random_unit(4, k, 1));
        kernel::clip_to_bounds(shape, from, to);
        for (const vec3 end : {from, to})
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(end, room.lowest - 1e-4f)) &&
                        glm::all(glm::lessThanEqual(end, room.highest + 1e-4f)));
    }
}

TEST(VoxelRowGrid, MapsTheWholeSceneIntoTheVoxelsOfEveryDirection) {
    const RowGrid grid = make_grid(room, 50, 4.0);
    const RowShape shape = make_shape(grid);
    for (const DirectionFrame& frame : grid.frames) {
        float lowest = 1e9f, highest = -1e9f;
        for (int corner = 0; corner < 8; ++corner) {
            const vec3 point(corner & 1 ? room.highest.x : room.lowest.x, corner & 2 ? room.highest.y : room.lowest.y,
                             corner & 4 ? room.highest.z : room.lowest.z);
            const vec3 voxel = voxel_coordinates(shape, frame, point);
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(voxel[axis], 0.0f);
                ASSERT_LE(voxel[axis], 50.0f);
            }
            lowest = std::min(lowest, voxel.x);
            highest = std::max(highest, voxel.x);
        }
        EXPECT_NEAR(lowest, 0.0f, 0.01f);  // fitted, not merely enclosed
        EXPECT_NEAR(highest, 50.0f, 0.01f);
    }
}

TEST(VoxelRowGrid, TurnsRowsIntoColumnsNinetyDegreesOn) {
    const RowGrid grid = make_grid(room, 32, 3.0);
    for (int theta = 0; theta < grid.angles; ++theta) {
        const DirectionFrame& frame = grid.frames[static_cast<std::size_t>(theta * grid.angles + 5)];
        const DirectionFrame& partner =
            grid.frames[static_cast<std::size_t>(theta * grid.angles + 5 + grid.angles / 2)];
        EXPECT_EQ(frame.u, partner.w);
        EXPECT_EQ(frame.w, partner.u);
        EXPECT_NEAR(glm::dot(glm::normalize(frame.u), glm::normalize(frame.w)), 0.0f, 1e-6f);
        EXPECT_NEAR(glm::dot(glm::normalize(frame.u), glm::normalize(level_axis(frame))), 0.0f, 1e-6f);
    }
}

TEST(VoxelRowGrid, NeverUsesACoarserStepThanAsked) {
    for (double step_deg = 1.0; step_deg <= 6.0; step_deg += 0.25) {
        const RowGrid grid = make_grid(room, 32, step_deg);
        EXPECT_EQ(grid.angles % 2, 0);
        EXPECT_LE(180.0 / grid.angles, step_deg + 1e-9);
    }
    EXPECT_EQ(make_grid(room, 32, 2.0).angles, 90);
}

TEST(VoxelRowGrid, WorldFromVoxelsUndoesTheFrame) {
    const RowGrid grid = make_grid(room, 64, 5.0);
    for (std::uint32_t k = 0; k < 200; ++k) {
        const auto direction = static_cast<int>(random_u32(1, k, 0) % grid.frames.size());
        const DirectionFrame& frame = grid.frames[static_cast<std::size_t>(direction)];
        const vec3 point = testing::random_point(room, 5, k);
        const vec4 voxel(voxel_coordinates(make_shape(grid), frame, point), 1.0f);
        EXPECT_LT(glm::distance(vec3(world_from_voxels(grid, direction) * voxel), point), 1e-4f);
    }
}

}  // namespace
}  // namespace sightlines::voxel_rows
