// What the cells of a field know of local area lights: for each part of the lights, whether some segment between it and
// a point of the cell was open, and whether some was blocked. As the masks are of the environment (equations 5 and 6).
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/visibility_field/area_lights.h"
#include "techniques/visibility_field/points.h"

namespace sightlines::visibility_field {

constexpr std::size_t surface_sides = 6;

/// Which of the six axes' directions a surface faces most: what lies on a shelf sees other lights than what hangs
/// below.
std::size_t side_of(vec3 normal);

/// Immutable once baked. Empty (no words): nothing is known.
struct AreaSight {
    std::size_t words = 0;            ///< that hold a bit for each part of the lights
    std::vector<std::uint32_t> rows;  ///< [cells of the field][surface_sides]: the row of bits
    std::vector<std::uint32_t> bits;  ///< [rows][seen, hidden][words], each row once
    std::uint64_t rays = 0;           ///< that were cast
    double seconds = 0.0;

    std::size_t bytes() const { return (rows.size() + bits.size()) * sizeof(std::uint32_t); }
    /// Where the bits of a cell's surfaces that face a side start: those of what was seen, then of what was hidden.
    std::size_t place(std::uint32_t cell, std::size_t side) const {
        return std::size_t{rows[std::size_t{cell} * surface_sides + side]} * 2 * words;
    }
    bool seen(std::size_t place, std::uint32_t part) const {
        return (bits[place + part / 32] >> (part % 32) & 1u) != 0;
    }
    bool hidden(std::size_t place, std::uint32_t part) const { return seen(place + words, part); }
};

/// How segments are cast.
struct SightOptions {
    /// From each side of a cell to each part of the lights, fewer where both answers came; 0: nothing is baked.
    int rays = 0;
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0: all. Never changes the result
};

/// Casts from the points that the field was baked from. A pure function of these, whatever the threads. Cancelled.
AreaSight bake_area_sight(const Scene& scene, const VisibilityField& field, const EmbreeScene& embree,
                          const CellPoints& points, const SightOptions& options, Progress& progress);

}  // namespace sightlines::visibility_field
