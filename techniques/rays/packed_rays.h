// Shadow rays to one light, packed side by side, answered by Embree.
#pragma once

#include <cstdint>
#include <span>

#include "shaders/lighting_data.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/rays/reference.h"

namespace sightlines {

/// `count` surface points and their normals, each axis an array of its own that holds at least 16 numbers more than
/// it must (a whole last packet).
struct PackedSurfaces {
    const float* position[3] = {};  ///< m
    const float* normal[3] = {};    ///< unit, turned towards the camera
    std::size_t count = 0;
};

/// Whether each point is hidden from the light: the rays that the reference asks. The answer to ray i is
/// bit i % bits_per_word of word i / bits_per_word; `blocked` holds enough words, all of which are written.
void are_occluded(const EmbreeScene& embree, EmbreeVariant variant, const LightRecord& light,
                  const PackedSurfaces& surfaces, std::size_t bits_per_word, std::span<std::uint32_t> blocked);

}  // namespace sightlines
