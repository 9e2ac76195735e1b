// Where the surface lies in the grid, and the samples on it.
#include "techniques/visibility_field/points.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "shaders/visibility_field.h"
#include "techniques/visibility_field/surface_cells.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

CellPoints placed(const Scene& scene, const FieldShape& shape, const BakeOptions& options) {
    Progress progress;
    return place_points(scene, shape, options, progress);
}

ivec3 looked_up(const FieldShape& shape, const SurfacePoint& point) {
    const vec3 at = scalar_kernel::lookup_point(shape, point.position, point.normal);
    return glm::clamp(ivec3(glm::floor((at - shape.origin) / shape.cell_m)), ivec3(0),
                      ivec3(shape.cells_x, shape.cells_y, shape.cells_z) - 1);
}

TEST(FieldShape, HoldsTheBoundsInItsMiddle) {
    const FieldShape shape = make_shape({vec3(-1.0f, 0.0f, 2.0f), vec3(1.2f, 0.4f, 7.0f)}, 0.5f, 18);
    EXPECT_EQ(ivec3(shape.cells_x, shape.cells_y, shape.cells_z), ivec3(5, 1, 10));
    EXPECT_NEAR(shape.origin.x, -1.15f, 1e-6f);
    EXPECT_NEAR(shape.origin.y, -0.05f, 1e-6f);
    EXPECT_NEAR(shape.origin.z, 2.0f, 1e-6f);
    EXPECT_EQ(shape.words_per_mask, 11);
    EXPECT_EQ(brick_count(shape), std::size_t{2} * 1 * 3);
    EXPECT_EQ(make_shape({}, 0.5f, 8).cells_x, 1);
}

TEST(FieldShape, NumbersOfCellsComeBackToTheirPlaces) {
    const FieldShape shape = make_shape({vec3(0.0f), vec3(9.0f, 6.0f, 5.0f)}, 0.5f, 18);
    std::map<std::uint32_t, int> seen;
    for (int z = 0; z < shape.cells_z; ++z)
        for (int y = 0; y < shape.cells_y; ++y)
            for (int x = 0; x < shape.cells_x; ++x) {
                const std::uint32_t number = cell_number(shape, {x, y, z});
                ASSERT_EQ(cell_place(shape, number), ivec3(x, y, z));
                ++seen[number];
            }
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(shape.cells_x * shape.cells_y * shape.cells_z));
}

TEST(SurfaceCells, PartsOfATriangleAddUpToItsArea) {
    const Scene scene = testing::courtyard();
    const FieldShape shape = make_shape(scene.bounds, 0.37f, 18);
    Progress progress;
    std::map<TriangleSide, double> areas;
    for (const CellPart& part : surface_cells(scene, shape, 2, progress)) areas[part.side] += part.area_m2;
    double whole = 0.0;
    for (const auto& [side, area] : areas) {
        const uvec3 t = scene.triangles[side / 2];
        const double expected = 0.5 * glm::length(glm::cross(scene.positions[t.y] - scene.positions[t.x],
                                                             scene.positions[t.z] - scene.positions[t.x]));
        ASSERT_NEAR(area, expected, 1e-4 * expected + 1e-6);
        ASSERT_TRUE(is_sampled(scene, side));
        whole += area;
    }
    EXPECT_NEAR(whole, sampled_area(scene), 1e-4 * whole);
}

TEST(SurfaceCells, BacksAreSampledOfDoubleSidedMaterialsOnly) {
    const Scene scene = testing::courtyard();
    int backs = 0;
    for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
        EXPECT_TRUE(is_sampled(scene, 2 * triangle));
        backs += is_sampled(scene, 2 * triangle + 1);
    }
    EXPECT_EQ(backs, 2);  // the sheet's
}

TEST(SurfaceCells, EveryCellThatARandomPointFallsIntoHasAPart) {
    const Scene scene = testing::courtyard();
    const FieldShape shape = make_shape(scene.bounds, 0.5f, 18);
    Progress progress;
    std::map<std::uint32_t, double> areas;
    for (const CellPart& part : surface_cells(scene, shape, 2, progress)) areas[part.cell] += part.area_m2;
    BakeOptions options = testing::small_bake();
    options.placement = Placement::random;
    options.points = 100'000;
    const CellPoints random = placed(scene, shape, options);
    ASSERT_EQ(random.points.size(), 100'000u);
    for (const std::uint32_t cell : random.cells) EXPECT_TRUE(areas.contains(cell)) << cell;
}

class Placements : public ::testing::TestWithParam<Placement> {};

TEST_P(Placements, PutEveryPointOnItsTriangleAndInItsCell) {
    const Scene scene = testing::courtyard();
    const FieldShape shape = make_shape(scene.bounds, 0.5f, 18);
    BakeOptions options = testing::small_bake();
    options.placement = GetParam();
    const CellPoints points = placed(scene, shape, options);
    ASSERT_GE(points.points.size(), options.points);
    ASSERT_EQ(points.first.size(), points.cells.size() + 1);
    int elsewhere = 0;
    for (std::size_t cell = 0; cell < points.cells.size(); ++cell) {
        ASSERT_LT(points.first[cell], points.first[cell + 1]);
        for (std::uint32_t k = points.first[cell]; k < points.first[cell + 1]; ++k) {
            const SurfacePoint& point = points.points[k];
            const uvec3 t = scene.triangles[point.triangle];
            const vec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
            ASSERT_NEAR(glm::dot(point.position - a, point.normal), 0.0f, 1e-5f);
            ASSERT_NEAR(glm::length(point.normal), 1.0f, 1e-5f);
            const float split = glm::length(glm::cross(a - point.position, b - point.position)) +
                                glm::length(glm::cross(b - point.position, c - point.position)) +
                                glm::length(glm::cross(c - point.position, a - point.position));
            ASSERT_NEAR(split, glm::length(glm::cross(b - a, c - a)), 1e-3f);
            elsewhere += looked_up(shape, point) != cell_place(shape, points.cells[cell]);
        }
    }
    EXPECT_LE(elsewhere, 5);  // rounding, on a cell's face
}

TEST_P(Placements, AreTheSameOnAnyNumberOfThreads) {
    const Scene scene = testing::courtyard();
    const FieldShape shape = make_shape(scene.bounds, 0.5f, 18);
    BakeOptions options = testing::small_bake();
    options.placement = GetParam();
    options.threads = 1;
    const CellPoints one = placed(scene, shape, options);
    options.threads = 2;
    const CellPoints two = placed(scene, shape, options);
    options.seed = 2;
    const CellPoints other = placed(scene, shape, options);
    ASSERT_EQ(one.cells, two.cells);
    bool same_as_other = true;
    for (std::size_t k = 0; k < one.points.size(); ++k) {
        ASSERT_EQ(one.points[k].position, two.points[k].position);
        same_as_other = same_as_other && k < other.points.size() && one.points[k].position == other.points[k].position;
    }
    EXPECT_FALSE(same_as_other);
}

INSTANTIATE_TEST_SUITE_P(Both, Placements, ::testing::Values(Placement::random, Placement::stratified));

TEST(Placements, RandomPointsGoByArea) {
    Scene scene = testing::one_sided_scene();
    test::add_triangle(scene, {0, 0, 0}, {3, 0, 0}, {0, 1, 0});
    test::add_triangle(scene, {0, 0, 5}, {1, 0, 5}, {0, 1, 5});
    BakeOptions options = testing::small_bake();
    options.placement = Placement::random;
    options.points = 40'000;
    int large = 0;
    for (const SurfacePoint& point : placed(scene, make_shape(scene.bounds, 0.5f, 18), options).points)
        large += point.triangle == 0;
    EXPECT_NEAR(large, 30'000, 500);
}

TEST(Placements, StratifiedPointsGiveEveryCellWithSurfaceItsShare) {
    const Scene scene = testing::courtyard();
    const FieldShape shape = make_shape(scene.bounds, 0.5f, 18);
    Progress progress;
    std::map<std::uint32_t, double> areas;
    for (const CellPart& part : surface_cells(scene, shape, 2, progress)) areas[part.cell] += part.area_m2;
    const BakeOptions options = testing::small_bake();
    const CellPoints points = placed(scene, shape, options);
    ASSERT_EQ(points.cells.size(), areas.size());
    const double even = 0.5 * options.points / static_cast<double>(areas.size());
    const double by_area = 0.5 * options.points / sampled_area(scene);
    for (std::size_t cell = 0; cell < points.cells.size(); ++cell)
        EXPECT_NEAR(points.first[cell + 1] - points.first[cell], even + by_area * areas[points.cells[cell]], 1.01);
}

TEST(Placements, AScenesWithoutSurfaceGivesNoPoints) {
    Scene scene = test::scene_with_material();
    EXPECT_TRUE(placed(scene, make_shape(scene.bounds, 0.5f, 18), testing::small_bake()).cells.empty());
    test::add_triangle(scene, {0, 0, 0}, {1, 1, 1}, {2, 2, 2});  // a line
    for (const Placement placement : {Placement::random, Placement::stratified}) {
        BakeOptions options = testing::small_bake();
        options.placement = placement;
        EXPECT_TRUE(placed(scene, make_shape(scene.bounds, 0.5f, 18), options).points.empty());
    }
}

}  // namespace
}  // namespace sightlines::visibility_field
