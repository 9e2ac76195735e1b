// What moves in the built-in scenes, and what lights them of their own.
#include <algorithm>
#include <array>
#include <cmath>
#include <future>

#include <gtest/gtest.h>

#include "techniques/scene/builtin_bear.h"
#include "techniques/scene/builtin_models.h"

namespace sightlines {
namespace {

std::vector<const Part*> parts_called(const Scene& scene, const std::string& name) {
    std::vector<const Part*> parts;
    for (const Part& part : scene.parts)
        if (part.name == name) parts.push_back(&part);
    return parts;
}

}  // namespace

TEST(Planes, AreTwoInstancesOfOneMeshThatFlyNoseFirst) {
    const SceneModel model = planes_model();
    const Scene scene = model.at(3.0), later = model.at(3.05);
    const auto planes = parts_called(scene, "plane"), next = parts_called(later, "plane");
    ASSERT_EQ(planes.size(), 2u);
    EXPECT_EQ(planes[0]->mesh, planes[1]->mesh);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(planes[i]->moves);
        const vec3 way = vec3(next[i]->world_from_part[3]) - vec3(planes[i]->world_from_part[3]);
        EXPECT_GT(glm::dot(glm::normalize(way), vec3(planes[i]->world_from_part[0])), 0.99f);
        EXPECT_NEAR(glm::determinant(mat3(planes[i]->world_from_part)), 1.0f, 1e-4f);
        EXPECT_GT(planes[i]->world_from_part[1].y, 0.5f) << "upside down";
    }
    for (const Part& part : scene.parts) EXPECT_EQ(part.moves, part.name == "plane");
}

TEST(Bear, IsAllThatDeforms) {
    const Scene scene = bear_model().at(1.0);
    int deforming = 0;
    for (const Part& part : scene.parts) {
        EXPECT_FALSE(part.moves) << part.name;
        EXPECT_EQ(part.deforms, part.name == "bear") << part.name;
        deforming += part.deforms ? 1 : 0;
        EXPECT_TRUE(!part.deforms || part.world_from_part == mat4(1.0f));
    }
    EXPECT_EQ(deforming, 1);
}

TEST(Bear, IsSomewhereAtEveryTenthOfASecond) {
    const SceneModel model = bear_model();
    for (int k = 0; k < 40; ++k) {
        const Scene scene = model.at(0.1 * k);
        const bool nowhere = std::ranges::any_of(
            scene.positions, [](const vec3& position) { return !std::isfinite(position.x + position.y + position.z); });
        ASSERT_FALSE(nowhere) << "at " << 0.1 * k << " s";
    }
}

TEST(Bear, BendsItsLegsSpineAndNeck) {
    using namespace bear;
    for (const std::uint32_t bone :
         std::array<std::uint32_t, 6>{lumbar, thorax, neck, first_leg, first_leg + 1, first_leg + 7}) {
        float least = 1.0f;
        for (int i = 0; i < 16; ++i) {
            const Skeleton now = running(static_cast<float>(i) / 16.0f);
            const std::uint32_t from = bone >= first_leg ? static_cast<std::uint32_t>(pelvis) : bone - 1;
            const Skeleton start = running(0.0f);
            // How its turn against another bone differs from that at the start.
            const mat3 turn = glm::transpose(mat3(now[from])) * mat3(now[bone]);
            const mat3 then = glm::transpose(mat3(start[from])) * mat3(start[bone]);
            least = std::min(least, glm::dot(turn[0], then[0]));
        }
        EXPECT_LT(least, std::cos(glm::radians(3.0f))) << "bone " << bone;
    }
}

TEST(Bear, PlantsFeetThatGoBackwardsAsFastAsItRuns) {
    using namespace bear;
    // A hind foot at rest, on its joint; in the middle of its stance.
    const vec4 ankle(-0.63f, 0.14f, 0.18f, 1.0f);
    constexpr float stride = 0.11f + 0.08f, step = 0.02f;
    const vec3 now(running(stride)[first_leg + 3 * 3 + 2] * ankle),
        later(running(stride + step)[first_leg + 3 * 3 + 2] * ankle);
    EXPECT_NEAR(now.x - later.x, step * stride_m, 0.1f * step * stride_m);
    EXPECT_NEAR(now.y, later.y, 0.01f);
}

TEST(Bear, StaysOnTheGroundAndOfItsSize) {
    const SceneModel model = bear_model();
    for (int i = 0; i < 12; ++i) {
        const Scene scene = model.at(0.05 * i);
        const Part& part = *parts_called(scene, "bear").at(0);
        Box3 box;
        for (std::uint32_t k = part.first_triangle; k < part.first_triangle + part.triangle_count; ++k)
            box.add(scene.positions[scene.triangles[k].x]);
        EXPECT_NEAR(box.lowest.y, 0.0f, 0.15f) << scene.time_s;
        EXPECT_LT(box.highest.y, 1.8f) << scene.time_s;
        EXPECT_LT(glm::length(vec2(box.size().x, box.size().z)), 3.6f) << scene.time_s;
    }
}

TEST(Park, HasAsManyLightsAsThePapersAtAllTimes) {
    const SceneModel model = park_model();
    for (const double time_s : {0.0, 7.3}) EXPECT_EQ(model.at(time_s).lights.size(), 7088u);
}

TEST(Park, CarriesTheLightsOfItsRidesAlong) {
    const SceneModel model = park_model();
    const Scene scene = model.at(0.0), later = model.at(2.0);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        EXPECT_EQ(scene.lights[i].kind, LightKind::point);
        EXPECT_EQ(scene.lights[i].intensity, later.lights[i].intensity);
        moved += glm::distance(scene.lights[i].position, later.lights[i].position) > 0.05f ? 1 : 0;
    }
    EXPECT_GT(moved, 2000u);
    EXPECT_LT(moved, 5000u);
    // The lights of the wheel go with it: each stays at its place in the wheel's own frame.
    const mat4 wheel_from_world = glm::inverse(parts_called(scene, "wheel").at(0)->world_from_part);
    const mat4 later_from_world = glm::inverse(parts_called(later, "wheel").at(0)->world_from_part);
    int with_wheel = 0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const vec3 here(wheel_from_world * vec4(scene.lights[i].position, 1.0f));
        const vec3 there(later_from_world * vec4(later.lights[i].position, 1.0f));
        with_wheel += glm::distance(here, there) < 1e-3f ? 1 : 0;
    }
    EXPECT_GE(with_wheel, 1440);
}

TEST(Park, KeepsItsGondolasUpright) {
    const Scene scene = park_model().at(5.0);
    const auto gondolas = parts_called(scene, "gondola");
    EXPECT_EQ(gondolas.size(), 24u);
    for (const Part* part : gondolas) EXPECT_GT(part->world_from_part[1].y, 0.99f);
}

TEST(Tv, LightsTheRoomByItsPicture) {
    const SceneModel model = tv_model();
    for (const double time_s : {0.0, 9.0}) {
        const Scene scene = model.at(time_s);
        ASSERT_EQ(scene.lights.size(), 1024u);
        const Part& screen = *parts_called(scene, "screen").at(0);
        const vec3 on_screen = scene.positions[scene.triangles[screen.first_triangle].x];
        const Image<glm::u8vec4>& picture = scene.textures[0].texels;
        // A light is as red against blue as the picture where it stands; row 0 is the top.
        int alike = 0;
        for (int k = 0; k < 1024; ++k) {
            const Light& light = scene.lights[static_cast<std::size_t>(k)];
            EXPECT_GT(light.position.z, on_screen.z);
            EXPECT_LT(light.position.z, on_screen.z + 0.05f);
            const int x = (k % 32 * 2 + 1) * picture.size.width / 64, y = (k / 32 * 2 + 1) * picture.size.height / 64;
            const glm::u8vec4 texel = picture.pixels[static_cast<std::size_t>(y * picture.size.width + x)];
            alike += (light.intensity.r > light.intensity.b) == (texel.r > texel.b) ? 1 : 0;
        }
        EXPECT_GT(alike, 940) << time_s;
        EXPECT_GT(scene.lights[0].position.y, scene.lights[1023].position.y);
    }
    EXPECT_NE(model.at(0.0).lights, model.at(9.0).lights);
    EXPECT_NE(model.at(0.0).textures[0].texels.pixels, model.at(9.0).textures[0].texels.pixels);
}

TEST(PosedScenes, AreMadeOnceForAllThreads) {
    const SceneModel model = bear_model();
    std::vector<std::future<Scene>> scenes;
    for (int i = 0; i < 4; ++i) scenes.push_back(std::async(std::launch::async, [&model] { return model.at(1.25); }));
    const Scene first = scenes[0].get();
    for (std::size_t i = 1; i < scenes.size(); ++i) {
        const Scene other = scenes[i].get();
        EXPECT_EQ(first.positions, other.positions);
        EXPECT_EQ(first.normals, other.normals);
        EXPECT_EQ(first.bounds, other.bounds);
    }
}

}  // namespace sightlines
