// Rays without an end, packed, against the simplest ray tracer.
#include "techniques/rays/open_rays.h"

#include <gtest/gtest.h>

#include "tests/rays/test_scenes.h"

namespace sightlines {
namespace {

constexpr std::size_t count = 1003;  // not a multiple of a packet

/// Rays in all directions from random places of the box.
struct RandomRays {
    std::vector<float> numbers[6];

    explicit RandomRays(const Box3& box) {
        for (auto& axis : numbers) axis.resize(count + 16);
        for (std::uint32_t k = 0; k < count; ++k) {
            const vec3 from = test::random_point(box, k, 7);
            const vec3 along = sphere_direction(random_unit(8, k, 0), random_unit(8, k, 1));
            for (int axis = 0; axis < 3; ++axis) {
                numbers[axis][k] = from[axis];
                numbers[3 + axis][k] = along[axis];
            }
        }
    }
    PackedOpenRays packed() const {
        return {{numbers[0].data(), numbers[1].data(), numbers[2].data()},
                {numbers[3].data(), numbers[4].data(), numbers[5].data()},
                count};
    }
    vec3 origin(std::size_t k) const { return {numbers[0][k], numbers[1][k], numbers[2][k]}; }
    vec3 direction(std::size_t k) const { return {numbers[3][k], numbers[4][k], numbers[5][k]}; }
};

TEST(OpenRays, PacketsAnswerAsTheSimplestRayTracerDoes) {
    const Scene scene = test::triangle_soup(60);
    const auto embree = test::built(scene);
    const RandomRays rays(scene.bounds);
    std::vector<std::uint32_t> blocked(count / 32 + 1, 0xffffffffu);
    are_blocked(*embree, rays.packed(), blocked);
    int hits = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const vec3 origin = rays.origin(k), direction = rays.direction(k);
        const bool expected = test::any_crosses(scene, origin, origin + 10.0f * direction, 0.0, 1.0);
        ASSERT_EQ((blocked[k / 32] >> (k % 32) & 1u) != 0, expected) << k;
        ASSERT_EQ(is_blocked(*embree, origin, direction), expected) << k;
        hits += expected;
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(hits, 900);
    EXPECT_EQ(blocked[count / 32] >> (count % 32), 0u);
}

TEST(OpenRays, PacketsFindWhatSingleRaysHit) {
    const Scene scene = test::triangle_soup(60);
    const auto embree = test::built(scene);
    const RandomRays rays(scene.bounds);
    std::vector<Hit> hits(count, Hit{1.0f, 5, vec2(0.5f)});
    find_closest(*embree, rays.packed(), hits);
    int found = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto expected = closest_hit(*embree, rays.origin(k), rays.direction(k), 100.0f);
        ASSERT_EQ(hits[k].triangle, expected ? expected->triangle : no_triangle) << k;
        if (!expected) continue;
        ++found;
        ASSERT_FLOAT_EQ(hits[k].distance_m, expected->distance_m);
        const SurfaceAt surface = surface_at(scene, hits[k], rays.direction(k));
        ASSERT_LT(glm::distance(surface.position, rays.origin(k) + hits[k].distance_m * rays.direction(k)), 1e-4f);
        ASSERT_LE(glm::dot(surface.normal, rays.direction(k)), 0.0f);
    }
    EXPECT_GT(found, 100);
    EXPECT_LT(found, 900);
}

TEST(OpenRays, ThatEndMeetOnlyWhatLiesBeforeTheirEnd) {
    const Scene scene = test::triangle_soup(60);
    const auto embree = test::built(scene);
    RandomRays random(scene.bounds);
    std::vector<float> lengths(count + 16);
    for (std::uint32_t k = 0; k < count; ++k) lengths[k] = 2.0f * random_unit(9, k, 0);
    PackedOpenRays rays = random.packed();
    std::vector<std::uint32_t> endless(count / 32 + 1), ending(count / 32 + 1);
    are_blocked(*embree, rays, endless);
    rays.length_m = lengths.data();
    are_blocked(*embree, rays, ending);
    int freed = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const vec3 origin = random.origin(k), direction = random.direction(k);
        const bool expected = test::any_crosses(scene, origin, origin + lengths[k] * direction, 0.0, 1.0);
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
