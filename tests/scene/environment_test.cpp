// Environments from files, made up, and put right.
#include "techniques/scene/environment.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/base/random.h"

namespace sightlines {
namespace {

std::filesystem::path written(const std::string& name, const std::string& bytes) {
    const std::filesystem::path folder = SIGHTLINES_TEST_OUTPUT_FOLDER;
    std::filesystem::create_directories(folder);
    write_file(folder / name, bytes);
    return folder / name;
}

std::string refusal(const std::string& name, const std::string& bytes) {
    try {
        read_environment(written(name, bytes));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

const std::string header = "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n\n";

/// Two rows of eight run-length coded pixels: red 128 everywhere, green by literals, blue 0, exponent 129 (a half is
/// 64).
std::string coded_rows() {
    std::string row = {2, 2, 0, 8};
    row += {static_cast<char>(128 + 8), static_cast<char>(128)};
    row += {8, 0, 16, 32, 48, 64, 80, 96, 112};
    row += {static_cast<char>(128 + 8), 0};
    row += {static_cast<char>(128 + 5), static_cast<char>(129), 3,
            static_cast<char>(129),     static_cast<char>(129), static_cast<char>(130)};
    return row + row;
}

TEST(Environment, ReadsRunsAndLiterals) {
    const Environment read = read_environment(written("runs.hdr", header + "-Y 2 +X 8\n" + coded_rows()));
    ASSERT_EQ(read.radiance.size, (ImageSize{8, 2}));
    EXPECT_EQ(read.radiance.at(0, 0), vec3(1.0f, 0.0f, 0.0f));
    EXPECT_EQ(read.radiance.at(3, 1), vec3(1.0f, 48.0f / 128.0f, 0.0f));
    EXPECT_EQ(read.radiance.at(7, 0), vec3(2.0f, 2.0f * 112.0f / 128.0f, 0.0f));
    EXPECT_TRUE(read.notes.empty());
}

TEST(Environment, ReadsPixelsWithoutRunsAndItsExposure) {
    const std::string pixels = {static_cast<char>(128), 64, 0, static_cast<char>(129), 5, 6, 7, 0};
    const Environment read = read_environment(written("flat.hdr", "#?RGBE\nEXPOSURE= 2.0\n\n-Y 1 +X 2\n" + pixels));
    EXPECT_EQ(read.radiance.at(0, 0), vec3(0.5f, 0.25f, 0.0f));
    EXPECT_EQ(read.radiance.at(1, 0), vec3(0.0f));
}

TEST(Environment, ReadsBackWhatWriteImageWrites) {
    ImageRgb picture({40, 20});
    for (std::uint32_t k = 0; k < picture.pixels.size(); ++k)
        picture.pixels[k] = 65504.0f * vec3(random_unit(1, k, 0), random_unit(1, k, 1), random_unit(1, k, 2));
    const std::filesystem::path file = std::filesystem::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / "written.hdr";
    std::filesystem::create_directories(file.parent_path());
    write_image(file, picture, {});
    const Environment read = read_environment(file);
    ASSERT_EQ(read.radiance.size, picture.size);
    for (std::size_t k = 0; k < picture.pixels.size(); ++k) {
        const float greatest = std::max({picture.pixels[k].x, picture.pixels[k].y, picture.pixels[k].z});
        ASSERT_LE(glm::length(read.radiance.pixels[k] - picture.pixels[k]), greatest / 64.0f);
    }
}

TEST(Environment, RefusesWhatIsCutShortAtAnyByte) {
    const std::string whole = header + "-Y 2 +X 8\n" + coded_rows();
    for (std::size_t length = 0; length < whole.size(); ++length)
        ASSERT_NE(refusal("cut.hdr", whole.substr(0, length)), "accepted") << length;
}

TEST(Environment, SurvivesAnyByteChanged) {
    const std::string whole = header + "-Y 2 +X 8\n" + coded_rows();
    for (std::uint32_t k = 0; k < 3000; ++k) {
        std::string changed = whole;
        changed[random_u32(3, k, 0) % whole.size()] = static_cast<char>(random_u32(3, k, 1));
        refusal("changed.hdr", changed);
    }
}

TEST(Environment, SaysWhatIsWrongWithAFile) {
    EXPECT_NE(refusal("png.hdr", "\x89PNG\r\n\x1a\n").find("not a Radiance picture"), std::string::npos);
    EXPECT_NE(refusal("xyze.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n").find("32-bit_rle_xyze"),
              std::string::npos);
    EXPECT_NE(refusal("flipped.hdr", header + "+Y 2 +X 8\n" + coded_rows()).find("rows must go down"),
              std::string::npos);
    EXPECT_NE(refusal("huge.hdr", header + "-Y 8000 +X 16000\n").find("cut short"), std::string::npos);
    EXPECT_NE(refusal("larger.hdr", header + "-Y 9000 +X 16\n").find("16,384 x 8,192"), std::string::npos);
    EXPECT_NE(refusal("minus.hdr", header + "-Y -2 +X 8\n").find("not a size"), std::string::npos);
    EXPECT_NE(refusal("run.hdr", header + "-Y 1 +X 8\n" + std::string({2, 2, 0, 8, static_cast<char>(200), 1}))
                  .find("does not fit"),
              std::string::npos);
    EXPECT_THROW(read_environment("/nowhere/sky.hdr"), InputError);
}

TEST(Environment, PutsRightWhatIsNotLight) {
    ImageRgb picture({4, 2}, vec3(65504.0f));
    picture.at(1, 0) = vec3(std::numeric_limits<float>::quiet_NaN(), 1.0f, 1.0f);
    picture.at(2, 0) = vec3(-1.0f, 2.0f, 2.0f);
    picture.at(3, 1) = vec3(std::numeric_limits<float>::infinity(), 3.0f, 3.0f);
    const Environment environment = make_environment("test", picture);
    EXPECT_EQ(environment.radiance.at(0, 0), vec3(65504.0f));
    EXPECT_EQ(environment.radiance.at(1, 0), vec3(0.0f, 1.0f, 1.0f));
    EXPECT_EQ(environment.radiance.at(2, 0), vec3(0.0f, 2.0f, 2.0f));
    EXPECT_EQ(environment.radiance.at(3, 1), vec3(1.0e9f, 3.0f, 3.0f));
    ASSERT_EQ(environment.notes.size(), 1u);
    EXPECT_NE(environment.notes[0].find("3 pixels"), std::string::npos);
    EXPECT_THROW(make_environment("empty", {}), InputError);
}

TEST(Environment, TheTexelsOfThePictureCoverTheSphere) {
    const ImageSize size{64, 32};
    double sum = 0.0;
    for (int y = 0; y < size.height; ++y) sum += size.width * texel_solid_angle(size, y);
    EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 1e-12);
}

TEST(Environment, DirectionsAndPixelsAreEachOthersInverse) {
    const ImageSize size{512, 256};
    EXPECT_LT(glm::distance(equirectangular_direction(size, {256.0f, 128.0f}), vec3(0.0f, 0.0f, -1.0f)), 1e-6f);
    EXPECT_LT(glm::distance(equirectangular_direction(size, {384.0f, 128.0f}), vec3(1.0f, 0.0f, 0.0f)), 1e-6f);
    EXPECT_LT(glm::distance(equirectangular_direction(size, {10.0f, 0.0f}), vec3(0.0f, 1.0f, 0.0f)), 1e-6f);
    for (std::uint32_t k = 0; k < 1000; ++k) {
        const vec3 direction = sphere_direction(random_unit(2, k, 0), random_unit(2, k, 1));
        const vec3 again = equirectangular_direction(size, equirectangular_pixel(size, direction));
        ASSERT_LT(glm::distance(direction, again), 1e-3f);
    }
}

TEST(Environment, IsLookedUpWithoutASeam) {
    ImageRgb picture({8, 4});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) picture.at(x, y) = vec3(static_cast<float>(x < 4 ? x : 7 - x));
    const Environment environment = make_environment("test", picture);
    const vec3 left = radiance_from(environment, glm::normalize(vec3(-1e-4f, 0.0f, 1.0f)));
    const vec3 right = radiance_from(environment, glm::normalize(vec3(1e-4f, 0.0f, 1.0f)));
    EXPECT_LT(glm::distance(left, right), 1e-2f);
}

/// Irradiance of level ground, green.
double level_irradiance(const Environment& sky) {
    double sum = 0.0;
    for (int y = 0; y < sky.radiance.size.height; ++y)
        for (int x = 0; x < sky.radiance.size.width; ++x) {
            const vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const double cosine = equirectangular_direction(sky.radiance.size, middle).y;
            sum += std::max(0.0, cosine) * texel_solid_angle(sky.radiance.size, y) * sky.radiance.at(x, y).g;
        }
    return sum;
}

TEST(Sky, LightsLevelGroundByAboutPiAtAnyHourOfTheDay) {
    for (const float elevation : {10.0f, 45.0f, 90.0f}) {
        SkyOptions options;
        options.sun_elevation_deg = elevation;
        EXPECT_NEAR(level_irradiance(procedural_sky(options)), std::numbers::pi, 0.35) << elevation;
    }
}

TEST(Sky, IsBrightestWhereTheSunIs) {
    SkyOptions options;
    options.sun_elevation_deg = 30.0f;
    options.sun_azimuth_deg = 90.0f;  // +X
    const Environment sky = procedural_sky(options);
    const auto brightest = std::ranges::max_element(sky.radiance.pixels, {}, [](vec3 pixel) { return pixel.g; });
    const auto place = static_cast<int>(brightest - sky.radiance.pixels.begin());
    const vec3 direction = equirectangular_direction(
        sky.radiance.size, {static_cast<float>(place % 512) + 0.5f, static_cast<float>(place / 512) + 0.5f});
    const float angle = std::acos(glm::dot(direction, vec3(std::cos(glm::radians(30.0f)), 0.5f, 0.0f)));
    EXPECT_LT(glm::degrees(angle), 2.0f);
}

TEST(Sky, RefusesAnglesThatAreNone) {
    SkyOptions options;
    options.sun_elevation_deg = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(procedural_sky(options), InputError);
    options = {};
    options.sun_radius_deg = 0.0f;
    EXPECT_THROW(procedural_sky(options), InputError);
}

}  // namespace
}  // namespace sightlines
