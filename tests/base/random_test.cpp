#include "techniques/base/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace sightlines {
namespace {

double chi_square(const std::vector<int>& counts, double expected) {
    double sum = 0.0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

/// What chi-square with so many degrees of freedom exceeds once in a million (Wilson and Hilferty 1931).
double one_in_a_million(double freedom) {
    const double z = 4.753;
    const double cube = 1.0 - 2.0 / (9.0 * freedom) + z * std::sqrt(2.0 / (9.0 * freedom));
    return freedom * cube * cube * cube;
}

constexpr std::size_t bins = 256;

TEST(Random, IsUniformAlongSamplesStreamsAndSeeds) {
    constexpr std::uint32_t draws = 200000;
    std::array<std::vector<int>, 3> counts;
    counts.fill(std::vector<int>(bins));
    for (std::uint32_t i = 0; i < draws; ++i) {
        const std::array<float, 3> values{random_unit(1, 5, i), random_unit(1, i, 0), random_unit(i, 0, 0)};
        for (std::size_t way = 0; way < 3; ++way) {
            ASSERT_GE(values[way], 0.0f);
            ASSERT_LT(values[way], 1.0f);
            ++counts[way][static_cast<std::size_t>(values[way] * bins)];
        }
    }
    for (const std::vector<int>& each : counts) {
        EXPECT_LT(chi_square(each, double(draws) / bins), one_in_a_million(bins - 1));
        EXPECT_GT(chi_square(each, double(draws) / bins), 100.0);  // nor suspiciously even
    }
}

TEST(Random, NeighbouringSamplesAndStreamsAreIndependent) {
    constexpr std::uint32_t draws = 200000;
    const auto bin = [](float value) { return static_cast<std::size_t>(value * 16.0f); };
    std::array<std::vector<int>, 3> pairs;
    pairs.fill(std::vector<int>(bins));
    for (std::uint32_t i = 0; i < draws; ++i) {
        ++pairs[0][16 * bin(random_unit(1, i, 0)) + bin(random_unit(1, i, 1))];
        ++pairs[1][16 * bin(random_unit(1, i, 0)) + bin(random_unit(1, i + 1, 0))];
        ++pairs[2][16 * bin(random_unit(1, i, 3)) + bin(random_unit(2, i, 3))];
    }
    for (const std::vector<int>& each : pairs)
        EXPECT_LT(chi_square(each, double(draws) / bins), one_in_a_million(bins - 1));
}

TEST(Random, DependsOnBothHalvesOfTheSeed) {
    EXPECT_NE(random_u32(1, 2, 3), random_u32(1 + (std::uint64_t{1} << 32u), 2, 3));
    EXPECT_NE(random_u32(1, 2, 3), random_u32(2, 2, 3));
    EXPECT_EQ(random_u32(1, 2, 3), random_u32(1, 2, 3));
}

TEST(Random, StreamsDoNotShareTheirSequences) {
    // Two values of one stream that follow each other must not do so in any of the neighbouring streams.
    std::set<std::pair<std::uint32_t, std::uint32_t>> followers;
    constexpr std::uint32_t streams = 2000, samples = 64;
    for (std::uint32_t stream = 0; stream < streams; ++stream)
        for (std::uint32_t sample = 0; sample + 1 < samples; ++sample)
            followers.emplace(random_u32(1, stream, sample), random_u32(1, stream, sample + 1));
    EXPECT_EQ(followers.size(), std::size_t{streams} * (samples - 1));
}

TEST(SphereDirection, IsUnitLengthAndUniformOnTheSphere) {
    constexpr std::uint32_t draws = 100000;
    std::vector<int> counts(bins);
    for (std::uint32_t i = 0; i < draws; ++i) {
        const vec3 direction = sphere_direction(random_unit(4, i, 0), random_unit(4, i, 1));
        ASSERT_NEAR(glm::length(direction), 1.0f, 1e-5f);
        // Sixteen bands of equal height, hence of equal area (Archimedes), about another axis than the one it is made
        // with, times sixteen sectors.
        const float height = std::clamp(0.5f + 0.5f * direction.x, 0.0f, 0.99999f);
        const float turn = 0.5f + std::atan2(direction.y, direction.z) / (2.0f * std::numbers::pi_v<float>);
        const auto band = static_cast<std::size_t>(16.0f * height);
        const auto sector = std::min<std::size_t>(15, static_cast<std::size_t>(16.0f * turn));
        ++counts[16 * band + sector];
    }
    EXPECT_LT(chi_square(counts, double(draws) / bins), one_in_a_million(bins - 1));
}

TEST(SphereDirection, ReachesThePoles) {
    EXPECT_EQ(sphere_direction(0.0f, 0.3f), vec3(0, 1, 0));
    EXPECT_NEAR(sphere_direction(1.0f, 0.3f).y, -1.0f, 1e-6f);
}

}  // namespace
}  // namespace sightlines
