#include "techniques/base/hammersley.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace sightlines {
namespace {

TEST(Hammersley, MirrorsTheBitsOfTheIndex) {
    EXPECT_EQ(radical_inverse(0), 0.0f);
    EXPECT_EQ(radical_inverse(1), 0.5f);
    EXPECT_EQ(radical_inverse(2), 0.25f);
    EXPECT_EQ(radical_inverse(3), 0.75f);
    EXPECT_EQ(radical_inverse(6), 0.375f);
}

TEST(Hammersley, PutsOnePointIntoEachStratumOfBothCoordinates) {
    for (const std::uint32_t count : {1u, 16u, 64u, 256u}) {
        std::vector<int> across(count), down(count);
        for (std::uint32_t k = 0; k < count; ++k) {
            const vec2 point = hammersley(k, count);
            ++across[static_cast<std::size_t>(point.x * static_cast<float>(count))];
            ++down[static_cast<std::size_t>(point.y * static_cast<float>(count))];
        }
        EXPECT_EQ(std::ranges::count(across, 1), count);
        EXPECT_EQ(std::ranges::count(down, 1), count);
    }
}

TEST(Hammersley, StaysInsideTheUnitSquareForAnyCount) {
    for (const std::uint32_t count : {3u, 17u, 100u, 129u}) {
        for (std::uint32_t k = 0; k < count; ++k) {
            const vec2 point = hammersley(k, count);
            EXPECT_TRUE(point.x > 0.0f && point.x < 1.0f && point.y > 0.0f && point.y < 1.0f) << k << " of " << count;
        }
    }
}

/// Of 32 rings and sectors that hold the same share of a cosine's weight, how unevenly directions fall into them.
TEST(Hammersley, SpreadsDirectionsByTheCosine) {
    constexpr std::uint32_t count = 65536;
    constexpr int rings = 8, sectors = 16;
    std::vector<int> bins(rings * sectors);
    for (std::uint32_t k = 0; k < count; ++k) {
        const vec3 direction = cosine_direction(hammersley(k, count));
        ASSERT_NEAR(glm::length(direction), 1.0f, 1e-6f);
        ASSERT_GE(direction.z, 0.0f);
        // Under the cosine's density sin(angle)^2 and the azimuth are uniform.
        const double ring = std::min(rings - 1.0, (1.0 - direction.z * direction.z) * rings);
        const double turn = std::atan2(direction.y, direction.x) / (2.0 * std::acos(-1.0));
        const double sector = std::min(sectors - 1.0, (turn < 0.0 ? turn + 1.0 : turn) * sectors);
        ++bins[static_cast<std::size_t>(static_cast<int>(ring) * sectors + static_cast<int>(sector))];
    }
    double chi_square = 0.0;
    const double expected = static_cast<double>(count) / (rings * sectors);
    for (const int bin : bins) chi_square += (bin - expected) * (bin - expected) / expected;
    // Random directions would come to about 127; a wrong density to thousands, an even set to hardly anything.
    EXPECT_LT(chi_square, 10.0);
}

}  // namespace
}  // namespace sightlines
