#include "techniques/visibility_field/surface_cells.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "shaders/visibility_field.h"
#include "techniques/base/parallel.h"
#include "techniques/visibility_field/points.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::size_t triangles_per_task = 4096;

int cells_along(const FieldShape& shape, int axis) {
    return axis == 0 ? shape.cells_x : axis == 1 ? shape.cells_y : shape.cells_z;
}

/// The part of a convex polygon where sign * (coordinate - plane) <= 0.
Polygon cut(const Polygon& polygon, int axis, float plane, float sign) {
    Polygon result;
    for (int k = 0; k < polygon.count; ++k) {
        const vec3 from = polygon.corners[static_cast<std::size_t>(k)];
        const vec3 to = polygon.corners[static_cast<std::size_t>((k + 1) % polygon.count)];
        const float a = sign * (from[axis] - plane), b = sign * (to[axis] - plane);
        const auto add = [&](vec3 corner) {
            if (result.count < static_cast<int>(result.corners.size()))
                result.corners[static_cast<std::size_t>(result.count++)] = corner;
        };
        if (a <= 0.0f) add(from);
        if ((a < 0.0f && b > 0.0f) || (a > 0.0f && b < 0.0f)) {
            vec3 crossing = glm::mix(from, to, a / (a - b));
            crossing[axis] = plane;
            add(crossing);
        }
    }
    return result;
}

/// Cuts the polygon into its cells along `axis` and the axes after it; calls visit(cell's place, polygon in it).
template <class Visit>
void for_each_cell(const Polygon& polygon, const FieldShape& shape, int axis, ivec3 place, const Visit& visit) {
    if (axis == 3) return visit(place, polygon);
    float lowest = polygon.corners[0][axis], highest = lowest;
    for (int k = 1; k < polygon.count; ++k) {
        lowest = std::min(lowest, polygon.corners[static_cast<std::size_t>(k)][axis]);
        highest = std::max(highest, polygon.corners[static_cast<std::size_t>(k)][axis]);
    }
    const auto cell = [&](float at) {
        return scalar_kernel::cell_along(at, shape.origin[axis], shape.cell_m, cells_along(shape, axis));
    };
    const int last = cell(highest);
    Polygon rest = polygon;
    for (int k = cell(lowest); k <= last && rest.count >= 3; ++k) {
        place[axis] = k;
        if (k == last) return for_each_cell(rest, shape, axis + 1, place, visit);
        const float plane = shape.origin[axis] + static_cast<float>(k + 1) * shape.cell_m;
        const Polygon below = cut(rest, axis, plane, 1.0f);
        if (below.count >= 3) for_each_cell(below, shape, axis + 1, place, visit);
        rest = cut(rest, axis, plane, -1.0f);
    }
}

Polygon triangle_of(const Scene& scene, TriangleSide side, vec3 offset) {
    const uvec3 corners = scene.triangles[side / 2];
    Polygon polygon;
    polygon.corners[0] = scene.positions[corners.x] + offset;
    polygon.corners[1] = scene.positions[corners.y] + offset;
    polygon.corners[2] = scene.positions[corners.z] + offset;
    polygon.count = 3;
    return polygon;
}

}  // namespace

vec3 side_normal(const Scene& scene, TriangleSide side) {
    const uvec3 corners = scene.triangles[side / 2];
    const dvec3 a(scene.positions[corners.x]), b(scene.positions[corners.y]), c(scene.positions[corners.z]);
    const dvec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    if (!(length > 0.0) || !std::isfinite(length)) return vec3(0.0f);
    return vec3(cross / (side % 2 == 0 ? length : -length));
}

bool is_sampled(const Scene& scene, TriangleSide side) {
    return side % 2 == 0 || scene.materials[scene.triangle_materials[side / 2]].double_sided;
}

double sampled_area(const Scene& scene, PartChoice parts) {
    const std::vector<std::uint8_t> wanted = triangles_of(scene, parts);
    double area = 0.0;
    for (TriangleSide side = 0; side < 2 * scene.triangles.size(); ++side)
        if (wanted[side / 2] != 0 && is_sampled(scene, side))
            area += polygon_area(triangle_of(scene, side, vec3(0.0f)));
    return area;
}

std::vector<CellPart> surface_cells(const Scene& scene, const FieldShape& shape, int threads, Progress& progress,
                                    PartChoice choice) {
    const std::vector<std::uint8_t> wanted = triangles_of(scene, choice);
    const std::size_t tasks = (scene.triangles.size() + triangles_per_task - 1) / triangles_per_task;
    std::vector<std::vector<CellPart>> found(tasks);
    progress.begin("finding the cells of the surface", static_cast<std::int64_t>(tasks));
    parallel_for(static_cast<std::int64_t>(tasks), threads, [&](std::int64_t task) {
        std::vector<CellPart>& parts = found[static_cast<std::size_t>(task)];
        const std::size_t first = static_cast<std::size_t>(task) * triangles_per_task;
        const std::size_t last = std::min(first + triangles_per_task, scene.triangles.size());
        for (auto side = static_cast<TriangleSide>(2 * first); side < 2 * last; ++side) {
            if (wanted[side / 2] == 0) continue;
            const vec3 normal = side_normal(scene, side);
            if (normal == vec3(0.0f) || !is_sampled(scene, side)) continue;
            for_each_cell(triangle_of(scene, side, shape.nudge_m * normal), shape, 0, ivec3(0),
                          [&](ivec3 place, const Polygon& polygon) {
                              const float area = polygon_area(polygon);
                              if (area > 0.0f) parts.push_back({cell_number(shape, place), side, area});
                          });
        }
        std::ranges::sort(parts, {}, [](const CellPart& part) { return std::tuple(part.cell, part.side); });
        progress.advance();
    });
    std::vector<CellPart> all;
    for (std::vector<CellPart>& parts : found) {
        all.insert(all.end(), parts.begin(), parts.end());
        parts = {};
    }
    std::ranges::sort(all, {}, [](const CellPart& part) { return std::tuple(part.cell, part.side); });
    return all;
}

Polygon polygon_of(const Scene& scene, const FieldShape& shape, const CellPart& part) {
    const vec3 offset = shape.nudge_m * side_normal(scene, part.side);
    Polygon polygon = triangle_of(scene, part.side, offset);
    const ivec3 place = cell_place(shape, part.cell);
    for (int axis = 0; axis < 3; ++axis) {
        const float lower = shape.origin[axis] + static_cast<float>(place[axis]) * shape.cell_m;
        const float upper = shape.origin[axis] + static_cast<float>(place[axis] + 1) * shape.cell_m;
        // The outermost cells also hold what rounding put beyond them.
        if (place[axis] > 0) polygon = cut(polygon, axis, lower, -1.0f);
        if (place[axis] + 1 < cells_along(shape, axis)) polygon = cut(polygon, axis, upper, 1.0f);
    }
    for (vec3& corner : polygon.corners) corner -= offset;
    return polygon;
}

float polygon_area(const Polygon& polygon) {
    float area = 0.0f;
    for (int k = 2; k < polygon.count; ++k)
        area += 0.5f * glm::length(glm::cross(polygon.corners[static_cast<std::size_t>(k - 1)] - polygon.corners[0],
                                              polygon.corners[static_cast<std::size_t>(k)] - polygon.corners[0]));
    return area;
}

vec3 point_on(const Polygon& polygon, float which, float u, float v) {
    float left = which * polygon_area(polygon);
    const float root = std::sqrt(u);
    for (int k = 2; k < polygon.count; ++k) {
        const vec3 a = polygon.corners[0], b = polygon.corners[static_cast<std::size_t>(k - 1)],
                   c = polygon.corners[static_cast<std::size_t>(k)];
        const float area = 0.5f * glm::length(glm::cross(b - a, c - a));
        if (left <= area || k + 1 == polygon.count) return (1.0f - root) * a + root * (1.0f - v) * b + root * v * c;
        left -= area;
    }
    return polygon.corners[0];
}

}  // namespace sightlines::visibility_field
