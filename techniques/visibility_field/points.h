// Point samples of the surface, sorted by the grid cell that holds them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/scene/scene.h"
#include "techniques/visibility_field/field.h"

namespace sightlines::visibility_field {

struct BakeOptions;

/// How point samples are spread. `random`: over the whole surface by area, as in the paper. `stratified`: half of them
/// shared out evenly among the cells that hold surface, half by the area in them, at least one a cell; in a cell one in
/// each equal share of its area, triangle by triangle.
enum class Placement { random, stratified };

struct SurfacePoint {
    vec3 position{0.0f};         ///< m
    vec3 normal{0.0f};           ///< unit, geometric, to the side that is sampled
    std::uint32_t triangle = 0;  ///< of the scene
};

/// How many samples a surface gets: for each cell that it lies in, and for each of its square metres.
struct PointDensity {
    double per_cell = 0.0, per_m2 = 0.0;
    bool operator==(const PointDensity&) const = default;
};

/// Points by cell. Cell k, the k-th that holds any, has points first[k] .. first[k + 1] - 1.
struct CellPoints {
    std::vector<std::uint32_t> cells;  ///< 64 * brick + bit in the brick, ascending
    std::vector<std::uint32_t> first;  ///< [cells + 1]
    std::vector<SurfacePoint> points;
    PointDensity density;  ///< all 0 without surface
};

/// Seeded; the same on any number of threads. `parts`: on their surfaces alone. `density`: as densely as this, instead
/// of `options.points` in all.
CellPoints place_points(const Scene& scene, const FieldShape& shape, const BakeOptions& options, Progress& progress,
                        PartChoice parts = PartChoice::all, std::optional<PointDensity> density = {});

/// The place in the grid of a cell as CellPoints numbers it.
ivec3 cell_place(const FieldShape& shape, std::uint32_t cell);

/// CellPoints' number of the cell at a place.
std::uint32_t cell_number(const FieldShape& shape, ivec3 place);

}  // namespace sightlines::visibility_field
