// Sorting packed rays by direction, so that the rays of one packet go the same way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/rays/embree_scene.h"

namespace sightlines::visibility_field {

/// What one thread needs again and again.
struct SortingRoom {
    std::vector<std::uint32_t> key, place;
    std::vector<float> origin[3], direction[3];
    std::vector<std::uint32_t> blocked;
};

/// Answers the packed rays as are_blocked does, but asks Embree for them by direction: by the texels of an octahedral
/// map of 32 x 32 in the order of a Z curve, and where these are alike in the order in which they came. Each axis of
/// `origin` and `direction` holds at least `count` numbers and 16 more.
void are_blocked_by_direction(const EmbreeScene& embree, const float* const origin[3], const float* const direction[3],
                              std::size_t count, SortingRoom& room, std::span<std::uint32_t> blocked);

}  // namespace sightlines::visibility_field
