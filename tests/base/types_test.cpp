#include "techniques/base/types.h"

#include <gtest/gtest.h>

namespace sightlines {
namespace {

TEST(Box3, IsEmptyUntilItHoldsAPoint) {
    Box3 box;
    EXPECT_TRUE(box.empty());
    EXPECT_EQ(box.size(), vec3(0.0f));
    EXPECT_EQ(box.centre(), vec3(0.0f));
    EXPECT_EQ(box.diagonal(), 0.0f);
    box.add({1, 2, 3});
    EXPECT_FALSE(box.empty());
    EXPECT_EQ(box.centre(), vec3(1, 2, 3));
    EXPECT_EQ(box.diagonal(), 0.0f);
}

TEST(Box3, GrowsToHoldAllItsPoints) {
    Box3 box;
    for (const vec3 point : {vec3(1, 2, 3), vec3(-1, 5, 3), vec3(0, 0, -1)}) box.add(point);
    EXPECT_EQ(box.lowest, vec3(-1, 0, -1));
    EXPECT_EQ(box.highest, vec3(1, 5, 3));
    EXPECT_EQ(box.size(), vec3(2, 5, 4));
    EXPECT_EQ(box.centre(), vec3(0, 2.5f, 1));
    EXPECT_FLOAT_EQ(box.diagonal(), std::sqrt(45.0f));
}

TEST(ImageSize, CountsPixelsBeyondThirtyTwoBits) { EXPECT_EQ((ImageSize{100000, 100000}.pixels()), 10000000000u); }

}  // namespace
}  // namespace sightlines
