#include "techniques/rays/embree_scene.h"

#include <gtest/gtest.h>

#include "tests/rays/test_scenes.h"

namespace sightlines::test {
namespace {

const vec3 up(0.0f, 1.0f, 0.0f);

TEST(EmbreeScene, ClosestHitFindsDistanceTriangleAndPlace) {
    Scene scene = scene_with_material();
    add_triangle(scene, {0, 5, 0}, {1, 5, 0}, {0, 5, 1});
    add_triangle(scene, {0, 2, 0}, {1, 2, 0}, {0, 2, 1});
    const auto embree = built(scene);
    const auto hit = closest_hit(*embree, {0.25f, 0.0f, 0.5f}, up, 100.0f);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->triangle, 1u);
    EXPECT_NEAR(hit->distance_m, 2.0f, 1e-5f);
    EXPECT_NEAR(hit->barycentric.x, 0.25f, 1e-5f);
    EXPECT_NEAR(hit->barycentric.y, 0.5f, 1e-5f);
    EXPECT_FALSE(closest_hit(*embree, {0.25f, 0.0f, 0.5f}, up, 1.9f).has_value());
    EXPECT_FALSE(closest_hit(*embree, {0.9f, 0.0f, 0.9f}, up, 100.0f).has_value());
}

TEST(EmbreeScene, ABoxBetweenPointAndLightBlocks) {
    Scene scene = scene_with_material();
    add_quad(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
    add_box(scene, {-1, 1, -1}, {1, 2, 1});
    for (const EmbreeUse use : {EmbreeUse::reference, EmbreeUse::benchmark}) {
        const auto embree = built(scene, use);
        EXPECT_TRUE(occluded(*embree, {{0, 0, 0}, {0, 4, 0}}, up));
        EXPECT_TRUE(occluded(*embree, {{-2, 0, 0}, {2, 3, 0}}, up));
        EXPECT_FALSE(occluded(*embree, {{0, 0, 0}, {0, 0.9f, 0}}, up));
        EXPECT_FALSE(occluded(*embree, {{3, 0, 0}, {3, 4, 0}}, up));
        EXPECT_FALSE(occluded(*embree, {{-4, 0, 0}, {4, 0.5f, 0}}, up));
    }
}

TEST(EmbreeScene, TheShadowOfASphereIsWhereGeometrySaysItIs) {
    Scene scene = scene_with_material();
    const vec3 centre(0.3f, 2.0f, -0.2f);
    add_sphere(scene, centre, 1.0f, 128);
    add_quad(scene, {-6, 0, -6}, {0, 0, 12}, {12, 0, 0});
    const auto embree = built(scene);
    const vec3 light(1.0f, 5.0f, 0.5f);
    int blocked = 0, open = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const vec3 point = random_point({{-6, 0, -6}, {6, 0, 6}}, i);
        const vec3 along = glm::normalize(light - point);
        const float distance = glm::length(centre - point - glm::dot(centre - point, along) * along);
        // The mesh lies between the sphere and one smaller by 1 - cos(pi / 64).
        const bool in_shadow = occluded(*embree, {point, light}, up);
        if (distance > 1.0001f) {
            ASSERT_FALSE(in_shadow) << i;
            ++open;
        } else if (distance < 0.997f) {
            ASSERT_TRUE(in_shadow) << i;
            ++blocked;
        }
    }
    EXPECT_GT(blocked, 500);
    EXPECT_GT(open, 10000);
}

TEST(EmbreeScene, ASurfaceDoesNotShadowItselfHoweverLowTheLight) {
    for (const float scale_m : {1e-3f, 1.0f, 1e4f}) {
        Scene scene = scene_with_material();
        add_quad(scene, scale_m * vec3(-5, -1.7f, -5), scale_m * vec3(0.3f, 0.1f, 10), scale_m * vec3(10, 0.7f, 0));
        const auto embree = built(scene);
        const vec3 normal = glm::normalize(glm::cross(vec3(0.3f, 0.1f, 10), vec3(10, 0.7f, 0)));
        for (std::uint32_t i = 0; i < 20000; ++i) {
            const float u = random_unit(3, i, 0), v = random_unit(3, i, 1), height = 5.0f * random_unit(3, i, 2);
            const vec3 point = scene.positions[0] + scale_m * (u * vec3(0.3f, 0.1f, 10) + v * vec3(10, 0.7f, 0));
            const vec3 across = scale_m * 20.0f * (random_unit(3, i, 3) - 0.5f) * vec3(10, 0.7f, 0);
            const vec3 light = point + across + scale_m * (height * height * height + 1e-3f) * normal;
            ASSERT_FALSE(occluded(*embree, {point, light}, normal)) << "scale " << scale_m << ", ray " << i;
        }
    }
}

enum class Aim { corner, edge, inside };

/// A random corner, point of an edge, or point of a triangle of the scene.
vec3 place_to_aim_at(const Scene& scene, Aim aim, std::uint32_t i) {
    const uvec3 triangle = scene.triangles[random_u32(7, i, 0) % scene.triangles.size()];
    const vec3 a = scene.positions[triangle.x], b = scene.positions[triangle.y], c = scene.positions[triangle.z];
    const float u = random_unit(7, i, 1);
    const float v = random_unit(7, i, 2) * (1.0f - u);
    if (aim == Aim::corner) return a;
    return aim == Aim::edge ? a + u * (b - a) : a + u * (b - a) + v * (c - a);
}

/// Of `rays` rays out of a closed body each way, from inside and from outside, how many meet nothing.
int leaks(const Scene& scene, Aim aim, std::uint32_t rays) {
    const auto embree = built(scene);
    int count = 0;
    for (std::uint32_t i = 0; i < rays; ++i) {
        const vec3 inside = 0.3f * random_point({vec3(-1.0f), vec3(1.0f)}, i) + vec3(0.1f, 0.2f, 0.3f);
        const vec3 towards = place_to_aim_at(scene, aim, i) - inside;
        count += occluded(*embree, {inside, inside + 4.0f * towards}, vec3(0.0f)) ? 0 : 1;
        count += closest_hit(*embree, inside, glm::normalize(towards), 100.0f).has_value() ? 0 : 1;
    }
    return count;
}

TEST(EmbreeScene, NoRayLeaksThroughTheSharedEdgesOfAClosedBoxOrSphere) {
    Scene box = scene_with_material();
    add_box(box, {-1.3f, -0.7f, -2.1f}, {0.9f, 1.1f, 1.7f});
    Scene sphere = scene_with_material();
    add_sphere(sphere, {0.1f, 0.2f, 0.3f}, 1.0f, 64);
    for (const Scene& scene : {box, sphere}) {
        EXPECT_EQ(leaks(scene, Aim::edge, 100000), 0);
        EXPECT_EQ(leaks(scene, Aim::inside, 100000), 0);
        // Where several triangles meet in a point, rounding can leave that very point to none of them, even with
        // ROBUST.
        EXPECT_LT(leaks(scene, Aim::corner, 100000), 2000);
    }
}

TEST(EmbreeScene, ASceneWithoutTrianglesIsNeverHit) {
    const Scene scene = scene_with_material();
    for (const EmbreeUse use : {EmbreeUse::reference, EmbreeUse::benchmark}) {
        const auto embree = built(scene, use);
        EXPECT_FALSE(closest_hit(*embree, vec3(0.0f), up, 1e9f).has_value());
        EXPECT_FALSE(occluded(*embree, {{0, 0, 0}, {0, 1, 0}}, up));
        const SurfaceBuffer surfaces = seen(scene, *embree, Camera{}, {17, 9});
        for (const std::uint32_t triangle : surfaces.triangle) EXPECT_EQ(triangle, no_triangle);
        const std::vector<Light> lights{point_light({0, 1, 0})};
        for (const EmbreeVariant variant :
             {EmbreeVariant::single, EmbreeVariant::packet_8, EmbreeVariant::packet_16, EmbreeVariant::stream})
            EXPECT_EQ(count_blocked(*embree, variant, surfaces, lights, 2).rays, 0u);
    }
}

TEST(EmbreeScene, OutlivesTheSceneItWasBuiltFrom) {
    std::shared_ptr<const EmbreeScene> embree;
    {
        Scene scene = scene_with_material();
        add_box(scene, {-1, 1, -1}, {1, 2, 1});
        embree = built(scene);
        for (vec3& position : scene.positions) position = vec3(1e6f);
    }
    EXPECT_TRUE(occluded(*embree, {{0, 0, 0}, {0, 4, 0}}, up));
}

TEST(EmbreeScene, DegenerateTrianglesAreHarmless) {
    Scene scene = scene_with_material();
    add_triangle(scene, {0, 1, 0}, {0, 1, 0}, {0, 1, 0});
    add_triangle(scene, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0});
    const auto embree = built(scene);
    EXPECT_FALSE(occluded(*embree, {{0.1f, 0, 0.1f}, {0.1f, 4, 0.1f}}, up));
}

TEST(EmbreeScene, StopsBuildingWhenCancelled) {
    Scene scene = scene_with_material();
    add_box(scene, {-1, 1, -1}, {1, 2, 1});
    Progress progress;
    progress.cancel();
    EXPECT_THROW(build_embree_scene(scene, EmbreeUse::reference, 2, progress), Cancelled);
}

TEST(EmbreeScene, RaysPassThroughTheHolesOfAMaskedTexture) {
    const Scene scene = scene_with_square(AlphaMode::mask);
    for (const EmbreeUse use : {EmbreeUse::reference, EmbreeUse::benchmark}) {
        const auto embree = built(scene, use);
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const vec3 below = random_point({{0.02f, 0, 0.02f}, {0.98f, 0, 0.98f}}, i);
            if (std::fabs(below.x - 0.5f) < 0.02f) continue;
            const bool solid = below.x < 0.5f;
            ASSERT_EQ(occluded(*embree, {below, below + 2.0f * up}, up), solid) << below.x;
            ASSERT_EQ(closest_hit(*embree, below, up, 10.0f).has_value(), solid) << below.x;
        }
    }
}

TEST(EmbreeScene, AlphaMattersOnlyWhereTheMaterialIsMasked) {
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::blend}) {
        const auto embree = built(scene_with_square(mode));
        EXPECT_TRUE(occluded(*embree, {{0.75f, 0, 0.5f}, {0.75f, 2, 0.5f}}, up));
    }
}

TEST(EmbreeScene, TheTextureTransformMovesTheHoles) {
    Scene scene = scene_with_square(AlphaMode::mask);
    scene.materials[0].base_color_texture->offset = {0.5f, 0.0f};
    const auto embree = built(scene);
    EXPECT_FALSE(occluded(*embree, {{0.25f, 0, 0.5f}, {0.25f, 2, 0.5f}}, up));
    EXPECT_TRUE(occluded(*embree, {{0.75f, 0, 0.5f}, {0.75f, 2, 0.5f}}, up));
}

TEST(EmbreeScene, AMaskedMaterialWithoutTextureIsAllOrNothing) {
    for (const float alpha : {0.4f, 0.6f}) {
        Scene scene = scene_with_square(AlphaMode::mask);
        scene.materials[0].base_color_texture.reset();
        scene.materials[0].alpha = alpha;
        EXPECT_EQ(occluded(*built(scene), {{0.25f, 0, 0.5f}, {0.25f, 2, 0.5f}}, up), alpha > 0.5f);
    }
}

TEST(EmbreeScene, OpaqueAndMaskedTrianglesKeepTheirSceneIndices) {
    Scene scene = scene_with_square(AlphaMode::mask);
    scene.materials.emplace_back();
    add_quad(scene, {0, 3, 0}, {1, 0, 0}, {0, 0, 1}, 1);
    const auto embree = built(scene);
    const auto solid = closest_hit(*embree, {0.25f, 0, 0.5f}, up, 10.0f);
    const auto through = closest_hit(*embree, {0.75f, 0, 0.5f}, up, 10.0f);
    ASSERT_TRUE(solid && through);
    EXPECT_EQ(solid->triangle, 1u);
    EXPECT_EQ(through->triangle, 2u);
    EXPECT_NEAR(through->distance_m, 3.0f, 1e-4f);
}

}  // namespace
}  // namespace sightlines::test
