// Whether samples fall where a density says, over the whole sphere.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "techniques/base/types.h"

namespace sightlines::visibility_field::testing {

/// Bins of equal solid angle: `rings` by height, `sectors` round +Y.
struct SphereBins {
    int rings = 16, sectors = 32;
    std::size_t count() const { return static_cast<std::size_t>(rings) * static_cast<std::size_t>(sectors); }
    std::size_t bin_of(vec3 direction) const {
        const int ring =
            std::clamp(static_cast<int>((1.0f - direction.y) * 0.5f * static_cast<float>(rings)), 0, rings - 1);
        const float turn = std::atan2(direction.z, direction.x) / (2.0f * std::numbers::pi_v<float>)+0.5f;
        const int sector = std::clamp(static_cast<int>(turn * static_cast<float>(sectors)), 0, sectors - 1);
        return static_cast<std::size_t>(ring) * static_cast<std::size_t>(sectors) + static_cast<std::size_t>(sector);
    }
};

/// The density's integral over each bin, by `points` x `points` points.
inline std::vector<double> integrals(const SphereBins& bins, int points, const std::function<float(vec3)>& density) {
    std::vector<double> sums(bins.count());
    const int down = bins.rings * points, round = bins.sectors * points;
    for (int i = 0; i < down; ++i) {
        for (int j = 0; j < round; ++j) {
            const double height = 1.0 - 2.0 * (i + 0.5) / down, ring = std::sqrt(1.0 - height * height);
            const double turn = 2.0 * std::numbers::pi * ((j + 0.5) / round - 0.5);
            const vec3 direction(dvec3(ring * std::cos(turn), height, ring * std::sin(turn)));
            sums[bins.bin_of(direction)] += density(direction) * 4.0 * std::numbers::pi / down / round;
        }
    }
    return sums;
}

/// Chi-square over its degrees of freedom: about 1 where the samples follow the density. Bins that expect fewer than 5
/// are taken together.
inline double chi_square(const std::vector<double>& expected_share, const std::vector<double>& found, double samples) {
    double sum = 0.0, few_expected = 0.0, few_found = 0.0;
    int used = 0;
    const auto add = [&](double expected, double got) {
        sum += (got - expected) * (got - expected) / expected;
        ++used;
    };
    for (std::size_t k = 0; k < found.size(); ++k) {
        const double expected = expected_share[k] * samples;
        if (expected >= 5.0)
            add(expected, found[k]);
        else {
            few_expected += expected;
            few_found += found[k];
        }
    }
    if (few_expected >= 5.0) add(few_expected, few_found);
    return sum / (used - 1);
}

}  // namespace sightlines::visibility_field::testing
