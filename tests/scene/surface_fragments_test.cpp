#include "techniques/scene/surface_fragments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "techniques/base/random.h"

namespace sightlines {
namespace {

using Cell = std::tuple<int, int, int>;  // z, y, x: the order of the result

Scene scene_of(std::vector<vec3> corners) {
    Scene scene;
    scene.positions = std::move(corners);
    for (std::uint32_t i = 0; i + 2 < scene.positions.size(); i += 3) scene.triangles.push_back({i, i + 1, i + 2});
    return scene;
}

FragmentGrid unit_cells(ivec3 cells) { return {{vec3(0.0f), vec3(cells)}, cells}; }

std::vector<Fragment> fragments_of(const Scene& scene, const FragmentGrid& grid, int threads = 1) {
    Progress progress;
    return surface_fragments(scene, grid, threads, progress);
}

Cell cell_of(const FragmentGrid& grid, vec3 position) {
    const vec3 point = (position - grid.box.lowest) / grid.box.size() * vec3(grid.cells);
    const ivec3 cell = glm::clamp(ivec3(glm::floor(point)), ivec3(0), grid.cells - 1);
    return {cell.z, cell.y, cell.x};
}

/// Random triangles whose corners are about `size` apart, all inside [0, extent]^3.
Scene random_triangles(int count, float extent, float size, std::uint64_t seed) {
    std::vector<vec3> corners;
    std::uint32_t sample = 0;
    const auto next = [&] { return random_unit(seed, 0, sample++); };
    for (int i = 0; i < count; ++i) {
        const vec3 centre(next() * extent, next() * extent, next() * extent);
        for (int k = 0; k < 3; ++k) {
            const vec3 offset(next() - 0.5f, next() - 0.5f, next() - 0.5f);
            corners.push_back(glm::clamp(centre + size * offset, vec3(0.0f), vec3(extent)));
        }
    }
    return scene_of(corners);
}

double distance_to_triangle(const Scene& scene, const Fragment& fragment) {
    const uvec3 vertices = scene.triangles[fragment.triangle];
    const dvec3 a(scene.positions[vertices.x]), b(scene.positions[vertices.y]), c(scene.positions[vertices.z]);
    const dvec3 p(fragment.position);
    const auto to_segment = [&](dvec3 from, dvec3 to) {
        const dvec3 along = to - from;
        const double length = glm::dot(along, along);
        const double t = length > 0.0 ? glm::clamp(glm::dot(p - from, along) / length, 0.0, 1.0) : 0.0;
        return glm::length(p - (from + t * along));
    };
    const double to_edges = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
    const dvec3 normal = glm::cross(b - a, c - a);
    const bool inside = glm::dot(glm::cross(b - a, p - a), normal) >= 0.0 &&
                        glm::dot(glm::cross(c - b, p - b), normal) >= 0.0 &&
                        glm::dot(glm::cross(a - c, p - c), normal) >= 0.0;
    if (!inside || glm::length(normal) == 0.0) return to_edges;
    return std::abs(glm::dot(p - a, glm::normalize(normal)));
}

/// The naive reference: every pixel centre of the whole grid against every triangle by edge functions.
std::set<Cell> cells_at_pixel_centres(const Scene& scene, const FragmentGrid& grid) {
    std::set<Cell> cells;
    for (const uvec3 vertices : scene.triangles) {
        const dvec3 a(scene.positions[vertices.x]), b(scene.positions[vertices.y]), c(scene.positions[vertices.z]);
        const dvec3 normal = glm::cross(b - a, c - a), size = glm::abs(normal);
        const int w = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        const int u = (w + 1) % 3, v = (w + 2) % 3;
        const auto side = [&](dvec3 from, dvec3 to, dvec2 p) {
            return ((to[u] - from[u]) * (p.y - from[v]) - (to[v] - from[v]) * (p.x - from[u])) * normal[w];
        };
        for (int i = 0; i < grid.cells[u]; ++i) {
            for (int j = 0; j < grid.cells[v]; ++j) {
                const dvec2 p(i + 0.5, j + 0.5);
                // The interior, by a hair: a centre right on an edge may fall to either side.
                if (std::min({side(a, b, p), side(b, c, p), side(c, a, p)}) <= 1e-9) continue;
                const double depth = a[w] - (normal[u] * (p.x - a[u]) + normal[v] * (p.y - a[v])) / normal[w];
                if (std::abs(depth - std::round(depth)) < 1e-6) continue;  // on a cell's face: either is right
                ivec3 cell;
                cell[u] = i;
                cell[v] = j;
                cell[w] = static_cast<int>(std::floor(depth));
                cells.insert({cell.z, cell.y, cell.x});
            }
        }
    }
    return cells;
}

std::vector<Cell> cells_of(const FragmentGrid& grid, const std::vector<Fragment>& fragments) {
    std::vector<Cell> cells;
    for (const Fragment& fragment : fragments) cells.push_back(cell_of(grid, fragment.position));
    return cells;
}

TEST(SurfaceFragments, ShareOutTheAreaOfAllTriangles) {
    for (const float size : {0.3f, 2.0f, 12.0f}) {  // of cells of 1 m: many to a cell, and many cells to one
        const Scene scene = random_triangles(500, 16.0f, size, 8);
        double area = 0.0, shared_out = 0.0;
        for (const uvec3& triangle : scene.triangles) {
            const vec3 a = scene.positions[triangle.x];
            area += 0.5 * static_cast<double>(glm::length(
                              glm::cross(scene.positions[triangle.y] - a, scene.positions[triangle.z] - a)));
        }
        for (const Fragment& fragment : fragments_of(scene, unit_cells(ivec3(16))))
            shared_out += static_cast<double>(fragment.area_m2);
        EXPECT_NEAR(shared_out / area, 1.0, 1e-4) << size;
    }
}

}  // namespace

TEST(SurfaceFragments, HoldEveryPixelCentreThatTheNaiveReferenceFinds) {
    const FragmentGrid grid = unit_cells(ivec3(32));
    for (const float size : {1.0f, 5.0f, 30.0f}) {
        const Scene scene = random_triangles(60, 32.0f, size, 7);
        const std::set<Cell> expected = cells_at_pixel_centres(scene, grid);
        ASSERT_FALSE(expected.empty());
        const std::vector<Cell> found = cells_of(grid, fragments_of(scene, grid));
        const std::set<Cell> found_set(found.begin(), found.end());
        for (const Cell& cell : expected)
            ASSERT_TRUE(found_set.contains(cell)) << "size " << size << ", cell " << std::get<2>(cell) << " "
                                                  << std::get<1>(cell) << " " << std::get<0>(cell);
    }
}

TEST(SurfaceFragments, LeaveNoCellThatNoTrianglePassesThrough) {
    // Dense sampling of the triangles is a superset of what may be found.
    const FragmentGrid grid = unit_cells(ivec3(16));
    const Scene scene = random_triangles(20, 16.0f, 8.0f, 3);
    std::set<Cell> touched;
    constexpr int steps = 400;
    for (const uvec3 vertices : scene.triangles) {
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; j <= steps - i; ++j) {
                const float u = static_cast<float>(i) / steps, v = static_cast<float>(j) / steps;
                touched.insert(cell_of(grid, (1.0f - u - v) * scene.positions[vertices.x] +
                                                 u * scene.positions[vertices.y] + v * scene.positions[vertices.z]));
            }
        }
    }
    const std::vector<Cell> found = cells_of(grid, fragments_of(scene, grid));
    for (const Cell& cell : found) EXPECT_TRUE(touched.contains(cell));
    EXPECT_FALSE(found.empty());
}

TEST(SurfaceFragments, LieOnTheirTriangleAndComeOneToACellInOrder) {
    FragmentGrid grid;
    grid.box = {{-3.0f, 2.0f, 10.0f}, {5.0f, 3.5f, 22.0f}};  // oblong cells, off the origin
    grid.cells = {40, 11, 64};
    Scene scene = random_triangles(400, 1.0f, 0.3f, 11);
    for (vec3& position : scene.positions) position = grid.box.lowest + position * grid.box.size();
    const std::vector<Fragment> fragments = fragments_of(scene, grid);
    ASSERT_GT(fragments.size(), 1000u);
    const vec3 cell_size = grid.box.size() / vec3(grid.cells);
    for (const Fragment& fragment : fragments) {
        ASSERT_LT(fragment.triangle, scene.triangles.size());
        EXPECT_LT(distance_to_triangle(scene, fragment), 1e-4 * cell_size.y);
    }
    const std::vector<Cell> cells = cells_of(grid, fragments);
    EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end(), std::less_equal<>{}));  // strictly ascending
}

TEST(SurfaceFragments, DoNotDependOnTheNumberOfThreads) {
    const Scene scene = random_triangles(20000, 64.0f, 3.0f, 5);
    const FragmentGrid grid = unit_cells(ivec3(64));
    const std::vector<Fragment> one = fragments_of(scene, grid, 1);
    for (const int threads : {2, 0}) {
        const std::vector<Fragment> many = fragments_of(scene, grid, threads);
        ASSERT_EQ(one.size(), many.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            ASSERT_EQ(one[i].position, many[i].position);
            ASSERT_EQ(one[i].triangle, many[i].triangle);
        }
    }
}

TEST(SurfaceFragments, BelongToTheLowestTriangleOfTheirCell) {
    const std::vector<vec3> square = {{0, 1.5f, 0}, {0, 1.5f, 8}, {8, 1.5f, 0}};
    std::vector<vec3> corners;
    for (int copy = 0; copy < 5000; ++copy) {  // more than one task takes
        for (const vec3 corner : square)
            corners.push_back(corner + vec3(0.0f, 0.00001f * static_cast<float>(copy), 0.0f));
    }
    const std::vector<Fragment> fragments = fragments_of(scene_of(corners), unit_cells(ivec3(8)), 2);
    ASSERT_GE(fragments.size(), 28u);
    for (const Fragment& fragment : fragments) EXPECT_EQ(fragment.triangle, 0u);
}

TEST(SurfaceFragments, OfATinyTriangleIsAtLeastOne) {
    const Scene scene = scene_of({{3.1f, 4.1f, 5.1f}, {3.2f, 4.1f, 5.1f}, {3.1f, 4.2f, 5.15f}});
    const std::vector<Fragment> fragments = fragments_of(scene, unit_cells(ivec3(8)));
    ASSERT_EQ(fragments.size(), 1u);
    EXPECT_EQ(cell_of(unit_cells(ivec3(8)), fragments[0].position), Cell(5, 4, 3));
}

TEST(SurfaceFragments, OfADegenerateTriangleLieAlongItsEdges) {
    const Scene scene = scene_of({{0.2f, 0.2f, 0.2f}, {7.8f, 0.2f, 0.2f}, {4.0f, 0.2f, 0.2f}});
    EXPECT_EQ(fragments_of(scene, unit_cells(ivec3(8))).size(), 8u);
    const Scene point = scene_of({vec3(2.5f), vec3(2.5f), vec3(2.5f)});
    EXPECT_EQ(fragments_of(point, unit_cells(ivec3(8))).size(), 1u);
}

TEST(SurfaceFragments, OfALongSliverHaveNoGap) {
    // 0.05 cells wide: nearly every pixel centre is missed.
    const Scene scene = scene_of({{0.1f, 3.2f, 1.3f}, {31.9f, 3.2f, 14.7f}, {31.9f, 3.2f, 14.75f}});
    const FragmentGrid grid = unit_cells(ivec3(32));
    std::set<int> columns;
    for (const Cell& cell : cells_of(grid, fragments_of(scene, grid))) columns.insert(std::get<2>(cell));
    EXPECT_EQ(columns.size(), 32u);
}

TEST(SurfaceFragments, OfASlantedPlaneHaveNoHoles) {
    // A finely divided plane that slants both ways: every column of the grid must be found once at least, whichever way
    // its triangles fall between the pixel centres.
    for (const int divisions : {1, 3, 17, 40, 100}) {
        std::vector<vec3> corners;
        const auto at = [&](int i, int j) {
            const float x = 24.0f * static_cast<float>(i) / static_cast<float>(divisions);
            const float z = 24.0f * static_cast<float>(j) / static_cast<float>(divisions);
            return vec3(x, 1.0f + 0.53f * x + 0.31f * z, z);
        };
        for (int i = 0; i < divisions; ++i) {
            for (int j = 0; j < divisions; ++j) {
                for (const ivec2 corner :
                     {ivec2(0, 0), ivec2(0, 1), ivec2(1, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1)})
                    corners.push_back(at(i + corner.x, j + corner.y));
            }
        }
        const FragmentGrid grid = unit_cells(ivec3(24));
        std::set<std::pair<int, int>> columns;
        for (const Cell& cell : cells_of(grid, fragments_of(scene_of(corners), grid)))
            columns.insert({std::get<0>(cell), std::get<2>(cell)});
        EXPECT_EQ(columns.size(), 24u * 24u) << divisions << " divisions";
    }
}

TEST(SurfaceFragments, OnTheFacesOfTheBoxBelongToTheOutermostCells) {
    const float top = 0.3f;  // not exact in binary
    const Scene scene = scene_of({{0, top, 0}, {0, top, 1}, {1, top, 0}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
    const FragmentGrid grid{{vec3(0.0f), vec3(1.0f, top, 1.0f)}, ivec3(10)};
    std::set<int> rows;
    for (const Fragment& fragment : fragments_of(scene, grid))
        rows.insert(std::get<1>(cell_of(grid, fragment.position)));
    EXPECT_EQ(rows, (std::set<int>{0, 9}));
}

TEST(SurfaceFragments, LeaveOutWhatIsOutsideTheBox) {
    const Scene outside = scene_of({{10, 10, 10}, {12, 10, 10}, {10, 12, 10}});
    EXPECT_TRUE(fragments_of(outside, unit_cells(ivec3(8))).empty());
    // A triangle far larger than the box covers every column of it, and the work stays that of the box.
    const Scene across = scene_of({{-1e6f, 2.5f, -1e6f}, {1e6f, 2.5f, -1e6f}, {0.0f, 2.5f, 1e6f}});
    EXPECT_EQ(fragments_of(across, unit_cells(ivec3(8))).size(), 64u);
}

TEST(SurfaceFragments, OfAFlatSceneLieInOneLayer) {
    const Scene scene = scene_of({{0, 2, 0}, {0, 2, 4}, {4, 2, 0}, {4, 2, 0}, {0, 2, 4}, {4, 2, 4}});
    const FragmentGrid grid{{{0, 2, 0}, {4, 2, 4}}, ivec3(4, 1, 4)};
    const std::vector<Fragment> fragments = fragments_of(scene, grid);
    EXPECT_EQ(fragments.size(), 16u);
    for (const Fragment& fragment : fragments) EXPECT_EQ(fragment.position.y, 2.0f);
}

TEST(SurfaceFragments, OfNothingAreNone) {
    EXPECT_TRUE(fragments_of(Scene{}, unit_cells(ivec3(8))).empty());
    EXPECT_TRUE(fragments_of(scene_of({vec3(0), vec3(1), vec3(2)}), {Box3{}, ivec3(8)}).empty());
}

TEST(SurfaceFragments, OfATriangleWithACornerThatIsNowhereAreNone) {
    for (const float nowhere : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        const Scene scene = scene_of(
            {{1, 1, 1}, {5, 1, 1}, {1, nowhere, 1}, {3.1f, 4.1f, 5.1f}, {3.2f, 4.1f, 5.1f}, {3.1f, 4.2f, 5.15f}});
        const std::vector<Fragment> fragments = fragments_of(scene, unit_cells(ivec3(8)));
        ASSERT_EQ(fragments.size(), 1u);
        EXPECT_EQ(fragments[0].triangle, 1u);
    }
}

TEST(SurfaceFragments, StopWhenCancelled) {
    Progress progress;
    progress.cancel();
    EXPECT_THROW(surface_fragments(random_triangles(10, 8.0f, 2.0f, 1), unit_cells(ivec3(8)), 1, progress), Cancelled);
}

}  // namespace sightlines
