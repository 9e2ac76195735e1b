// Angles by polynomials against the library's, and a map's light against the environment's own look-up.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "shaders/angles.h"
#include "shaders/map_light.h"
#include "techniques/base/random.h"
#include "techniques/scene/environment_light.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

constexpr double full_turn = 2.0 * std::numbers::pi;

TEST(Angles, HaveTheSinesAndCosinesOfTheLibrary) {
    double largest = 0.0;
    for (int k = 0; k <= 100'000; ++k) {
        const float turns = static_cast<float>(k) / 100'000.0f;
        const kernel::SineCosine found = kernel::sine_cosine_of(turns);
        largest = std::max({largest, std::fabs(found.sine - std::sin(full_turn * double{turns})),
                            std::fabs(found.cosine - std::cos(full_turn * double{turns}))});
    }
    EXPECT_LT(largest, 2e-7);
}

TEST(Angles, OfPointsAreThoseOfTheLibrary) {
    double largest = 0.0;
    for (int k = 0; k <= 100'000; ++k) {
        const double angle = full_turn * (k / 100'000.0 - 0.5);
        for (const double radius : {1.0e-6, 1.0, 300.0}) {
            const auto x = static_cast<float>(radius * std::cos(angle)),
                       y = static_cast<float>(radius * std::sin(angle));
            const double expected = std::atan2(double{y}, double{x}) / full_turn;
            largest = std::max(largest, std::fabs(kernel::turns_of(y, x) - expected));
        }
    }
    EXPECT_LT(largest, 1e-7);
    EXPECT_FLOAT_EQ(kernel::turns_of(0.0f, 1.0f), 0.0f);
    EXPECT_FLOAT_EQ(kernel::turns_of(1.0f, 0.0f), 0.25f);
    EXPECT_FLOAT_EQ(kernel::turns_of(0.0f, -1.0f), 0.5f);
    EXPECT_FLOAT_EQ(kernel::turns_of(-1.0f, 0.0f), -0.25f);
}

TEST(MapLight, IsThatOfTheEnvironmentHoweverItIsTurned) {
    ImageRgb map({37, 20});
    for (std::uint32_t k = 0; k < map.pixels.size(); ++k)
        map.pixels[k] = vec3(random_unit(8, k, 0), random_unit(8, k, 1), random_unit(8, k, 2));
    for (const float turn : {0.0f, 73.0f, -140.0f}) {
        const EnvironmentLight light = turned(make_environment_light(make_environment("noise", map)), turn);
        const ImageRgb& texels = light.map->radiance;
        const kernel::MapLight looked_up{map_shape(texels.size, turn), {&texels.pixels.front().x}};
        for (std::uint32_t k = 0; k < 20'000; ++k) {
            const vec3 direction = sphere_direction(random_unit(9, k, 0), random_unit(9, k, 1));
            ASSERT_LT(glm::distance(kernel::light_from_map(looked_up, direction), radiance_from(light, direction)),
                      1e-4f);
        }
        // The poles, and where the map's ends meet.
        for (const vec3 direction : {vec3(0, 1, 0), vec3(0, -1, 0), turn_about_up(turn) * vec3(0, 0, 1)})
            EXPECT_TRUE(glm::all(glm::lessThanEqual(kernel::light_from_map(looked_up, direction), vec3(1.0f))));
    }
}

}  // namespace
}  // namespace sightlines::visibility_field
