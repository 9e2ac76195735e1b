// Directions drawn by a map.
#include "techniques/scene/map_sampling.h"

#include <numeric>

#include <gtest/gtest.h>

#include "techniques/base/random.h"
#include "techniques/scene/environment_light.h"
#include "tests/visibility_field/chi_square.h"

namespace sightlines {
namespace {

constexpr std::uint32_t samples = 200'000;

EnvironmentLight sunny_light(ImageSize size, float turn_deg) {
    SkyOptions options;
    options.size = size;
    options.sun_radius_deg = 12.0f;
    return turned(make_environment_light(procedural_sky(options)), turn_deg);
}

std::vector<double> found_in(const MapDistribution& distribution, const visibility_field::testing::SphereBins& bins) {
    std::vector<double> found(bins.count());
    for (std::uint32_t k = 0; k < samples; ++k)
        found[bins.bin_of(drawn_direction(distribution, {random_unit(5, k, 0), random_unit(5, k, 1)}))] += 1.0;
    return found;
}

TEST(MapSampling, DirectionsFallWhereTheirDensitySays) {
    const visibility_field::testing::SphereBins bins;
    for (const ImageSize size : {ImageSize{64, 32}, ImageSize{37, 20}})
        for (const float turn : {0.0f, 73.0f}) {
            const MapDistribution distribution = sunny_light(size, turn).distribution;
            const std::vector<double> expected = visibility_field::testing::integrals(
                bins, 60, [&](vec3 direction) { return drawn_density(distribution, direction); });
            EXPECT_NEAR(std::reduce(expected.begin(), expected.end()), 1.0, 2e-3);
            EXPECT_LT(visibility_field::testing::chi_square(expected, found_in(distribution, bins), samples), 1.5)
                << turn;
            const MapDistribution other = sunny_light(size, turn + 5.0f).distribution;
            EXPECT_GT(visibility_field::testing::chi_square(expected, found_in(other, bins), samples), 2.0)
                << "the test could not fail";
        }
}

TEST(MapSampling, DrawsByLightAndLeavesNothingOut) {
    const EnvironmentLight light = sunny_light({64, 32}, 0.0f);
    const MapDistribution distribution = light.distribution;
    const vec3 sun = glm::normalize(vec3(std::cos(glm::radians(45.0f)) * 0.5f, std::sin(glm::radians(45.0f)),
                                         -std::cos(glm::radians(45.0f)) * 0.8660254f));
    EXPECT_GT(drawn_density(distribution, sun), 20.0f * drawn_density(distribution, -sun));
    const MapDistribution of_night = make_distribution(ImageRgb({8, 4}));
    for (std::uint32_t k = 0; k < 1000; ++k) {
        const vec3 direction = sphere_direction(random_unit(6, k, 0), random_unit(6, k, 1));
        EXPECT_GE(drawn_density(distribution, direction), 0.0099f / (4.0f * std::numbers::pi_v<float>));
        EXPECT_NEAR(drawn_density(of_night, direction), 0.25f / std::numbers::pi_v<float>, 1e-4f);
    }
}

TEST(MapSampling, LargeMapsAreDrawnFromCoarsely) {
    ImageRgb black({3000, 1400});
    black.at(2000, 300) = vec3(1.0e6f);
    const MapDistribution distribution = make_distribution(black);
    EXPECT_EQ(distribution.tables->size, (ImageSize{1024, 512}));
    const vec3 star = equirectangular_direction({3000, 1400}, {2000.5f, 300.5f});
    int near = 0;
    for (std::uint32_t k = 0; k < 1000; ++k)
        near += glm::dot(star, drawn_direction(distribution, {random_unit(7, k, 0), random_unit(7, k, 1)})) > 0.999f;
    EXPECT_GT(near, 950);
    // Between texels the map is interpolated: there is light a texel away from the star.
    EXPECT_GT(drawn_density(distribution, equirectangular_direction({3000, 1400}, {1999.6f, 300.5f})), 100.0f);
}

}  // namespace
}  // namespace sightlines
