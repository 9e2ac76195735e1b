// Which cells may see what moves: all others need no new rays when it moves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shaders/visibility_field_data.h"
#include "techniques/base/types.h"

namespace sightlines::visibility_field {

/// What the question of all cells shares.
struct MovingReach {
    std::vector<Box3> boxes;             ///< round what moves, at most 32
    std::vector<vec3> texel_directions;  ///< [texels], unit, of their middles
    float texel_radius_rad = 0.0f;       ///< no direction of a texel is further from its middle's
};

MovingReach make_reach(const FieldShape& shape, std::vector<Box3> boxes);

/// The boxes that a ray from a point of the cell may meet, in a direction whose texel is set in `visible`: bit k for
/// box k. Never leaves one out that a ray does meet; by spheres round boxes and cells, so that it may name others too.
/// `visible`: of a finished mask, [words_per_mask].
std::uint32_t boxes_in_reach(const MovingReach& reach, const Box3& cell, std::span<const std::uint32_t> visible);

}  // namespace sightlines::visibility_field
