// The Hammersley point set (Niederreiter 1992): few points, evenly spread.
#pragma once

#include <cstdint>

#include "techniques/base/types.h"

namespace sightlines {

/// The bits of `index` mirrored about the binary point: van der Corput's sequence, in [0, 1).
constexpr float radical_inverse(std::uint32_t index) {
    index = (index << 16u) | (index >> 16u);
    index = ((index & 0x00ff00ffu) << 8u) | ((index & 0xff00ff00u) >> 8u);
    index = ((index & 0x0f0f0f0fu) << 4u) | ((index & 0xf0f0f0f0u) >> 4u);
    index = ((index & 0x33333333u) << 2u) | ((index & 0xccccccccu) >> 2u);
    index = ((index & 0x55555555u) << 1u) | ((index & 0xaaaaaaaau) >> 1u);
    return static_cast<float>(index >> 8u) * 0x1p-24f;
}

/// Point `index` of `count` in the unit square; both coordinates in the middle of their strata.
vec2 hammersley(std::uint32_t index, std::uint32_t count);

/// Of a point of the unit square: a direction over the hemisphere about +z with density cosine / pi. The first
/// coordinate goes round the pole.
vec3 cosine_direction(vec2 square);

}  // namespace sightlines
