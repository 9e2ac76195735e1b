// Spherical harmonics of order 3 against integrals that are known.
#include "techniques/scene/harmonics.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "techniques/base/random.h"
#include "techniques/scene/environment_light.h"

namespace sightlines {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

vec3 some_direction(std::uint32_t k) { return sphere_direction(random_unit(9, k, 0), random_unit(9, k, 1)); }

Environment environment_of(const std::function<float(vec3)>& light, ImageSize size = {128, 64}) {
    ImageRgb picture(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            picture.at(x, y) = vec3(light(equirectangular_direction(size, vec2(0.5f) + vec2(x, y))), 1.0f, 0.0f);
    return make_environment("test", picture);
}

TEST(Harmonics, AreOrthonormal) {
    const ImageSize size{256, 128};
    std::array<std::array<double, 9>, 9> products{};
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const auto f = harmonic_functions(dvec3(equirectangular_direction(size, vec2(0.5f) + vec2(x, y))));
            for (std::size_t i = 0; i < 9; ++i)
                for (std::size_t j = 0; j < 9; ++j) products[i][j] += f[i] * f[j] * texel_solid_angle(size, y);
        }
    for (std::size_t i = 0; i < 9; ++i)
        for (std::size_t j = 0; j < 9; ++j) EXPECT_NEAR(products[i][j], i == j ? 1.0 : 0.0, 1e-3) << i << " " << j;
}

TEST(Harmonics, AConstantEnvironmentGivesPiTimesItsRadianceEverywhere) {
    const Harmonics harmonics = project(environment_of([](vec3) { return 2.0f; }));
    for (std::uint32_t k = 0; k < 100; ++k) {
        EXPECT_NEAR(irradiance(harmonics, some_direction(k)).x, 2.0f * pi, 2e-3f);
        EXPECT_NEAR(radiance(harmonics, some_direction(k)).x, 2.0f, 2e-3f);
        EXPECT_NEAR(irradiance(harmonics, some_direction(k)).y, pi, 1e-3f);
        EXPECT_EQ(irradiance(harmonics, some_direction(k)).z, 0.0f);
    }
}

TEST(Harmonics, AClampedCosineKeepsItsFirstThreeBands) {
    // Of max(y, 0): 1/4 + 1/2 y + 5/16 (3 yy - 1) / 2 ... (Ramamoorthi and Hanrahan 2001).
    const Harmonics harmonics = project(environment_of([](vec3 d) { return std::max(d.y, 0.0f); }));
    for (std::uint32_t k = 0; k < 100; ++k) {
        const vec3 d = some_direction(k);
        const float expected = 0.25f + 0.5f * d.y + 0.3125f * 0.5f * (3.0f * d.y * d.y - 1.0f);
        EXPECT_NEAR(radiance(harmonics, d).x, expected, 2e-3f);
    }
    // The cosine of the whole lobe with itself comes to 2 pi / 3 at its pole; the bands left out keep within a percent.
    EXPECT_NEAR(irradiance(harmonics, vec3(0.0f, 1.0f, 0.0f)).x, 2.0f * pi / 3.0f, 0.03f);
}

TEST(Harmonics, IrradianceIsTheIntegralOfRadianceTimesTheCosine) {
    const Harmonics harmonics =
        project(environment_of([](vec3 d) { return 2.0f + d.x - 0.5f * d.z * d.y + 0.7f * d.x * d.x; }));
    const vec3 normal = glm::normalize(vec3(0.3f, 0.8f, -0.5f));
    const ImageSize size{256, 128};
    double sum = 0.0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const vec3 d = equirectangular_direction(size, vec2(0.5f) + vec2(x, y));
            sum += std::max(0.0f, glm::dot(d, normal)) * radiance(harmonics, d).x * texel_solid_angle(size, y);
        }
    EXPECT_NEAR(irradiance(harmonics, normal).x, sum, 2e-3 * sum);
}

TEST(Harmonics, TurnWithTheirRotation) {
    const Harmonics harmonics = project(environment_of(
        [](vec3 d) { return 3.0f + d.x - d.y + 0.5f * d.z + d.x * d.y - d.y * d.z + 0.3f * d.z * d.z; }));
    const vec3 axis = glm::normalize(vec3(1.0f, 2.0f, -0.5f));
    // Rodrigues' formula, by columns.
    const float angle = 1.1f;
    mat3 rotation;
    for (int column = 0; column < 3; ++column) {
        vec3 unit(0.0f);
        unit[column] = 1.0f;
        rotation[column] = std::cos(angle) * unit + std::sin(angle) * glm::cross(axis, unit) +
                           (1.0f - std::cos(angle)) * glm::dot(axis, unit) * axis;
    }
    const Harmonics turned = rotated(harmonics, rotation);
    for (std::uint32_t k = 0; k < 100; ++k) {
        const vec3 d = some_direction(k);
        EXPECT_NEAR(radiance(turned, rotation * d).x, radiance(harmonics, d).x, 1e-5f);
    }
}

TEST(Harmonics, ATurnAboutUpGoesFromMinusZTowardsX) {
    EXPECT_LT(glm::distance(turn_about_up(90.0f) * vec3(0.0f, 0.0f, -1.0f), vec3(1.0f, 0.0f, 0.0f)), 1e-6f);
    EXPECT_LT(glm::distance(turn_about_up(30.0f) * vec3(0.0f, 1.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f)), 1e-6f);
}

TEST(EnvironmentLight, TurnsItsMapAndItsHarmonicsTogether) {
    const EnvironmentLight light =
        make_environment_light(environment_of([](vec3 direction) { return 1.0f + std::max(0.0f, -direction.z); }));
    const EnvironmentLight quarter = turned(turned(light, 40.0f), 90.0f);
    // What stood at -Z stands at +X, however it was turned before.
    EXPECT_NEAR(radiance_from(quarter, {1, 0, 0}).x, 2.0f, 0.01f);
    EXPECT_NEAR(radiance_from(quarter, {0, 0, -1}).x, 1.0f, 0.03f);
    for (std::uint32_t k = 0; k < 50; ++k) {
        const vec3 now = some_direction(k), before(now.z, now.y, -now.x);
        EXPECT_NEAR(radiance(quarter.harmonics, now).x, radiance(light.harmonics, before).x, 1e-4f);
        EXPECT_NEAR(radiance_from(quarter, now).x, radiance_from(light, before).x, 1e-3f);
    }
}

TEST(Harmonics, OfTheSharedEnvironmentsAreThoseOfTheirLight) {
    const std::filesystem::path file = std::string(SIGHTLINES_SHARED_FOLDER) + "/env/venice_512.hdr";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file.filename();
    const Environment venice = read_environment(file);
    ASSERT_EQ(venice.radiance.size, (ImageSize{512, 256}));
    const Harmonics harmonics = project(venice);
    for (const vec3 normal : {vec3(0, 1, 0), vec3(0, -1, 0), vec3(1, 0, 0)}) {
        dvec3 sum(0.0);
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 512; ++x) {
                const vec3 d = equirectangular_direction(venice.radiance.size, vec2(0.5f) + vec2(x, y));
                sum += dvec3(venice.radiance.at(x, y)) * static_cast<double>(std::max(0.0f, glm::dot(d, normal))) *
                       texel_solid_angle(venice.radiance.size, y);
            }
        // Nine coefficients keep irradiance to a few percent of what the brightest side gets.
        EXPECT_LT(glm::length(dvec3(irradiance(harmonics, normal)) - sum),
                  0.06 * glm::length(irradiance(harmonics, {0, 1, 0})));
    }
}

}  // namespace
}  // namespace sightlines
