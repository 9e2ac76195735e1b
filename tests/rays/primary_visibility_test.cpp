#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/rays/test_scenes.h"

namespace sightlines::test {
namespace {

/// Where GLM's own camera matrices put a point, in pixels.
vec2 projected(const Camera& camera, ImageSize size, vec3 point) {
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    const float half = 0.5f * camera.orthographic_height_m;
    const mat4 clip_from_view =
        camera.kind == CameraKind::perspective
            ? glm::perspective(glm::radians(camera.vertical_field_of_view_deg), aspect, 0.01f, 1000.0f)
            : glm::ortho(-half * aspect, half * aspect, -half, half, 0.01f, 1000.0f);
    const vec4 clip = clip_from_view * glm::lookAt(camera.position, camera.target, camera.up) * vec4(point, 1.0f);
    return {(0.5f + 0.5f * clip.x / clip.w) * static_cast<float>(size.width),
            (0.5f - 0.5f * clip.y / clip.w) * static_cast<float>(size.height)};
}

Camera slanted_camera(CameraKind kind) {
    Camera camera = camera_at({1.0f, 2.5f, 4.0f}, {0.2f, 0.3f, -0.4f});
    camera.kind = kind;
    camera.up = {0.1f, 1.0f, 0.2f};
    camera.vertical_field_of_view_deg = 47.0f;
    camera.orthographic_height_m = 3.0f;
    return camera;
}

TEST(CameraRay, GoesThroughThePixelThatItWasMadeFor) {
    const ImageSize size{320, 200};
    for (const CameraKind kind : {CameraKind::perspective, CameraKind::orthographic}) {
        const Camera camera = slanted_camera(kind);
        for (const vec2 pixel : {vec2(0, 0), vec2(320, 0), vec2(0, 200), vec2(160, 100), vec2(17.5f, 180.25f)}) {
            const Segment ray = camera_ray(camera, size, pixel, 10.0f);
            const vec2 back = projected(camera, size, glm::mix(ray.origin, ray.target, 0.6f));
            EXPECT_NEAR(back.x, pixel.x, 0.01f);
            EXPECT_NEAR(back.y, pixel.y, 0.01f);
            EXPECT_NEAR(glm::distance(ray.origin, ray.target), 10.0f, 1e-4f);
        }
    }
}

TEST(CameraRay, OrthographicRaysAreParallelAndAsFarApartAsThePictureIsHigh) {
    const Camera camera = slanted_camera(CameraKind::orthographic);
    const Segment top = camera_ray(camera, {320, 200}, {160, 0}, 1.0f);
    const Segment bottom = camera_ray(camera, {320, 200}, {160, 200}, 1.0f);
    EXPECT_LT(glm::distance(top.target - top.origin, bottom.target - bottom.origin), 1e-5f);
    EXPECT_NEAR(glm::distance(top.origin, bottom.origin), 3.0f, 1e-5f);
}

TEST(CameraRay, LooksStraightDownWithoutLosingItsWay) {
    Camera camera = camera_at({0, 5, 0}, {0, 0, 0});
    const Segment middle = camera_ray(camera, {100, 100}, {50, 50}, 5.0f);
    EXPECT_LT(glm::length(middle.target), 1e-5f);
    const Segment corner = camera_ray(camera, {100, 100}, {0, 0}, 5.0f);
    EXPECT_TRUE(std::isfinite(corner.target.x));
    EXPECT_GT(glm::distance(corner.target, middle.target), 0.5f);
}

TEST(VisibleSurfaces, LieWhereThePixelsRayMeetsThePlane) {
    Scene scene = scene_with_material();
    add_quad(scene, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
    const auto embree = built(scene);
    const ImageSize size{37, 23};  // not a multiple of any tile
    const Camera camera = camera_at({0, 3, 5}, {0, 0, 0});
    const SurfaceBuffer surfaces = seen(scene, *embree, camera, size);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y * size.width + x);
            const vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const Segment ray = camera_ray(camera, size, middle, 1.0f);
            const vec3 direction = ray.target - ray.origin;
            const vec3 expected = ray.origin - ray.origin.y / direction.y * direction;
            ASSERT_NE(surfaces.triangle[pixel], no_triangle);
            ASSERT_LT(glm::distance(surfaces.position[pixel], expected), 1e-5f * std::max(1.0f, glm::length(expected)));
            ASSERT_EQ(surfaces.normal[pixel], vec3(0, 1, 0));
        }
    }
}

TEST(VisibleSurfaces, NormalsFaceTheCameraFromOutsideAndFromInside) {
    Scene scene = scene_with_material();
    add_sphere(scene, vec3(0.0f), 1.0f, 48);
    const auto embree = built(scene);
    for (const vec3 eye : {vec3(0, 0.5f, 3), vec3(0.1f, 0.2f, 0.1f)}) {
        const SurfaceBuffer surfaces = seen(scene, *embree, camera_at(eye, {0.05f, 0, -1}), {64, 64});
        int hits = 0;
        for (std::size_t p = 0; p < surfaces.size.pixels(); ++p) {
            if (surfaces.triangle[p] == no_triangle) continue;
            ++hits;
            ASSERT_GT(glm::dot(surfaces.normal[p], eye - surfaces.position[p]), 0.0f);
            ASSERT_GE(glm::dot(surfaces.normal[p], surfaces.shading_normal[p]), 0.0f);
            ASSERT_NEAR(glm::length(surfaces.normal[p]), 1.0f, 1e-5f);
            ASSERT_NEAR(glm::length(surfaces.shading_normal[p]), 1.0f, 1e-5f);
            // The smooth normal is the sphere's own.
            ASSERT_GT(std::fabs(glm::dot(surfaces.shading_normal[p], glm::normalize(surfaces.position[p]))), 0.999f);
        }
        EXPECT_GT(hits, 500);
    }
}

TEST(VisibleSurfaces, AreZeroOnTheBackground) {
    Scene scene = scene_with_material();
    add_sphere(scene, vec3(0.0f), 1.0f, 16);
    const SurfaceBuffer surfaces = seen(scene, *built(scene), camera_at({0, 0, 6}, vec3(0.0f)), {40, 30});
    EXPECT_EQ(surfaces.triangle[0], no_triangle);
    EXPECT_NE(surfaces.triangle[15 * 40 + 20], no_triangle);
    for (std::size_t p = 0; p < surfaces.size.pixels(); ++p) {
        if (surfaces.triangle[p] != no_triangle) continue;
        ASSERT_EQ(surfaces.position[p], vec3(0.0f));
        ASSERT_EQ(surfaces.normal[p], vec3(0.0f));
        ASSERT_EQ(surfaces.shading_normal[p], vec3(0.0f));
        ASSERT_EQ(surfaces.albedo[p], vec3(0.0f));
        ASSERT_EQ(surfaces.emission[p], vec3(0.0f));
    }
}

TEST(VisibleSurfaces, ShowTheNearestSurfaceToAnOrthographicCamera) {
    Scene scene = scene_with_material();
    add_quad(scene, {-1, -1, 0}, {1, 0, 0}, {0, 2, 0});  // left half, at z = 0
    add_quad(scene, {-1, -1, -3}, {2, 0, 0}, {0, 2, 0});
    Camera camera = camera_at({0, 0, 5}, {0, 0, 0});
    camera.kind = CameraKind::orthographic;
    camera.orthographic_height_m = 2.0f;
    const SurfaceBuffer surfaces = seen(scene, *built(scene), camera, {16, 16});
    for (std::size_t p = 0; p < surfaces.size.pixels(); ++p) {
        const std::size_t x = p % 16;
        ASSERT_NEAR(surfaces.position[p].z, x < 8 ? 0.0f : -3.0f, 1e-6f);
        ASSERT_NEAR(surfaces.position[p].x, (static_cast<float>(x) + 0.5f) / 8.0f - 1.0f, 1e-5f);
    }
}

TEST(VisibleSurfaces, CarryTheMaterialsColoursTexturesAndEmission) {
    Material material;
    material.base_color = {0.5f, 0.4f, 0.2f};
    material.metallic = 1.0f;
    material.emissive = {3.0f, 2.0f, 1.0f};
    material.base_color_texture = TextureLookup{};
    Scene scene = scene_with_material(material);
    Texture texture;
    texture.texels = ImageRgba8({2, 2}, glm::u8vec4(255));
    texture.texels.at(0, 0) = texture.texels.at(0, 1) = glm::u8vec4(0, 0, 0, 255);
    texture.wrap_u = texture.wrap_v = Wrap::clamp;
    scene.textures.push_back(texture);
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    Camera camera = camera_at({0, 0, 5}, {0, 0, 0});
    camera.kind = CameraKind::orthographic;
    camera.orthographic_height_m = 2.0f;
    const SurfaceBuffer surfaces = seen(scene, *built(scene), camera, {16, 16});
    const std::size_t row = 8 * 16;
    EXPECT_EQ(surfaces.albedo[row + 0], vec3(0.0f));  // the dark half of the texture
    const vec3 bright = surfaces.albedo[row + 15];
    EXPECT_NEAR(bright.r, 0.25f, 1e-5f);  // a metal keeps half of its colour
    EXPECT_NEAR(bright.g, 0.20f, 1e-5f);
    EXPECT_NEAR(bright.b, 0.10f, 1e-5f);
    EXPECT_EQ(surfaces.emission[row + 0], vec3(3.0f, 2.0f, 1.0f));
}

TEST(VisibleSurfaces, DoNotDependOnTheNumberOfThreads) {
    const Scene scene = triangle_soup(500);
    Progress progress;
    const Camera camera = camera_at({0, 0.5f, 3}, vec3(0.0f));
    const auto by_one = build_embree_scene(scene, EmbreeUse::reference, 1, progress);
    const auto by_two = build_embree_scene(scene, EmbreeUse::reference, 2, progress);
    const SurfaceBuffer one = seen(scene, *by_one, camera, {101, 67}, 1);
    const SurfaceBuffer two = seen(scene, *by_two, camera, {101, 67}, 2);
    EXPECT_EQ(one.triangle, two.triangle);
    EXPECT_EQ(one.position, two.position);
    EXPECT_EQ(one.normal, two.normal);
    EXPECT_EQ(one.shading_normal, two.shading_normal);
    EXPECT_EQ(one.albedo, two.albedo);
}

TEST(VisibleSurfaces, StopWhenCancelled) {
    const Scene scene = triangle_soup(10);
    const auto embree = built(scene);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(visible_surfaces(scene, *embree, Camera{}, {64, 64}, 2, progress), Cancelled);
}

}  // namespace
}  // namespace sightlines::test
