#include "techniques/pixel_groups.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "techniques/refinement.h"

namespace sightlines {
namespace {

/// Surfaces that differ at every pixel; every fifth pixel shows none.
SurfaceBuffer some_surfaces(ImageSize size) {
    SurfaceBuffer surfaces;
    surfaces.size = size;
    for (int k = 0; k < size.width * size.height; ++k) {
        const auto at = static_cast<float>(k);
        surfaces.position.emplace_back(at, at + 0.25f, at + 0.5f);
        surfaces.normal.emplace_back(at, 1.0f, -at);
        surfaces.shading_normal.emplace_back(1.0f, at, -at);
        surfaces.triangle.push_back(k % 5 == 0 ? no_triangle : static_cast<std::uint32_t>(k));
    }
    return surfaces;
}

TEST(PixelGroups, HoldEachSurfaceOfTheRectangleOnceAndPadWithPixelsThatAskNothing) {
    const SurfaceBuffer surfaces = some_surfaces({13, 11});
    const PixelRect rect{4, 4, 9, 7};
    std::vector<std::uint32_t> taken;
    for (const RefinementPass& pass : refinement_passes(true)) {
        const PixelGroups groups = group_pixels(surfaces, rect, pass.stride, pass.skip_stride);
        ASSERT_EQ(groups.pixel.size() % pixel_group_size, 0u);
        for (std::size_t k = 0; k < groups.pixel.size(); ++k) {
            const std::uint32_t pixel = groups.pixel[k];
            if (pixel != no_triangle) taken.push_back(pixel);
            for (int axis = 0; axis < 3; ++axis) {
                const bool padding = pixel == no_triangle;
                EXPECT_EQ(groups.normal[axis][k], padding ? 0.0f : surfaces.normal[pixel][axis]);
                EXPECT_EQ(groups.shading_normal[axis][k], padding ? 0.0f : surfaces.shading_normal[pixel][axis]);
                EXPECT_EQ(groups.position[axis][k],
                          padding ? groups.position[axis][k - 1] : surfaces.position[pixel][axis]);
            }
        }
    }
    std::ranges::sort(taken);
    std::vector<std::uint32_t> expected;
    for (int y = rect.y; y < rect.y + rect.height; ++y)
        for (int x = rect.x; x < rect.x + rect.width; ++x)
            if (const auto pixel = static_cast<std::uint32_t>(13 * y + x); pixel % 5 != 0) expected.push_back(pixel);
    EXPECT_EQ(taken, expected);
}

TEST(PixelGroups, AreNoneWhereNothingIsSeen) {
    SurfaceBuffer surfaces = some_surfaces({8, 8});
    std::ranges::fill(surfaces.triangle, no_triangle);
    const PixelGroups groups = group_pixels(surfaces, {0, 0, 8, 8}, 1, 0);
    EXPECT_TRUE(groups.pixel.empty());
    EXPECT_TRUE(groups.position[0].empty());
}

}  // namespace
}  // namespace sightlines
