#include "techniques/rays/virtual_lights.h"

#include <gtest/gtest.h>

#include "shaders/lighting.h"
#include "techniques/rays/light_records.h"
#include "tests/rays/test_scenes.h"

namespace sightlines {
namespace {

using namespace test;

constexpr float pi = std::numbers::pi_v<float>;

struct Furnace {
    Scene scene;
    std::shared_ptr<const EmbreeScene> embree;
};

/// A closed room of 2 m x 2 m x 2 m about the origin, all of one colour.
Furnace furnace(vec3 albedo) {
    Material material;
    material.base_color = albedo;
    Furnace room{scene_with_material(material), nullptr};
    add_box(room.scene, vec3(-1.0f), vec3(1.0f));
    room.embree = built(room.scene);
    return room;
}

std::vector<Light> followed(const Furnace& room, const std::vector<Light>& primary, std::uint32_t count,
                            int threads = 2, std::uint64_t seed = 1) {
    Progress progress;
    return virtual_lights(room.scene, *room.embree, primary, count, seed, threads, progress);
}

vec3 total_flux(const std::vector<Light>& lights) {
    dvec3 sum(0.0);
    for (const Light& light : lights) sum += dvec3(light_flux(light, {}));
    return vec3(sum);
}

Light spot_light(float inner_deg, float outer_deg) {
    Light light = point_light({0.2f, 0.5f, -0.1f}, vec3(2.0f));
    light.kind = LightKind::spot;
    light.direction = glm::normalize(vec3(0.3f, -1.0f, 0.2f));
    light.inner_cone_deg = inner_deg;
    light.outer_cone_deg = outer_deg;
    return light;
}

TEST(VirtualLights, CarryWhatAClosedRoomReflectsOverAllBounces) {
    // Each bounce reflects its albedo's share of the last: rho + rho^2 + ... = rho / (1 - rho), in each channel.
    const vec3 albedo(0.6f, 0.5f, 0.25f);
    const std::vector<Light> primary{point_light({0.2f, 0.3f, -0.1f}, {1.0f, 2.0f, 4.0f})};
    const std::vector<Light> lights = followed(furnace(albedo), primary, 20000);
    EXPECT_LE(lights.size(), 20000u);
    EXPECT_GT(lights.size(), 19900u);
    const vec3 expected = 4.0f * pi * primary[0].intensity * albedo / (1.0f - albedo);
    const vec3 flux = total_flux(lights);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(flux[channel], expected[channel], 0.04f * expected[channel]) << channel;
}

TEST(VirtualLights, ShareTheParticlesAmongLightsOfAllKindsByTheirPower) {
    Light patch;
    patch.kind = LightKind::surface;
    patch.position = {0, -0.9f, 0};
    patch.direction = {0, 1, 0};
    patch.intensity = vec3(3.0f);
    const std::vector<Light> primary{point_light({0, 0.2f, 0}, vec3(0.5f)), spot_light(20.0f, 50.0f), patch};
    vec3 power(0.0f);
    for (const Light& light : primary) power += light_flux(light, {});
    const vec3 flux = total_flux(followed(furnace(vec3(0.5f)), primary, 20000));
    EXPECT_NEAR(flux.g, power.g, 0.04f * power.g);
}

TEST(VirtualLights, KnowTheFluxOfASpotAsTheIntegralOfItsFalloff) {
    for (const auto& [inner, outer] : {std::pair{0.0f, 45.0f}, {20.0f, 50.0f}, {30.0f, 30.0f}, {0.0f, 90.0f}}) {
        const Light light = spot_light(inner, outer);
        const LightRecord record = light_record(light);
        double integral = 0.0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double cosine = 1.0 - 2.0 * (i + 0.5) / steps;
            const auto sine = static_cast<float>(std::sqrt(1.0 - cosine * cosine));
            // A surface at 1 m that faces the light.
            LightRecord down = record;
            down.position = vec3(0.0f);
            down.direction = {0, -1, 0};
            const vec3 place(sine, -static_cast<float>(cosine), 0.0f);
            integral += 2.0 * std::numbers::pi * 2.0 / steps *
                        static_cast<double>(scalar_kernel::irradiance_per_intensity(down, -place, -place));
        }
        EXPECT_NEAR(light_flux(light, {}).g, 2.0 * integral, 0.01 * integral) << inner << " to " << outer;
    }
}

TEST(VirtualLights, StandALittleOffTheSurfacesAndShineIntoTheRoom) {
    for (const Light& light : followed(furnace(vec3(0.7f)), {spot_light(10.0f, 80.0f)}, 500)) {
        EXPECT_EQ(light.kind, LightKind::surface);
        const vec3 away = glm::abs(light.position - virtual_light_lift * std::sqrt(12.0f) * light.direction);
        EXPECT_NEAR(std::max({away.x, away.y, away.z}), 1.0f, 1e-3f);
        EXPECT_GT(glm::dot(light.direction, -light.position), 0.9f);
        EXPECT_NEAR(light.nearest_m, 1.2f * std::sqrt(12.0f) / std::sqrt(500.0f), 0.01f);
    }
}

TEST(VirtualLights, TakeTheColourOfTheWallTheyLieOn) {
    Furnace room = furnace(vec3(0.5f));
    Material red;
    red.base_color = {0.8f, 0.1f, 0.1f};
    room.scene.materials.push_back(red);
    room.scene.triangle_materials[4] = room.scene.triangle_materials[5] = 1;  // the wall at x = -1
    room.embree = built(room.scene);
    int on_red = 0;
    for (const Light& light : followed(room, {point_light({0, 0, 0})}, 400)) {
        if (light.direction.x < 0.99f) continue;
        ++on_red;
        EXPECT_GE(light.intensity.r, 3.9f * light.intensity.g);
    }
    EXPECT_GT(on_red, 20);
}

TEST(VirtualLights, AreTheSameOnAnyNumberOfThreads) {
    const Furnace room = furnace(vec3(0.6f));
    const std::vector<Light> primary{point_light({0, 0.1f, 0}), spot_light(0.0f, 60.0f)};
    const std::vector<Light> one = followed(room, primary, 3000, 1);
    EXPECT_EQ(one, followed(room, primary, 3000, 2));
    EXPECT_EQ(one, followed(room, primary, 3000, 2));
    EXPECT_NE(one, followed(room, primary, 3000, 2, 7));
}

TEST(VirtualLights, AreFewerWhereMostOfTheLightIsLost) {
    Material grey;
    Furnace open{scene_with_material(grey), nullptr};
    add_quad(open.scene, {-0.05f, -1, -0.05f}, {0, 0, 0.1f}, {0.1f, 0, 0});
    open.embree = built(open.scene);
    EXPECT_LT(followed(open, {point_light({0, 0, 0})}, 200).size(), 100u);
    EXPECT_TRUE(followed(open, {point_light({0, 0, 0}, vec3(0.0f))}, 200).empty());
    EXPECT_TRUE(followed(open, {}, 200).empty());
    EXPECT_TRUE(followed(open, {point_light({0, 0, 0})}, 0).empty());
}

TEST(VirtualLights, StopWhenTheyAreCancelled) {
    Progress progress;
    progress.cancel();
    const Furnace room = furnace(vec3(0.6f));
    const std::vector<Light> primary{point_light({0, 0, 0})};
    EXPECT_THROW(virtual_lights(room.scene, *room.embree, primary, 1000, 1, 2, progress), Cancelled);
}

TEST(SurfaceLights, ShineToTheirFrontByTheCosineAndNoStrongerThanFromTheirNearestDistance) {
    Light patch;
    patch.kind = LightKind::surface;
    patch.direction = {0, 1, 0};
    patch.nearest_m = 0.5f;
    const LightRecord record = light_record(patch);
    const auto given = [&](vec3 place) {
        const vec3 to_the_light = scalar_kernel::to_light(record, place, 100.0f);
        return scalar_kernel::irradiance_per_intensity(record, glm::normalize(to_the_light), to_the_light);
    };
    EXPECT_FLOAT_EQ(given({0, 2, 0}), 1.0f / 4.0f);
    EXPECT_FLOAT_EQ(given({2, 2, 0}), std::sqrt(0.5f) / 8.0f);
    EXPECT_FLOAT_EQ(given({2, 0, 0}), 0.0f);
    EXPECT_FLOAT_EQ(given({1, -1, 0}), 0.0f);
    EXPECT_FLOAT_EQ(given({0, 0.1f, 0}), 4.0f);
    EXPECT_FLOAT_EQ(given({0, 0.5f, 0}), 4.0f);
}

}  // namespace
}  // namespace sightlines
