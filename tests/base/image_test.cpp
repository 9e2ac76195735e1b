#include "techniques/base/image.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "techniques/base/error.h"
#include "techniques/base/files.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

fs::path output(const std::string& name) {
    const fs::path folder = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / ("image-" + std::to_string(getpid()));
    fs::create_directories(folder);
    return folder / name;
}

ImageRgb grey(float value) { return ImageRgb({1, 1}, vec3(value)); }

int shown_level(float radiance, const Display& display) { return shown(grey(radiance), display).pixels[0].r; }

TEST(Shown, WithoutToneCurveIsTheSrgbTransferFunction) {
    const Display plain{0.0f, false};
    EXPECT_EQ(shown_level(0.0f, plain), 0);
    EXPECT_EQ(shown_level(0.5f, plain), 188);  // IEC 61966-2-1 by hand
    EXPECT_EQ(shown_level(0.002f, plain), 7);  // its linear part
    EXPECT_EQ(shown_level(1.0f, plain), 255);
    EXPECT_EQ(shown_level(9.0f, plain), 255);
}

TEST(Shown, AStopOfExposureDoublesTheRadiance) {
    for (const bool tone_curve : {false, true})
        EXPECT_EQ(shown_level(0.1f, {2.0f, tone_curve}), shown_level(0.4f, {0.0f, tone_curve}));
}

TEST(Shown, TheToneCurveRisesFromBlackToWhiteWithAShoulder) {
    const Display display;
    EXPECT_EQ(shown_level(0.0f, display), 0);
    EXPECT_EQ(shown_level(8.0f, display), 255);
    int before = 0;
    for (float radiance = 0.01f; radiance < 8.0f; radiance *= 1.1f) {
        const int level = shown_level(radiance, display);
        EXPECT_GE(level, before);
        before = level;
    }
    EXPECT_LT(shown_level(1.0f, display), 230);  // highlights above 1 keep some room
}

TEST(Shown, SurvivesRadianceThatIsNotFiniteOrNegative) {
    for (const bool tone_curve : {false, true}) {
        const Display display{0.0f, tone_curve};
        EXPECT_EQ(shown_level(-3.0f, display), 0);
        EXPECT_EQ(shown_level(std::numeric_limits<float>::quiet_NaN(), display), 0);
        EXPECT_EQ(shown_level(std::numeric_limits<float>::infinity(), display), 255);
        EXPECT_EQ(shown_level(std::numeric_limits<float>::max(), display), 255);
    }
}

TEST(Shown, IsOpaque) { EXPECT_EQ(shown(grey(0.3f), {}).pixels[0].a, 255); }

TEST(Viridis, RunsFromDarkVioletToYellowAndGetsSteadilyLighter) {
    EXPECT_NEAR(viridis(0.0f).b, 0.329f, 1e-3f);
    EXPECT_NEAR(viridis(1.0f).r, 0.993f, 1e-3f);
    EXPECT_EQ(viridis(-1.0f), viridis(0.0f));
    EXPECT_EQ(viridis(2.0f), viridis(1.0f));
    float before = -1.0f;
    for (int i = 0; i <= 100; ++i) {
        const vec3 colour = viridis(static_cast<float>(i) / 100.0f);
        const float luminance = glm::dot(glm::pow(colour, vec3(2.2f)), vec3(0.2126f, 0.7152f, 0.0722f));
        EXPECT_GT(luminance, before);
        before = luminance;
    }
}

TEST(ColourMapped, CoversTheRangeAndLeavesNaNTransparent) {
    ImageScalar values({4, 1});
    values.pixels = {2.0f, 3.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
    const ImageRgba8 picture = colour_mapped(values, 2.0f, 3.0f);
    EXPECT_EQ(picture.pixels[0], glm::u8vec4(68, 1, 84, 255));
    EXPECT_EQ(picture.pixels[1], glm::u8vec4(253, 231, 37, 255));
    EXPECT_EQ(picture.pixels[2].a, 0);
    EXPECT_EQ(picture.pixels[3], picture.pixels[1]);
    EXPECT_EQ(colour_mapped(values, 2.0f, 2.0f).pixels[0].a, 255);  // an empty range is no division by zero
}

TEST(Png, ComesBackAsItWasWritten) {
    ImageRgba8 picture({13, 7});
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = glm::u8vec4(i * 3, 255 - i, i * i, 128 + i);
    write_png(output("round.png"), picture);
    EXPECT_EQ(read_png(output("round.png")), picture);
}

TEST(Png, RefusesWhatIsNotAPng) {
    write_file(output("not.png"), std::string_view("not a picture"));
    EXPECT_THROW(read_png(output("not.png")), InputError);
    std::vector<std::uint8_t> bytes = encode_png(ImageRgba8({64, 64}, glm::u8vec4(7)));
    bytes.resize(bytes.size() / 2);
    write_file(output("half.png"), bytes);
    EXPECT_THROW(read_png(output("half.png")), InputError);
    EXPECT_THROW(read_png(output("none.png")), InputError);
}

TEST(WriteImage, WritesLinearRadianceAsHdr) {
    const ImageRgb picture({8, 2}, vec3(4.0f, 0.5f, 0.25f));
    write_image(output("linear.hdr"), picture, Display{3.0f, true});
    const std::vector<std::uint8_t> bytes = read_file(output("linear.hdr"), 10000);
    const std::string head(bytes.begin(), bytes.begin() + 10);
    EXPECT_EQ(head, "#?RADIANCE");
    // The first scanline's first run, RGBE: 4 = 128 * 2^(131 - 136), so red is 128 with exponent 128 + 3.
    const std::string text(bytes.begin(), bytes.end());
    const std::size_t pixels = text.find("+X 8\n");
    ASSERT_NE(pixels, std::string::npos);
    const std::vector<std::uint8_t> line(bytes.begin() + static_cast<std::ptrdiff_t>(pixels) + 5, bytes.end());
    ASSERT_GE(line.size(), 12u);
    EXPECT_EQ(line[4], 128 + 8);  // run of eight
    EXPECT_EQ(line[5], 128);
    EXPECT_EQ(line[7], 16);
    EXPECT_EQ(line[9], 8);
    EXPECT_EQ(line[11], 131);
}

TEST(WriteImage, WritesPngAsShown) {
    const ImageRgb picture({3, 2}, vec3(0.2f, 0.4f, 0.6f));
    const Display display{1.0f, true};
    write_image(output("shown.png"), picture, display);
    EXPECT_EQ(read_png(output("shown.png")), shown(picture, display));
}

TEST(WriteImage, RefusesOtherExtensionsWithoutWriting) {
    EXPECT_THROW(write_image(output("a.jpg"), grey(1.0f), {}), InputError);
    EXPECT_THROW(write_image(output("a"), grey(1.0f), {}), InputError);
    EXPECT_FALSE(fs::exists(output("a.jpg")));
}

}  // namespace
}  // namespace sightlines
