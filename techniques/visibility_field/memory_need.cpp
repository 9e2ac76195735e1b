#include "techniques/visibility_field/memory_need.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "techniques/base/error.h"
#include "techniques/visibility_field/bake.h"
#include "techniques/visibility_field/casting.h"
#include "techniques/visibility_field/surface_cells.h"

namespace sightlines::visibility_field {
namespace {

constexpr double most_bricks = 1 << 26;           // cells are numbered in 32 bits
constexpr double most_along = 1 << 22;            // cells along an axis, whose halves floats still tell apart
constexpr double most_mask_words = 4294967296.0;  // masks are found by 32 bits

/// While Embree builds its tree. Measured on atrium, street, bear and Crytek Sponza, 155,000 to 2.8 million triangles:
/// 141 to 146, of which 103 to 110 stay.
constexpr double tree_bytes_per_triangle = 150.0;

struct Need {
    double bytes = 0.0, bricks = 0.0;
    double longest = 1.0;  ///< cells along an axis
    double mask_words = 0.0;
};

Need need_of(const SurfaceExtent& surface, const BakeOptions& options) {
    const vec3 size = surface.bounds.size();
    double cells = 1.0;
    Need need;
    need.bricks = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double along = std::max(1.0, std::ceil(static_cast<double>(size[axis]) / options.cell_m));
        cells *= along;
        need.longest = std::max(need.longest, along);
        need.bricks *= std::ceil(along / brick_side);
    }
    // A plane passes at most three times as many cells as it has squares of their side; a triangle touches some more.
    const double parts = 3.0 * surface.area_m2 / (static_cast<double>(options.cell_m) * options.cell_m) +
                         6.0 * static_cast<double>(surface.triangles);
    const double occupied = std::min(cells, parts);
    const double words = 2.0 * std::ceil(options.mask_size * options.mask_size / 32.0);
    need.mask_words = occupied * words;
    const bool by_cell = options.placement == Placement::stratified;
    const double points = static_cast<double>(options.points) + (by_cell ? occupied : 0.0);
    const double twice = surface.moves ? 2.0 : 1.0;  // what stands still, and the moment
    const double trees = twice * tree_bytes_per_triangle * static_cast<double>(surface.triangles);
    const double answers = surface.moves ? points * 4.0 * static_cast<double>(words_of_rays(options.rays)) : 0.0;
    need.bytes = trees + answers + need.bricks * sizeof(FieldBrick) + twice * occupied * (8.0 * words + 8.0) +
                 twice * points * static_cast<double>(sizeof(SurfacePoint)) * (by_cell ? 1.0 : 2.3) +
                 (by_cell ? 2.0 * parts * static_cast<double>(sizeof(CellPart)) : 0.0);
    return need;
}

std::string metres_text(float metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g m", static_cast<double>(metres));
    return text;
}

}  // namespace

std::string memory_text(double bytes) {
    constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB", "PB", "EB"};
    int unit = 0;
    for (; bytes >= 1000.0 && unit < 6; ++unit) bytes /= 1000.0;
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %s", bytes, units[unit]);
    return text;
}

double bake_bytes(const SurfaceExtent& surface, const BakeOptions& options) { return need_of(surface, options).bytes; }

void require_memory(const SurfaceExtent& surface, const BakeOptions& options, std::uint64_t available_bytes) {
    const auto fits = [&](const BakeOptions& tried) {
        const Need need = need_of(surface, tried);
        return need.bytes <= static_cast<double>(available_bytes) && need.bricks <= most_bricks &&
               need.longest <= most_along && need.mask_words <= most_mask_words;
    };
    if (fits(options)) return;
    BakeOptions larger = options;
    for (int doubling = 0; doubling < 60 && !fits(larger); ++doubling) larger.cell_m *= 2.0f;
    const double bytes = bake_bytes(surface, options);
    const bool numbered = bytes <= static_cast<double>(available_bytes);
    throw EnvironmentError(
        "memory",
        numbered ? "a visibility field with cells of " + metres_text(options.cell_m) +
                       " has more of them than can be numbered"
                 : "a visibility field with cells of " + metres_text(options.cell_m) + " takes up to " +
                       memory_text(bytes) + ", and " + memory_text(static_cast<double>(available_bytes)) + " are free",
        fits(larger) ? "cells of " + metres_text(larger.cell_m) + " would fit" : "choose fewer point samples");
}

void require_memory(const Scene& scene, const BakeOptions& options, std::uint64_t available_bytes) {
    require_memory({bounds_of_motion(scene), sampled_area(scene), scene.triangles.size(), anything_moves(scene)},
                   options, available_bytes);
}

}  // namespace sightlines::visibility_field
