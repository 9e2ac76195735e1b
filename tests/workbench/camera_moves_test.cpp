#include "app/workbench/camera_moves.h"

#include <gtest/gtest.h>

#include "app/session.h"
#include "techniques/rays/embree_scene.h"

namespace sightlines {
namespace {

constexpr ImageSize picture{640, 360};

Camera some_camera(CameraKind kind = CameraKind::perspective) {
    Camera camera;
    camera.kind = kind;
    camera.position = {3.0f, 2.0f, 7.0f};
    camera.target = {0.5f, 1.0f, -1.0f};
    camera.orthographic_height_m = 6.0f;
    return camera;
}

void expect_near(vec3 a, vec3 b, float tolerance = 1.0e-4f) { EXPECT_LT(glm::distance(a, b), tolerance); }

TEST(CameraMoves, OrbitKeepsTargetAndDistance) {
    const Camera before = some_camera(), after = orbited(before, {37.0f, -12.0f});
    EXPECT_EQ(after.target, before.target);
    EXPECT_NEAR(glm::distance(after.position, after.target), glm::distance(before.position, before.target), 1.0e-4f);
    EXPECT_GT(glm::distance(after.position, before.position), 0.5f);
}

TEST(CameraMoves, OrbitAndItsOppositeCancel) {
    const Camera before = some_camera();
    expect_near(orbited(orbited(before, {25.0f, 10.0f}), {-25.0f, -10.0f}).position, before.position);
}

TEST(CameraMoves, OrbitAsFarAsItGoesStaysUpright) {
    for (const float drag : {-1000.0f, 1000.0f}) {
        const Camera camera = orbited(some_camera(), {0.0f, drag});
        EXPECT_TRUE(has_picture(camera));
        EXPECT_GT(camera_frame(camera, picture).up.y, 0.0f);
    }
}

TEST(CameraMoves, LookKeepsThePosition) {
    const Camera before = some_camera(), after = looked(before, {20.0f, 5.0f});
    EXPECT_EQ(after.position, before.position);
    // To the right means towards the picture's right edge.
    EXPECT_GT(glm::dot(after.target - before.target, camera_frame(before, picture).right), 0.0f);
    EXPECT_LT(after.target.y, before.target.y);
}

TEST(CameraMoves, PanMovesTheTargetWithTheMouse) {
    for (const CameraKind kind : {CameraKind::perspective, CameraKind::orthographic}) {
        const Camera before = some_camera(kind), after = panned(before, {40.0f, -25.0f}, picture);
        const auto from = projected(before, picture, before.target), to = projected(after, picture, before.target);
        ASSERT_TRUE(from && to);
        EXPECT_NEAR(to->x - from->x, 40.0f, 0.1f);
        EXPECT_NEAR(to->y - from->y, -25.0f, 0.1f);
    }
}

TEST(CameraMoves, DollyComesNearerByItsFactorAndNeverReachesTheTarget) {
    const Camera before = some_camera();
    EXPECT_NEAR(glm::distance(dollied(before, 2.0f).position, before.target),
                0.5f * glm::distance(before.position, before.target), 1.0e-4f);
    Camera camera = before;
    for (int i = 0; i < 200; ++i) camera = dollied(camera, 2.0f);
    EXPECT_TRUE(has_picture(camera));
}

TEST(CameraMoves, FlyMovesPositionAndTargetAlike) {
    const Camera before = some_camera(), after = flown(before, {0.0f, 0.0f, 2.0f});
    expect_near(after.position - before.position, after.target - before.target);
    EXPECT_NEAR(glm::dot(after.position - before.position, camera_frame(before, picture).forward), 2.0f, 1.0e-4f);
}

TEST(CameraMoves, ProjectionIsTheInverseOfTheCameraRay) {
    for (const CameraKind kind : {CameraKind::perspective, CameraKind::orthographic}) {
        const Camera camera = some_camera(kind);
        for (const vec2 pixel : {vec2(0.5f), vec2(320.0f, 180.0f), vec2(600.25f, 20.75f)}) {
            const Segment ray = camera_ray(camera, picture, pixel, 4.0f);
            const auto back = projected(camera, picture, ray.target);
            ASSERT_TRUE(back);
            EXPECT_LT(glm::distance(*back, pixel), 0.02f);
        }
    }
    const Camera camera = some_camera();
    EXPECT_FALSE(projected(camera, picture, 2.0f * camera.position - camera.target));
}

TEST(CameraMoves, DraggedPointFollowsTheMouseAtItsOwnDepth) {
    const Camera camera = some_camera();
    const vec3 point(0.0f, 0.5f, 0.0f);
    const vec3 moved = dragged(camera, picture, point, {30.0f, 12.0f});
    const auto from = projected(camera, picture, point), to = projected(camera, picture, moved);
    ASSERT_TRUE(from && to);
    EXPECT_LT(glm::distance(*to - *from, vec2(30.0f, 12.0f)), 0.05f);
    EXPECT_NEAR(glm::dot(moved - point, camera_frame(camera, picture).forward), 0.0f, 1.0e-4f);
}

}  // namespace
}  // namespace sightlines
