// Filling holes, on pictures small enough to work out by hand.
#include "techniques/baselines/imperfect_shadow_maps/pull_push.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sightlines::baselines {
namespace {

std::vector<float> filled(std::vector<float> numbers, int side, int levels, float tolerance = 0.1f) {
    PullPushScratch scratch;
    fill_holes(numbers, side, side, levels, tolerance, scratch);
    return numbers;
}

TEST(PullPush, LeavesAMapWithoutHolesAlone) {
    std::vector<float> numbers(64);
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = 1.0f + 0.1f * static_cast<float>(k);
    EXPECT_EQ(filled(numbers, 8, 3), numbers);
}

TEST(PullPush, FillsAHoleFromTheTexelsAroundIt) {
    std::vector<float> numbers(16, 2.0f);
    numbers[5] = hole;
    EXPECT_EQ(filled(numbers, 4, 1), std::vector<float>(16, 2.0f));
}

TEST(PullPush, WeighsTheCoarserTexelsAsBilinearInterpolationDoes) {
    // Quarters of 2 x 2 texels: 1.00, 1.02 above, 1.04, 1.06 below; the hole is the inner corner of the first.
    std::vector<float> numbers{1.00f, 1.00f, 1.02f, 1.02f, 1.00f, hole,  1.02f, 1.02f,
                               1.04f, 1.04f, 1.06f, 1.06f, 1.04f, 1.04f, 1.06f, 1.06f};
    const float expected = (9.0f * 1.00f + 3.0f * 1.02f + 3.0f * 1.04f + 1.06f) / 16.0f;
    EXPECT_NEAR(filled(numbers, 4, 1)[5], expected, 1e-6f);
}

TEST(PullPush, FillsFromTheNearestSurfaceWithoutMixingInWhatIsBehind) {
    std::vector<float> numbers(16, 10.0f);
    numbers[0] = numbers[1] = numbers[4] = 1.0f;  // a near surface in the first quarter
    numbers[5] = hole;
    EXPECT_NEAR(filled(numbers, 4, 1)[5], 1.0f, 1e-6f);
}

TEST(PullPush, LeavesHolesWiderThanItsLevelsReach) {
    std::vector<float> numbers(256, hole);
    numbers[0] = 3.0f;
    const std::vector<float> one = filled(numbers, 16, 1), four = filled(numbers, 16, 4);
    EXPECT_EQ(one[17], 3.0f);
    EXPECT_EQ(one[255], hole);
    EXPECT_EQ(four[255], 3.0f);
    EXPECT_EQ(filled(numbers, 16, 0), numbers);
}

TEST(PullPush, KeepsToItsMapWhereRowsArePadded) {
    std::vector<float> numbers(5 * 16, hole);
    for (std::size_t y = 0; y < 5; ++y) {
        for (std::size_t x = 0; x < 5; ++x) numbers[y * 16 + x] = 4.0f;
        numbers[y * 16 + 5] = 1.0f;  // padding, which must not flow in
    }
    numbers[4 * 16 + 4] = hole;
    PullPushScratch scratch;
    fill_holes(numbers, 5, 16, 3, 0.1f, scratch);
    EXPECT_EQ(numbers[4 * 16 + 4], 4.0f);
}

}  // namespace
}  // namespace sightlines::baselines
