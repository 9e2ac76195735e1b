#include "techniques/visibility_field/sample_pattern.h"

#include <cmath>
#include <numbers>
#include <string>

#include "techniques/base/blue_noise.h"
#include "techniques/base/error.h"
#include "techniques/base/hammersley.h"

namespace sightlines::visibility_field {
namespace {

constexpr int tile_side = 64;
constexpr float two_pi = 2.0f * std::numbers::pi_v<float>;

}  // namespace

SamplePattern make_pattern(int samples, std::uint64_t seed) {
    if (samples < 1 || samples > most_samples)
        throw InputError("visibility field", "samples per pixel", std::to_string(samples) + " is out of range",
                         "choose 1 to 4,096");
    SamplePattern pattern;
    pattern.samples = samples;
    pattern.seed = seed;
    const auto count = static_cast<std::uint32_t>(samples);
    for (std::uint32_t k = 0; k < (count + 15) / 16 * 16; ++k) {
        const vec3 direction = cosine_direction(hammersley(std::min(k, count - 1), count));
        pattern.x.push_back(direction.x);
        pattern.y.push_back(direction.y);
        pattern.z.push_back(direction.z);
    }
    pattern.tile_side = tile_side;
    const BlueNoise noise = void_and_cluster(tile_side, seed);
    for (int y = 0; y < tile_side; ++y) {
        for (int x = 0; x < tile_side; ++x) {
            pattern.share.push_back(noise.at(x, y));
            pattern.turns.emplace_back(std::cos(two_pi * noise.at(x, y)), std::sin(two_pi * noise.at(x, y)));
        }
    }
    return pattern;
}

}  // namespace sightlines::visibility_field
