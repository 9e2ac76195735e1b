// Sorting packed rays by direction, so that the rays of one packet go the same way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/rays/open_rays.h"

namespace sightlines::visibility_field {

/// What one thread needs again and again.
struct SortingRoom {
    std::vector<std::uint32_t> key, place;
    std::vector<float> origin[3], direction[3], length_m;
    std::vector<std::uint32_t> blocked;
    std::vector<Hit> hits;
};

/// Answers the packed rays as are_blocked does, but asks Embree for them by direction: by the texels of an octahedral
/// map of 32 x 32 in the order of a Z curve, and where these are alike in the order in which they came.
void are_blocked_by_direction(const EmbreeScene& embree, const PackedOpenRays& rays, SortingRoom& room,
                              std::span<std::uint32_t> blocked);

/// Finds what the packed rays hit as find_closest does, asking Embree in the same order.
void find_closest_by_direction(const EmbreeScene& embree, const PackedOpenRays& rays, SortingRoom& room,
                               std::span<Hit> hits);

}  // namespace sightlines::visibility_field
