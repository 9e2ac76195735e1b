#include "techniques/base/blue_noise.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "techniques/base/random.h"

namespace sightlines {
namespace {

constexpr int side = 32;

TEST(BlueNoise, UsesEveryRankOnce) {
    const BlueNoise noise = void_and_cluster(side, 1);
    std::vector<std::uint32_t> ranks = noise.rank;
    std::ranges::sort(ranks);
    for (std::uint32_t k = 0; k < side * side; ++k) ASSERT_EQ(ranks[k], k);
}

/// The part of the tile's power at low frequencies, of that which white noise would have there.
double low_power(const BlueNoise& noise) {
    constexpr int lowest = side / 8;
    double power = 0.0;
    int frequencies = 0;
    for (int u = 0; u <= lowest; ++u) {
        for (int v = -lowest; v <= lowest; ++v) {
            if (u * u + v * v > lowest * lowest || (u == 0 && v == 0)) continue;
            std::complex<double> sum = 0.0;
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x)
                    sum += std::polar(noise.at(x, y) - 0.5, 2.0 * std::acos(-1.0) * (u * x + v * y) / side);
            power += std::norm(sum);
            ++frequencies;
        }
    }
    return power / frequencies / (side * side / 12.0);
}

TEST(BlueNoise, HasHardlyAnyPowerAtLowFrequencies) {
    BlueNoise white = void_and_cluster(side, 1);
    for (std::size_t k = white.rank.size(); k > 1; --k)
        std::swap(white.rank[k - 1], white.rank[random_u32(5, 0, static_cast<std::uint32_t>(k)) % k]);
    EXPECT_GT(low_power(white), 0.4);
    EXPECT_LT(low_power(void_and_cluster(side, 1)), 0.02);
}

TEST(BlueNoise, RepeatsAsATile) {
    const BlueNoise noise = void_and_cluster(8, 3);
    EXPECT_EQ(noise.at(3, 5), noise.at(3 + 8, 5 + 80));
    EXPECT_GT(noise.at(0, 0), 0.0f);
}

TEST(BlueNoise, IsAFunctionOfItsSeed) {
    EXPECT_EQ(void_and_cluster(16, 7).rank, void_and_cluster(16, 7).rank);
    EXPECT_NE(void_and_cluster(16, 7).rank, void_and_cluster(16, 8).rank);
}

}  // namespace
}  // namespace sightlines
