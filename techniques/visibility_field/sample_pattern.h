// The directions that every pixel asks, and how each turns them (Xu 2022, section 4.2).
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/base/types.h"

namespace sightlines::visibility_field {

/// Cosine-weighted Hammersley directions about +z, and a tile of blue noise that turns them about the normal.
struct SamplePattern {
    int samples = 0;
    std::uint64_t seed = 1;
    std::vector<float> x, y, z;  ///< [samples padded to 16]
    int tile_side = 0;
    std::vector<vec2> turns;   ///< [tile_side * tile_side], cosine and sine of the angle
    std::vector<float> share;  ///< [tile_side * tile_side], the angle as a share of a full turn

    std::size_t tile_place(int pixel_x, int pixel_y) const {
        return static_cast<std::size_t>(pixel_y % tile_side * tile_side + pixel_x % tile_side);
    }
};

constexpr int most_samples = 4096;

/// InputError where `samples` is not in 1 .. most_samples. Seeded.
SamplePattern make_pattern(int samples, std::uint64_t seed);

}  // namespace sightlines::visibility_field
