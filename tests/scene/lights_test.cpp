#include "techniques/scene/lights.h"

#include <cmath>

#include <gtest/gtest.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

constexpr vec3 luminance_weights(0.2126f, 0.7152f, 0.0722f);

Scene scene_with_volume(Box3 volume, double time_s = 0.0) {
    Scene scene;
    scene.time_s = time_s;
    scene.bounds = {volume.lowest - vec3(1.0f), volume.highest + vec3(1.0f)};
    scene.light_volume = volume;
    return scene;
}

const Box3 box{{-4.0f, 1.0f, 2.0f}, {8.0f, 5.0f, 9.0f}};

LightChoice many(std::uint32_t count) {
    LightChoice choice;
    choice.count = count;
    return choice;
}

bool inside(const Box3& outer, vec3 point) {
    return glm::all(glm::greaterThanEqual(point, outer.lowest)) && glm::all(glm::lessThanEqual(point, outer.highest));
}

}  // namespace

TEST(Lights, AreTheSameEachTimeAndOthersForAnotherSeed) {
    const Scene scene = scene_with_volume(box);
    EXPECT_EQ(make_lights(scene, many(50), 1), make_lights(scene, many(50), 1));
    const std::vector<Light> one = make_lights(scene, many(50), 1), two = make_lights(scene, many(50), 2);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NE(one[i].position, two[i].position);
}

TEST(Lights, DoNotDependOnHowManyThereAreButForTheirIntensity) {
    for (const LightPlacement placement : {LightPlacement::volume, LightPlacement::sphere}) {
        LightChoice few = many(10), more = many(4000);
        few.placement = more.placement = placement;
        few.moving = more.moving = true;
        const Scene scene = scene_with_volume(box, 3.0);
        const std::vector<Light> a = make_lights(scene, few, 4), b = make_lights(scene, more, 4);
        ASSERT_EQ(a.size(), 10u);
        ASSERT_EQ(b.size(), 4000u);
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_EQ(a[i].position, b[i].position);
            EXPECT_LT(glm::distance(a[i].intensity, 400.0f * b[i].intensity), 1e-4f * glm::length(a[i].intensity));
        }
    }
}

TEST(Lights, FillTheVolumeEvenly) {
    const std::vector<Light> lights = make_lights(scene_with_volume(box), many(8000), 1);
    int octants[8] = {};
    for (const Light& light : lights) {
        ASSERT_TRUE(inside(box, light.position));
        const auto above = glm::greaterThan(light.position, box.centre());
        ++octants[(above.x ? 1 : 0) + (above.y ? 2 : 0) + (above.z ? 4 : 0)];
    }
    for (const int count : octants) EXPECT_NEAR(count, 1000, 150);  // five standard deviations
}

TEST(Lights, OnASphereSurroundTheBounds) {
    LightChoice choice = many(2000);
    choice.placement = LightPlacement::sphere;
    const Scene scene = scene_with_volume(box);
    const std::vector<Light> lights = make_lights(scene, choice, 1);
    const float radius = glm::distance(lights[0].position, scene.bounds.centre());
    vec3 mean(0.0f);
    for (const Light& light : lights) {
        EXPECT_NEAR(glm::distance(light.position, scene.bounds.centre()), radius, 1e-3f * radius);
        EXPECT_FALSE(inside(scene.bounds, light.position));
        mean += (light.position - scene.bounds.centre()) / radius / 2000.0f;
    }
    EXPECT_LT(glm::length(mean), 0.07f);
}

TEST(Lights, ShareOneLuminanceAndAreWhiteTogether) {
    const std::vector<Light> lights = make_lights(scene_with_volume(box), many(5000), 1);
    const float luminance = glm::dot(lights[0].intensity, luminance_weights);
    vec3 sum(0.0f), lowest(1e9f), highest(0.0f);
    for (const Light& light : lights) {
        EXPECT_NEAR(glm::dot(light.intensity, luminance_weights), luminance, 1e-4f * luminance);
        EXPECT_TRUE(light.intensity.r > 0.0f && light.intensity.g > 0.0f && light.intensity.b > 0.0f);
        sum += light.intensity;
        lowest = glm::min(lowest, light.intensity);
        highest = glm::max(highest, light.intensity);
    }
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(sum[i] / sum.g, 1.0f, 0.05f);
        EXPECT_GT(highest[i], 1.5f * lowest[i]);
    }
    LightChoice white = many(20);
    white.coloured = false;
    for (const Light& light : make_lights(scene_with_volume(box), white, 1)) {
        EXPECT_EQ(light.intensity.r, light.intensity.g);
        EXPECT_EQ(light.intensity.r, light.intensity.b);
    }
}

TEST(Lights, KeepTheirTotalWhateverTheirNumberAndScaleWithBrightness) {
    const auto total = [](LightChoice choice) {
        float sum = 0.0f;
        for (const Light& light : make_lights(scene_with_volume(box), choice, 1))
            sum += glm::dot(light.intensity, luminance_weights);
        return sum;
    };
    const float of_one = total(many(1));
    EXPECT_NEAR(total(many(1000)), of_one, 1e-3f * of_one);
    LightChoice bright = many(100);
    bright.brightness = 3.0f;
    EXPECT_NEAR(total(bright), 3.0f * of_one, 1e-2f * of_one);
}

TEST(Lights, LightAFloorAboutMiddleGreyAtAnyScale) {
    for (const float scale : {0.1f, 1.0f, 50.0f}) {
        const Box3 room{vec3(0.0f), scale * vec3(10.0f, 4.0f, 8.0f)};
        for (const std::uint32_t count : {64u, 4096u}) {
            float irradiance = 0.0f;  // mean over the floor, nothing in the way
            for (const Light& light : make_lights(scene_with_volume(room), many(count), 1)) {
                for (int i = 0; i < 16; ++i) {
                    const vec2 cell(static_cast<float>(i % 4), static_cast<float>(i / 4));
                    const vec3 spot = room.size() * vec3((cell.x + 0.5f) / 4.0f, 0.0f, (cell.y + 0.5f) / 4.0f);
                    const vec3 way = light.position - spot;
                    const float squared = std::max(glm::dot(way, way), 0.01f * scale * scale);
                    irradiance +=
                        glm::dot(light.intensity, luminance_weights) * way.y / (squared * std::sqrt(squared)) / 16.0f;
                }
            }
            const float radiance = 0.5f / 3.14159f * irradiance;
            EXPECT_GT(radiance, 0.09f) << scale << " " << count;
            EXPECT_LT(radiance, 0.9f) << scale << " " << count;
        }
    }
}

TEST(Lights, GoRoundClosedPathsInsideTheVolume) {
    LightChoice choice = many(40);
    choice.moving = true;
    const std::vector<Light> start = make_lights(scene_with_volume(box, 0.0), choice, 1);
    std::vector<float> nearest(start.size(), 1e9f), farthest(start.size(), 0.0f);
    std::vector<Light> before = start;
    constexpr double step_s = 0.02;
    for (int i = 1; i <= 600; ++i) {  // 12 s: longer than the longest period
        const std::vector<Light> now = make_lights(scene_with_volume(box, step_s * i), choice, 1);
        for (std::size_t k = 0; k < now.size(); ++k) {
            ASSERT_TRUE(inside(box, now[k].position)) << "light " << k << " at " << step_s * i << " s";
            EXPECT_LT(glm::distance(now[k].position, before[k].position), 0.1f);
            const float away = glm::distance(now[k].position, start[k].position);
            farthest[k] = std::max(farthest[k], away);
            if (step_s * i > 3.0) nearest[k] = std::min(nearest[k], away);
        }
        before = now;
    }
    for (std::size_t k = 0; k < start.size(); ++k) {
        EXPECT_GT(farthest[k], 0.2f) << "light " << k << " stands still";
        EXPECT_LT(nearest[k], 0.05f) << "light " << k << " does not come back";
    }
}

TEST(Lights, StandStillUnlessAskedToMove) {
    EXPECT_EQ(make_lights(scene_with_volume(box, 0.0), many(9), 1),
              make_lights(scene_with_volume(box, 7.0), many(9), 1));
}

TEST(Lights, AreTheScenesOwnWhereNoneAreAskedFor) {
    Scene scene = scene_with_volume(box);
    Light own;
    own.kind = LightKind::directional;
    own.intensity = vec3(2.0f);
    scene.lights = {own, own};
    EXPECT_EQ(make_lights(scene, LightChoice{}, 1), scene.lights);
    LightChoice dim;
    dim.brightness = 0.5f;
    EXPECT_EQ(make_lights(scene, dim, 1)[0].intensity, vec3(1.0f));
}

TEST(Lights, AreOneInTheVolumeWhereTheSceneHasNone) {
    const std::vector<Light> lights = make_lights(scene_with_volume(box), LightChoice{}, 1);
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_TRUE(inside(box, lights[0].position));
    EXPECT_GT(lights[0].position.y, box.centre().y);
    EXPECT_GT(lights[0].intensity.r, 0.0f);
    // Also in a scene with nothing in it.
    const std::vector<Light> nothing = make_lights(Scene{}, LightChoice{}, 1);
    ASSERT_EQ(nothing.size(), 1u);
    EXPECT_TRUE(std::isfinite(nothing[0].intensity.r));
}

TEST(Lights, AreFiniteInAFlatVolume) {
    const Box3 flat{{0.0f, 1.0f, 0.0f}, {4.0f, 1.0f, 4.0f}}, point{vec3(1.0f), vec3(1.0f)};
    for (const Box3& volume : {flat, point}) {
        LightChoice choice = many(8);
        choice.moving = true;
        for (const Light& light : make_lights(scene_with_volume(volume), choice, 1)) {
            EXPECT_TRUE(inside(volume, light.position));
            EXPECT_TRUE(std::isfinite(light.intensity.r) && light.intensity.r > 0.0f);
        }
    }
}

TEST(Lights, AreAtMost65536) {
    EXPECT_EQ(make_lights(scene_with_volume(box), many(65536), 1).size(), 65536u);
    EXPECT_THROW(make_lights(scene_with_volume(box), many(65537), 1), InputError);
}

}  // namespace sightlines
