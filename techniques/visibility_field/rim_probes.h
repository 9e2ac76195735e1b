// Where a cell's masks end: instead of growing both by dilation (Algorithm 1, lines 15 and 16), rays ask the texels
// beside them. Not the paper's.
#pragma once

#include <cstdint>
#include <span>

#include "techniques/rays/embree_scene.h"
#include "techniques/visibility_field/cell_masks.h"
#include "techniques/visibility_field/points.h"

namespace sightlines::visibility_field {

struct ProbeLimits {
    int probes = 0;            ///< rays into one texel, at most
    std::uint64_t budget = 0;  ///< in all; shared out among the texels that are known, but 16 for each
};

/// Asks every texel that touches one of the mask's texels without being set in it, for both masks, and those that touch
/// what is set in turn, until no texel is left that was not asked: by rays from the cell's points, spread evenly over
/// points and texel, most of them close to what is set, until one was open and one blocked. What they meet is set in
/// `masks`, [mask_size] rows. `stream`: chooses the rays, with `seed`. Returns how many were cast.
std::uint64_t probe_rims(const EmbreeScene& embree, std::span<const SurfacePoint> points, int mask_size,
                         ProbeLimits limits, std::uint64_t seed, std::uint32_t stream, MaskPair& masks);

}  // namespace sightlines::visibility_field
