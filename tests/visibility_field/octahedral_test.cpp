// The octahedral map and the hemisphere's frame: scalar against analysis, wide against scalar.
#include <cmath>
#include <numbers>
#include <vector>

#include "shaders/octahedral.h"

#include <gtest/gtest.h>

#include "techniques/base/random.h"
#include "tests/visibility_field/wide_octahedral.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

vec3 some_direction(std::uint32_t k) { return sphere_direction(random_unit(21, k, 0), random_unit(21, k, 1)); }

TEST(Octahedral, ADirectionComesBackFromItsPlace) {
    for (std::uint32_t k = 0; k < 10'000; ++k) {
        const vec3 direction = some_direction(k);
        const kernel::OctahedralPlace place = kernel::octahedral_place(direction * 3.0f);
        ASSERT_LE(std::max(std::fabs(place.u), std::fabs(place.v)), 1.0f);
        ASSERT_LT(glm::distance(kernel::octahedral_direction(place), direction), 1e-6f);
    }
}

TEST(Octahedral, AxesLieInTheMiddleAtTheEdgesAndInTheCorners) {
    const auto at = [](vec3 direction) {
        const kernel::OctahedralPlace place = kernel::octahedral_place(direction);
        return vec2(place.u, place.v);
    };
    EXPECT_EQ(at({0, 1, 0}), vec2(0, 0));
    EXPECT_EQ(at({1, 0, 0}), vec2(1, 0));
    EXPECT_EQ(at({0, 0, -1}), vec2(0, -1));
    EXPECT_EQ(glm::abs(at({0, -1, 0})), vec2(1, 1));
    EXPECT_EQ(at({0.25f, 0.5f, 0.25f}), vec2(0.25f, 0.25f));
    EXPECT_EQ(at({0.25f, -0.5f, 0.25f}), vec2(0.75f, 0.75f));
}

TEST(Octahedral, TheUpperHalfOfTheSphereFillsTheDiamond) {
    for (std::uint32_t k = 0; k < 10'000; ++k) {
        const vec3 direction = some_direction(k);
        const kernel::OctahedralPlace place = kernel::octahedral_place(direction);
        const float outside = std::fabs(place.u) + std::fabs(place.v) - 1.0f;
        ASSERT_TRUE((direction.y < 0.0f) == (outside > 0.0f) || std::fabs(outside) < 1e-6f);
    }
}

/// The solid angle of the flat triangle's part of the sphere (Van Oosterom and Strackee 1983).
double solid_angle(dvec3 a, dvec3 b, dvec3 c) {
    const double volume = std::fabs(glm::dot(a, glm::cross(b, c)));
    return 2.0 * std::atan2(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

TEST(Octahedral, TexelsCoverTheSphereOnceAndAreNearlyAlike) {
    for (const int size : {8, 18, 64}) {
        const auto corner = [&](int x, int y) {
            const float step = 2.0f / static_cast<float>(size);
            return dvec3(kernel::octahedral_direction(
                {static_cast<float>(x) * step - 1.0f, static_cast<float>(y) * step - 1.0f}));
        };
        double sum = 0.0, smallest = 1e9, largest = 0.0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                // The map is linear on either side of the diagonals along which it is folded; cut texels along these.
                const bool rising = (x < size / 2) == (y < size / 2);
                const dvec3 a = corner(x, y), b = corner(x + 1, y), c = corner(x + 1, y + 1), d = corner(x, y + 1);
                const double angle =
                    rising ? solid_angle(a, b, d) + solid_angle(b, c, d) : solid_angle(a, b, c) + solid_angle(a, c, d);
                sum += angle;
                smallest = std::min(smallest, angle);
                largest = std::max(largest, angle);
            }
        }
        EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 1e-4) << size;
        EXPECT_LT(largest / smallest, 6.0) << size;
    }
}

TEST(Octahedral, EveryDirectionLiesInATexelWhoseCornersSurroundIt) {
    constexpr int size = 18;
    for (std::uint32_t k = 0; k < 10'000; ++k) {
        const vec3 direction = some_direction(k);
        const kernel::OctahedralPlace place = kernel::octahedral_place(direction);
        const kernel::OctahedralTexel texel = kernel::octahedral_texel(place, size);
        ASSERT_NEAR(place.u, (2.0f * static_cast<float>(texel.column) + 1.0f) / size - 1.0f, 1.0f / size + 1e-6f);
        ASSERT_NEAR(place.v, (2.0f * static_cast<float>(texel.row) + 1.0f) / size - 1.0f, 1.0f / size + 1e-6f);
        ASSERT_TRUE(texel.column >= 0 && texel.column < size && texel.row >= 0 && texel.row < size);
    }
}

TEST(Octahedral, TheWideKernelAgreesWithTheScalarOneOnAMillionDirections) {
    constexpr std::uint32_t count = 1'000'003;
    std::vector<vec3> directions(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        directions[k] = some_direction(k);
        if (k % 7 == 0) directions[k][static_cast<int>(k % 3)] = 0.0f;  // on the folds
        if (k % 1001 == 0) directions[k] = vec3(0.0f, k % 2 == 0 ? 1.0f : -1.0f, 0.0f);
    }
    for (const int size : {8, 18, 61, 64}) {
        const std::vector<int> texels = testing::wide_texels(directions, size);
        for (std::uint32_t k = 0; k < count; ++k) {
            const kernel::OctahedralTexel texel =
                kernel::octahedral_texel(kernel::octahedral_place(directions[k]), size);
            ASSERT_EQ(texels[k], texel.row * size + texel.column) << k;
        }
    }
}

}  // namespace
}  // namespace sightlines::visibility_field
