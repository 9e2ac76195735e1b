#include "techniques/rays/texture_sampling.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace sightlines {
namespace {

/// Four texels in a row, alpha 0, 51, 102, 255.
Texture ramp(Wrap wrap) {
    Texture texture;
    texture.texels = ImageRgba8({4, 1}, glm::u8vec4(0));
    texture.texels.pixels[1].a = 51;
    texture.texels.pixels[2].a = 102;
    texture.texels.pixels[3].a = 255;
    texture.wrap_u = texture.wrap_v = wrap;
    return texture;
}

float alpha_at(Wrap wrap, float u) { return sample_texture(ramp(wrap), {u, 0.5f}).a; }

TEST(TextureSampling, GivesTexelsAtTheirCentresAndBlendsBetween) {
    EXPECT_NEAR(alpha_at(Wrap::repeat, 0.375f), 0.2f, 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::repeat, 0.625f), 0.4f, 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::repeat, 0.5f), 0.3f, 1e-6f);
}

TEST(TextureSampling, WrapsAsAsked) {
    for (const float period : {-2.0f, -1.0f, 1.0f, 5.0f})
        EXPECT_NEAR(alpha_at(Wrap::repeat, 0.375f + period), 0.2f, 1e-5f) << period;
    EXPECT_NEAR(alpha_at(Wrap::repeat, 0.0f), 0.5f, 1e-6f);  // between the last texel and the first
    EXPECT_NEAR(alpha_at(Wrap::mirrored_repeat, 1.375f), alpha_at(Wrap::repeat, 0.625f), 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::mirrored_repeat, -0.375f), 0.2f, 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::mirrored_repeat, 2.375f), 0.2f, 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::mirrored_repeat, 1.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::clamp, -3.0f), 0.0f, 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::clamp, 0.0f), 0.0f, 1e-6f);
    EXPECT_NEAR(alpha_at(Wrap::clamp, 7.0f), 1.0f, 1e-6f);
}

TEST(TextureSampling, SurvivesCoordinatesThatAreNotFiniteOrHuge) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp})
        for (const float u : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::max(), -std::numeric_limits<float>::max(), -1e-30f})
            EXPECT_TRUE(std::isfinite(alpha_at(wrap, u)));
}

TEST(TextureSampling, DecodesColourFromSrgbButNotAlpha) {
    Texture texture;
    texture.texels = ImageRgba8({1, 1}, glm::u8vec4(188, 0, 255, 188));
    const vec4 value = sample_texture(texture, {0.3f, 0.9f});
    EXPECT_NEAR(value.r, 0.50289f, 1e-4f);  // IEC 61966-2-1 by hand
    EXPECT_NEAR(value.g, 0.0f, 1e-7f);
    EXPECT_NEAR(value.b, 1.0f, 1e-6f);
    EXPECT_NEAR(value.a, 188.0f / 255.0f, 1e-6f);
    EXPECT_NEAR(linear_from_srgb(5), 5.0f / 255.0f / 12.92f, 1e-7f);
}

TEST(TextureSampling, BlendsAfterDecoding) {
    Texture texture;
    texture.texels = ImageRgba8({2, 1}, glm::u8vec4(0));
    texture.texels.pixels[1] = glm::u8vec4(255);
    EXPECT_NEAR(sample_texture(texture, {0.5f, 0.5f}).r, 0.5f, 1e-6f);
}

TEST(TextureSampling, AnEmptyTextureIsWhite) { EXPECT_EQ(sample_texture(Texture{}, {0.5f, 0.5f}), vec4(1.0f)); }

TEST(TextureSampling, TransformScalesThenRotatesThenMoves) {
    // The example of KHR_texture_transform: "only the lower left quadrant of the source image", rotated by 90 degrees.
    TextureLookup lookup;
    lookup.offset = {0.0f, 1.0f};
    lookup.scale = {0.5f, 0.5f};
    lookup.rotation_rad = 1.57079632679f;
    for (const vec2 corner : {vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(1, 1)}) {
        const vec2 moved = transformed_coordinates(lookup, corner);
        EXPECT_GE(moved.x, -1e-6f);
        EXPECT_LE(moved.x, 0.5f + 1e-6f);
        EXPECT_GE(moved.y, 0.5f - 1e-6f);
        EXPECT_LE(moved.y, 1.0f + 1e-6f);
    }
    const vec2 one_right = transformed_coordinates(lookup, {1, 0});
    EXPECT_NEAR(one_right.x, 0.0f, 1e-6f);
    EXPECT_NEAR(one_right.y, 0.5f, 1e-6f);
}

}  // namespace
}  // namespace sightlines
