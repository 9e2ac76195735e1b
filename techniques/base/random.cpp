#include "techniques/base/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sightlines {

vec3 sphere_direction(float u, float v) {
    const float y = 1.0f - 2.0f * u;
    const float radius = std::sqrt(std::max(0.0f, 1.0f - y * y));
    const float azimuth = 2.0f * std::numbers::pi_v<float> * v;
    return {radius * std::cos(azimuth), y, radius * std::sin(azimuth)};
}

}  // namespace sightlines
