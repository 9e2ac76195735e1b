// Rays without an end, packed, against the simplest ray tracer.
#include "techniques/rays/open_rays.h"

#include <gtest/gtest.h>

#include "tests/rays/test_scenes.h"

namespace sightlines {
namespace {

TEST(OpenRays, PacketsAnswerAsTheSimplestRayTracerDoes) {
    const Scene scene = test::triangle_soup(60);
    const auto embree = test::built(scene);
    constexpr std::size_t count = 1003;  // not a multiple of a packet
    std::vector<float> numbers[6];
    for (auto& axis : numbers) axis.resize(count + 16);
    for (std::uint32_t k = 0; k < count; ++k) {
        const vec3 origin = test::random_point(scene.bounds, k, 7);
        const vec3 direction = sphere_direction(random_unit(8, k, 0), random_unit(8, k, 1));
        for (int axis = 0; axis < 3; ++axis) {
            numbers[axis][k] = origin[axis];
            numbers[3 + axis][k] = direction[axis];
        }
    }
    const PackedOpenRays rays{{numbers[0].data(), numbers[1].data(), numbers[2].data()},
                              {numbers[3].data(), numbers[4].data(), numbers[5].data()},
                              count};
    std::vector<std::uint32_t> blocked(count / 32 + 1, 0xffffffffu);
    are_blocked(*embree, rays, blocked);
    int hits = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const vec3 origin(numbers[0][k], numbers[1][k], numbers[2][k]);
        const vec3 direction(numbers[3][k], numbers[4][k], numbers[5][k]);
        const bool expected = test::any_crosses(scene, origin, origin + 10.0f * direction, 0.0, 1.0);
        ASSERT_EQ((blocked[k / 32] >> (k % 32) & 1u) != 0, expected) << k;
        ASSERT_EQ(is_blocked(*embree, origin, direction), expected) << k;
        hits += expected;
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(hits, 900);
    EXPECT_EQ(blocked[count / 32] >> (count % 32), 0u);
}

TEST(OpenRays, ThatEndMeetOnlyWhatLiesBeforeTheirEnd) {
    const Scene scene = test::triangle_soup(60);
    const auto embree = test::built(scene);
    constexpr std::size_t count = 1003;
    std::vector<float> numbers[7];
    for (auto& axis : numbers) axis.resize(count + 16);
    for (std::uint32_t k = 0; k < count; ++k) {
        const vec3 origin = test::random_point(scene.bounds, k, 7);
        const vec3 direction = sphere_direction(random_unit(8, k, 0), random_unit(8, k, 1));
        for (int axis = 0; axis < 3; ++axis) {
            numbers[axis][k] = origin[axis];
            numbers[3 + axis][k] = direction[axis];
        }
        numbers[6][k] = 2.0f * random_unit(9, k, 0);
    }
    PackedOpenRays rays{{numbers[0].data(), numbers[1].data(), numbers[2].data()},
                        {numbers[3].data(), numbers[4].data(), numbers[5].data()},
                        count};
    std::vector<std::uint32_t> endless(count / 32 + 1), ending(count / 32 + 1);
    are_blocked(*embree, rays, endless);
    rays.length_m = numbers[6].data();
    are_blocked(*embree, rays, ending);
    int freed = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const vec3 origin(numbers[0][k], numbers[1][k], numbers[2][k]);
        const vec3 direction(numbers[3][k], numbers[4][k], numbers[5][k]);
        const bool expected = test::any_crosses(scene, origin, origin + numbers[6][k] * direction, 0.0, 1.0);
        ASSERT_EQ((ending[k / 32] >> (k % 32) & 1u) != 0, expected) << k;
        freed += (endless[k / 32] >> (k % 32) & 1u) != 0 && !expected;
    }
    EXPECT_GT(freed, 50);
}

TEST(OpenRays, DoNotMeetTheSurfaceThatTheyLeave) {
    Scene scene = test::scene_with_material();
    test::add_quad(scene, {-50.0f, 0.0f, -50.0f}, {0.0f, 0.0f, 100.0f}, {100.0f, 0.0f, 0.0f});
    const auto embree = test::built(scene);
    for (std::uint32_t k = 0; k < 1000; ++k) {
        const vec3 position = test::random_point(scene.bounds, k, 3);
        vec3 direction = sphere_direction(random_unit(4, k, 0), random_unit(4, k, 1));
        direction.y = std::fabs(direction.y);
        EXPECT_FALSE(is_blocked(*embree, lifted_off(*embree, position, {0.0f, 1.0f, 0.0f}), direction));
        EXPECT_TRUE(is_blocked(*embree, lifted_off(*embree, position, {0.0f, 1.0f, 0.0f}), {0.0f, -1.0f, 0.0f}));
    }
}

}  // namespace
}  // namespace sightlines
