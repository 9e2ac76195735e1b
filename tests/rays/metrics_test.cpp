#include <cmath>

#include <gtest/gtest.h>

#include "techniques/rays/reference.h"

namespace sightlines {
namespace {

/// Three pixels and forty lights: the first asked 4 rays, the second 40, the third is background.
RenderResult three_pixels() {
    RenderResult result;
    const ImageSize size{3, 1};
    result.radiance = ImageRgb(size);
    result.shadow = ImageScalar(size);
    result.rays_asked = Image<std::uint32_t>(size);
    result.rays_asked.pixels = {4, 40, 0};
    result.verdicts.words_per_pixel = 2;
    result.verdicts.words.assign(6, 0u);
    return result;
}

TEST(Compare, FindsNoErrorBetweenEqualPictures) {
    const ErrorMetrics metrics = compare(three_pixels(), three_pixels());
    EXPECT_EQ(metrics.visibility_percent, 0.0);
    EXPECT_EQ(metrics.shadow_percent, 0.0);
    EXPECT_EQ(metrics.rmse, 0.0);
    EXPECT_EQ(metrics.max_abs, 0.0);
}

TEST(Compare, AveragesTheSharesOfWrongRaysOverThePixelsThatAsked) {
    RenderResult ours = three_pixels(), reference = three_pixels();
    ours.verdicts.words[0] = 0b0101;       // two of four,
    reference.verdicts.words[0] = 0b0110;  // wrong both ways, with the same shadow
    ours.verdicts.words[3] = 0b10000000;   // light 39 of the second pixel
    ours.shadow.pixels = {0.5f, 1.0f / 40.0f, 0.0f};
    reference.shadow.pixels = {0.5f, 0.0f, 0.0f};
    const ErrorMetrics metrics = compare(ours, reference);
    EXPECT_NEAR(metrics.visibility_percent, 100.0 * (2.0 / 4.0 + 1.0 / 40.0) / 2.0, 1e-9);
    EXPECT_NEAR(metrics.shadow_percent, 100.0 * (0.0 + 1.0 / 40.0) / 2.0, 1e-5);
    EXPECT_NEAR(metrics.wrong_rays, (2.0 + 1.0) / 2.0, 1e-9);
    EXPECT_NEAR(metrics.uncancelled_rays, (0.0 + 1.0) / 2.0, 1e-6);
    EXPECT_FLOAT_EQ(metrics.visibility_error.pixels[0], 0.5f);
    EXPECT_FLOAT_EQ(metrics.visibility_error.pixels[1], 0.025f);
    EXPECT_TRUE(std::isnan(metrics.visibility_error.pixels[2]));
    EXPECT_FLOAT_EQ(metrics.shadow_error.pixels[1], 0.025f);
    EXPECT_TRUE(std::isnan(metrics.shadow_error.pixels[2]));
}

TEST(Compare, ShadowErrorsOfOppositeSignDoNotCancel) {
    RenderResult ours = three_pixels(), reference = three_pixels();
    ours.shadow.pixels = {0.75f, 0.25f, 0.0f};
    reference.shadow.pixels = {0.5f, 0.5f, 0.0f};
    const ErrorMetrics metrics = compare(ours, reference);
    EXPECT_NEAR(metrics.shadow_percent, 25.0, 1e-5);
    EXPECT_FLOAT_EQ(metrics.shadow_error.pixels[0], 0.25f);
    EXPECT_FLOAT_EQ(metrics.shadow_error.pixels[1], -0.25f);
}

TEST(Compare, MeasuresRadianceOverAllChannelsAndPixels) {
    RenderResult ours = three_pixels(), reference = three_pixels();
    ours.radiance.pixels[0] = {3.0f, 0.0f, 0.0f};
    reference.radiance.pixels[2] = {0.0f, 0.0f, 4.0f};
    const ErrorMetrics metrics = compare(ours, reference);
    EXPECT_NEAR(metrics.rmse, std::sqrt((9.0 + 16.0) / 9.0), 1e-9);
    EXPECT_NEAR(metrics.max_abs, 4.0, 1e-9);
}

TEST(Compare, IsZeroWhereNobodyAsked) {
    RenderResult nothing = three_pixels();
    nothing.rays_asked.pixels = {0, 0, 0};
    EXPECT_EQ(compare(nothing, nothing).visibility_percent, 0.0);
    EXPECT_EQ(compare(nothing, nothing).shadow_percent, 0.0);
}

}  // namespace
}  // namespace sightlines
