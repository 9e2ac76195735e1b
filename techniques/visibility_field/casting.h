// The rays of one point sample: Algorithm 1, lines 6 to 14, by the wide kernels.
#pragma once

#include <cstdint>
#include <span>
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

/// Words that hold a bit for each ray of a point.
constexpr std::size_t words_of_rays(int rays) { return (static_cast<std::size_t>(rays) + 31) / 32; }

/// What one thread needs again and again: a point's rays.
struct CastingRoom {
    explicit CastingRoom(const RaySet& set);
    std::vector<float> origin[3], direction[3];
    std::vector<int> column, row;                 ///< the texel that each ray falls into
    std::vector<std::uint32_t> blocked;           ///< ray k in bit k % 32 of word k / 32; [words_of_rays] and one more
    std::vector<std::uint32_t> chosen, answered;  ///< of cast_into: numbers of rays, and answers
    std::vector<float> chosen_direction[3];
};

/// The number that a point's rays are turned by: of its place alone, so that it does not matter which others there are.
std::uint32_t ray_stream(const SurfacePoint& point);

/// Turns the set about the normal and shifts its heights, both at random by ray_stream: directions and texels.
void aim_from(const RaySet& set, const SurfacePoint& point, int mask_size, std::uint64_t seed, CastingRoom& room);

struct CastCounts {
    std::size_t cast = 0, blocked = 0;
};

/// Of the aimed rays casts only those whose bits in `room.blocked` are clear and that pass through one of the boxes,
/// outside of which `embree` has nothing, and sets the bits of those that meet something.
CastCounts cast_into(std::span<const Box3> boxes, const EmbreeScene& embree, const RaySet& set, vec3 start,
                     CastingRoom& room);

/// Sets the texels that the rays fall into: of `visible` where nothing is in the way, else of `occluded`.
void mark_answers(const RaySet& set, const CastingRoom& room, MaskRows& visible, MaskRows& occluded);

/// Aims, casts all rays from above the point, whose answers stay in `room.blocked`, and marks them.
void cast_from(const EmbreeScene& embree, const RaySet& set, const SurfacePoint& point, int mask_size,
               std::uint64_t seed, CastingRoom& room, MaskRows& visible, MaskRows& occluded);

}  // namespace sightlines::visibility_field
