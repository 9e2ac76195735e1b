#include "techniques/base/hammersley.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace sightlines {

vec2 hammersley(std::uint32_t index, std::uint32_t count) {
    // The inverses of the first `count` indices are multiples of 1 / strata; half of that moves them to the middles.
    const std::uint32_t strata = std::bit_ceil(count);
    return {(static_cast<float>(index) + 0.5f) / static_cast<float>(count),
            radical_inverse(index) + 0.5f / static_cast<float>(strata)};
}

vec3 cosine_direction(vec2 square) {
    const float radius = std::sqrt(square.y);
    const float azimuth = 2.0f * std::numbers::pi_v<float> * square.x;
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), std::sqrt(std::max(0.0f, 1.0f - square.y))};
}

}  // namespace sightlines
