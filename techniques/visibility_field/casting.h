// The rays of one point sample: Algorithm 1, lines 6 to 14, by the wide kernels.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/rays/embree_scene.h"
#include "techniques/visibility_field/mask_rows.h"
#include "techniques/visibility_field/points.h"

namespace sightlines::visibility_field {

/// Mixed into the bake's seed, so that rays are turned by other random numbers than points are placed by.
constexpr std::uint64_t casting_seed = 0x6d61736b73u;

/// Directions spread evenly over a hemisphere, as Hammersley points: azimuth and height. Padded to whole vectors.
struct RaySet {
    int rays = 0;
    std::vector<float> cosine, sine;  ///< of the azimuth
    std::vector<float> height;        ///< in (0, 1), the cosine from the normal
};

RaySet make_ray_set(int rays);

/// What one thread needs again and again.
struct CastingRoom {
    explicit CastingRoom(const RaySet& set);
    std::vector<float> origin[3], direction[3];
    std::vector<int> column, row;
    std::vector<std::uint32_t> blocked;
};

/// Turns the set about the normal and shifts its heights, both at random (`stream` is the point's), casts the rays from
/// the point, and sets the texels that they fall into: of `visible` where nothing is in the way, else of `occluded`.
void cast_from(const EmbreeScene& embree, const RaySet& set, const SurfacePoint& point, int mask_size,
               std::uint64_t seed, std::uint32_t stream, CastingRoom& room, MaskRows& visible, MaskRows& occluded);

}  // namespace sightlines::visibility_field
