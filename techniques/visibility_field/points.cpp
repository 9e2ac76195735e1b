#include "techniques/visibility_field/points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shaders/visibility_field.h"
#include "techniques/base/parallel.h"
#include "techniques/base/random.h"
#include "techniques/visibility_field/bake.h"
#include "techniques/visibility_field/surface_cells.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::int64_t cells_per_task = 64;
constexpr std::int64_t points_per_task = 1 << 14;
constexpr double even_share = 0.5;  // of the points, shared out evenly among the cells

/// The parts of each cell that holds any: parts first[k] .. first[k + 1] - 1.
struct PartsByCell {
    std::vector<CellPart> parts;
    std::vector<std::size_t> first;
    std::vector<double> area_m2;  ///< [cells]
};

PartsByCell parts_by_cell(std::vector<CellPart> parts) {
    PartsByCell sorted{std::move(parts), {}, {}};
    for (std::size_t k = 0; k < sorted.parts.size(); ++k) {
        if (k == 0 || sorted.parts[k].cell != sorted.parts[k - 1].cell) {
            sorted.first.push_back(k);
            sorted.area_m2.push_back(0.0);
        }
        sorted.area_m2.back() += sorted.parts[k].area_m2;
    }
    sorted.first.push_back(sorted.parts.size());
    return sorted;
}

/// So that as many points are shared out among these cells.
PointDensity density_of(const PartsByCell& cells, std::uint32_t points) {
    const double whole = std::reduce(cells.area_m2.begin(), cells.area_m2.end());
    const auto count = static_cast<double>(cells.area_m2.size());
    return {even_share * points / count, (1.0 - even_share) * points / whole};
}

/// How many points each cell gets, as the first number of each.
std::vector<std::uint32_t> shared_out(const PartsByCell& cells, const PointDensity& density) {
    std::vector<std::uint32_t> first{0};
    double due = 0.0;
    std::uint32_t before = 0;
    for (const double area : cells.area_m2) {
        due += density.per_cell + density.per_m2 * area;
        const auto until = static_cast<std::uint32_t>(due + 0.5);
        first.push_back(first.back() + std::max(1u, until - before));
        before = until;
    }
    return first;
}

/// One point in each equal share of a cell's area, part by part.
void place_in_cell(const Scene& scene, const FieldShape& shape, std::span<const CellPart> parts, double area_m2,
                   std::uint64_t seed, std::span<SurfacePoint> points) {
    const std::uint32_t stream = parts.front().cell;
    std::size_t part = 0;
    double before = 0.0;
    for (std::uint32_t k = 0; k < points.size(); ++k) {
        const auto random = [&](std::uint32_t which) { return random_unit(seed, stream, 4 * k + which); };
        const double place = (k + static_cast<double>(random(0))) / static_cast<double>(points.size()) * area_m2;
        while (part + 1 < parts.size() && before + parts[part].area_m2 <= place) before += parts[part++].area_m2;
        const Polygon polygon = polygon_of(scene, shape, parts[part]);
        // Rounding can cut a sliver away; its triangle's middle is as good a place.
        const vec3 position = polygon.count >= 3 ? point_on(polygon, random(1), random(2), random(3))
                                                 : (scene.positions[scene.triangles[parts[part].side / 2].x] +
                                                    scene.positions[scene.triangles[parts[part].side / 2].y] +
                                                    scene.positions[scene.triangles[parts[part].side / 2].z]) /
                                                       3.0f;
        points[k] = {position, side_normal(scene, parts[part].side), parts[part].side / 2};
    }
}

CellPoints stratified(const Scene& scene, const FieldShape& shape, const BakeOptions& options, PartChoice parts,
                      const std::optional<PointDensity>& density, Progress& progress) {
    const PartsByCell cells = parts_by_cell(surface_cells(scene, shape, options.threads, progress, parts));
    CellPoints result;
    const std::size_t count = cells.area_m2.size();
    if (count == 0) return {{}, {0}, {}, {}};
    for (std::size_t k = 0; k < count; ++k) result.cells.push_back(cells.parts[cells.first[k]].cell);
    result.density = density ? *density : density_of(cells, options.points);
    result.first = shared_out(cells, result.density);
    result.points.resize(result.first.back());
    const std::int64_t tasks = (static_cast<std::int64_t>(count) + cells_per_task - 1) / cells_per_task;
    progress.begin("placing point samples", tasks);
    parallel_for(tasks, options.threads, [&](std::int64_t task) {
        const auto begin = static_cast<std::size_t>(task * cells_per_task);
        for (std::size_t k = begin; k < std::min(begin + cells_per_task, count); ++k)
            place_in_cell(scene, shape,
                          std::span(cells.parts).subspan(cells.first[k], cells.first[k + 1] - cells.first[k]),
                          cells.area_m2[k], options.seed,
                          std::span(result.points).subspan(result.first[k], result.first[k + 1] - result.first[k]));
        progress.advance();
    });
    return result;
}

/// Sides that are sampled, and the sum of their areas up to each.
struct SideAreas {
    std::vector<TriangleSide> sides;
    std::vector<double> sums;
};

SideAreas side_areas(const Scene& scene, PartChoice parts) {
    const std::vector<std::uint8_t> wanted = triangles_of(scene, parts);
    SideAreas areas;
    double sum = 0.0;
    for (TriangleSide side = 0; side < 2 * scene.triangles.size(); ++side) {
        if (wanted[side / 2] == 0 || !is_sampled(scene, side) || side_normal(scene, side) == vec3(0.0f)) continue;
        const uvec3 t = scene.triangles[side / 2];
        const dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
        sum += 0.5 * glm::length(glm::cross(b - a, c - a));
        areas.sides.push_back(side);
        areas.sums.push_back(sum);
    }
    return areas;
}

SurfacePoint random_point(const Scene& scene, const SideAreas& areas, std::uint64_t seed, std::uint32_t k) {
    // Two hashes for the place along the summed areas: 24 bits would not tell a million triangles apart.
    const double fine = static_cast<double>(random_u32(seed, k, 0)) * 0x1p-32;
    const double place = (fine + static_cast<double>(random_u32(seed, k, 1))) * 0x1p-32 * areas.sums.back();
    const auto found = std::ranges::upper_bound(areas.sums, place);
    const auto at = std::min(static_cast<std::size_t>(found - areas.sums.begin()), areas.sides.size() - 1);
    const uvec3 t = scene.triangles[areas.sides[at] / 2];
    const float root = std::sqrt(random_unit(seed, k, 2)), v = random_unit(seed, k, 3);
    return {(1.0f - root) * scene.positions[t.x] + root * (1.0f - v) * scene.positions[t.y] +
                root * v * scene.positions[t.z],
            side_normal(scene, areas.sides[at]), areas.sides[at] / 2};
}

std::uint32_t cell_of(const FieldShape& shape, const SurfacePoint& point) {
    const vec3 at = scalar_kernel::lookup_point(shape, point.position, point.normal);
    return cell_number(shape, {scalar_kernel::cell_along(at.x, shape.origin.x, shape.cell_m, shape.cells_x),
                               scalar_kernel::cell_along(at.y, shape.origin.y, shape.cell_m, shape.cells_y),
                               scalar_kernel::cell_along(at.z, shape.origin.z, shape.cell_m, shape.cells_z)});
}

CellPoints random_by_area(const Scene& scene, const FieldShape& shape, const BakeOptions& options, PartChoice parts,
                          const std::optional<PointDensity>& density, Progress& progress) {
    const SideAreas areas = side_areas(scene, parts);
    if (areas.sides.empty()) return {{}, {0}, {}, {}};
    CellPoints result;
    result.density = density ? *density : PointDensity{0.0, options.points / areas.sums.back()};
    const auto count = static_cast<std::size_t>(std::llround(result.density.per_m2 * areas.sums.back()));
    std::vector<SurfacePoint> drawn(count);
    std::vector<std::uint64_t> order(count);  // the cell above, the point's number below
    const std::int64_t tasks = (static_cast<std::int64_t>(count) + points_per_task - 1) / points_per_task;
    progress.begin("placing point samples", tasks);
    parallel_for(tasks, options.threads, [&](std::int64_t task) {
        const auto begin = static_cast<std::size_t>(task * points_per_task);
        for (std::size_t k = begin; k < std::min(begin + points_per_task, drawn.size()); ++k) {
            drawn[k] = random_point(scene, areas, options.seed, static_cast<std::uint32_t>(k));
            order[k] = std::uint64_t{cell_of(shape, drawn[k])} << 32u | k;
        }
        progress.advance();
    });
    std::ranges::sort(order);
    result.points.reserve(drawn.size());
    for (const std::uint64_t each : order) {
        const auto cell = static_cast<std::uint32_t>(each >> 32u);
        if (result.cells.empty() || result.cells.back() != cell) {
            result.cells.push_back(cell);
            result.first.push_back(static_cast<std::uint32_t>(result.points.size()));
        }
        result.points.push_back(drawn[each & 0xffffffffu]);
    }
    result.first.push_back(static_cast<std::uint32_t>(result.points.size()));
    return result;
}

}  // namespace

CellPoints place_points(const Scene& scene, const FieldShape& shape, const BakeOptions& options, Progress& progress,
                        PartChoice parts, std::optional<PointDensity> density) {
    if (options.points == 0) return {{}, {0}, {}, {}};
    return options.placement == Placement::random ? random_by_area(scene, shape, options, parts, density, progress)
                                                  : stratified(scene, shape, options, parts, density, progress);
}

ivec3 cell_place(const FieldShape& shape, std::uint32_t cell) {
    const auto brick = static_cast<int>(cell / 64), bit = static_cast<int>(cell % 64);
    const ivec3 corner(brick % shape.bricks_x, brick / shape.bricks_x % shape.bricks_y,
                       brick / shape.bricks_x / shape.bricks_y);
    return brick_side * corner +
           ivec3(bit % brick_side, bit / brick_side % brick_side, bit / (brick_side * brick_side));
}

std::uint32_t cell_number(const FieldShape& shape, ivec3 place) {
    return 64 * scalar_kernel::brick_of(shape, place.x, place.y, place.z) +
           scalar_kernel::bit_in_brick(place.x, place.y, place.z);
}

}  // namespace sightlines::visibility_field
