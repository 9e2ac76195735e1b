// Rays from surfaces out of the scene, packed side by side, answered by Embree.
#pragma once

#include <cstdint>
#include <span>

#include "techniques/rays/embree_scene.h"

namespace sightlines {

/// `count` rays that have no end, unless told otherwise. Each axis is an array of its own that holds at least 16
/// numbers more than it must (a whole last packet).
struct PackedOpenRays {
    const float* origin[3] = {};     ///< m, off the surface: lifted_off
    const float* direction[3] = {};  ///< unit
    std::size_t count = 0;
    const float* length_m = nullptr;  ///< what lies farther is not in the way; null: none has an end
};

/// How far above its surface a ray starts: 1e-5 of the scene's extent.
float lift_m(const EmbreeScene& embree);

/// Where a ray from a surface point with this unit normal starts: lift_m above it.
vec3 lifted_off(const EmbreeScene& embree, vec3 position, vec3 normal);

/// Whether anything is in the way of each ray, by packets of 16. The answer to ray i is bit i % 32 of word i / 32;
/// `blocked` holds enough words, all of which are written.
void are_blocked(const EmbreeScene& embree, const PackedOpenRays& rays, std::span<std::uint32_t> blocked);

/// What each ray hits first, by packets of 16; its triangle is no_triangle where that is nothing. `hits` holds `count`
/// or more.
void find_closest(const EmbreeScene& embree, const PackedOpenRays& rays, std::span<Hit> hits);

/// Whether anything is in the way of one ray.
bool is_blocked(const EmbreeScene& embree, vec3 origin, vec3 direction);

}  // namespace sightlines
