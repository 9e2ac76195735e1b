// Which triangles lie in which cells of the grid, and with how much of their area.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/scene/scene.h"
#include "techniques/visibility_field/field.h"

namespace sightlines::visibility_field {

/// A convex polygon: a triangle cut by at most six planes.
struct Polygon {
    std::array<vec3, 9> corners;
    int count = 0;
};

/// One side of a triangle: 2 * triangle, plus 1 for its back.
using TriangleSide = std::uint32_t;

/// The part of a triangle's side that lies in a cell.
struct CellPart {
    std::uint32_t cell = 0;  ///< 64 * brick + bit in the brick
    TriangleSide side = 0;
    float area_m2 = 0.0f;
};

/// The unit normal of a triangle's side; zero where the triangle has no area.
vec3 side_normal(const Scene& scene, TriangleSide side);

/// Whether a side is sampled: fronts always, backs of double-sided materials.
bool is_sampled(const Scene& scene, TriangleSide side);

/// Area of all sides that are sampled, m2.
double sampled_area(const Scene& scene, PartChoice parts = PartChoice::all);

/// All parts with an area, by cell, then by side. As a lookup does, a side is looked for a nudge above its surface.
std::vector<CellPart> surface_cells(const Scene& scene, const FieldShape& shape, int threads, Progress& progress,
                                    PartChoice parts = PartChoice::all);

/// The polygon of a part, on the surface itself.
Polygon polygon_of(const Scene& scene, const FieldShape& shape, const CellPart& part);

float polygon_area(const Polygon& polygon);

/// Uniform on the polygon from three uniform numbers.
vec3 point_on(const Polygon& polygon, float which, float u, float v);

}  // namespace sightlines::visibility_field
