// The scene's surface as point samples on a grid: the input of the fast array build (Wang 2017, Algorithm 6) and of
// the compound deep image.
#pragma once

#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/scene.h"

namespace sightlines {

/// A regular grid over a box; cells may be oblong.
struct FragmentGrid {
    Box3 box;        ///< m
    ivec3 cells{0};  ///< number of cells along each axis, at least 1
};

/// One sample of the surface: a point in the middle of a pixel of the triangle's dominant-axis projection.
struct Fragment {
    vec3 position{0.0f};         ///< m, world, on the triangle
    float area_m2 = 0.0f;        ///< of all surface that the samples of its cell stand for
    std::uint32_t triangle = 0;  ///< the first (lowest) triangle that was sampled in the cell
};

/// Rasterises each triangle along the axis its normal is most aligned with (in cells, so that the depth changes by at
/// most one cell from a pixel to the next), conservatively enough that a triangle that misses every pixel centre still
/// leaves a fragment at its centroid and along its edges, as do long thin triangles along theirs. Keeps one fragment a
/// cell of the grid (the first in triangle order, whatever the number of threads). Sorted by cell, x fastest, then y,
/// then z. What lies outside the box leaves nothing; a sample on the box's faces belongs to the outermost cells.
std::vector<Fragment> surface_fragments(const Scene& scene, const FragmentGrid& grid, int threads, Progress& progress);

/// The triangle's unit normal by its winding; zero where it has no area.
vec3 winding_normal(const Scene& scene, std::uint32_t triangle);

}  // namespace sightlines
