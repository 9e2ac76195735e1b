// The picture's pixels in the order in which they are asked: blocks of 4 x 4, so that the rays of one vector are
// neighbours and mostly go the same way.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/scene/surface_buffer.h"

namespace sightlines {

constexpr std::size_t pixel_group_size = 16;

/// Structure of arrays, padded to whole groups; a padding pixel has a zero normal, so that none of its rays is asked.
struct PixelGroups {
    std::vector<std::uint32_t> pixel;      ///< [G * 16], row-major index; no_triangle where padded
    std::vector<float> position[3];        ///< [G * 16], m
    std::vector<float> normal[3];          ///< [G * 16], geometric: decides which rays are asked
    std::vector<float> shading_normal[3];  ///< [G * 16]
};

/// The pixels of `rect` that show a surface, in blocks of 4 x 4 of the pixels taken.
/// `stride` and `skip_stride`: takes the pixels whose x and y are multiples of `stride` but, unless it is 0, not both
/// of `skip_stride`: the passes of a refinement. `rect` starts at multiples of both.
PixelGroups group_pixels(const SurfaceBuffer& surfaces, PixelRect rect, int stride, int skip_stride);

}  // namespace sightlines
