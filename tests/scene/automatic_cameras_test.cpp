// Rooms, courts and objects whose answer is plain, and the scenes that a user will open.
#include "techniques/scene/automatic_cameras.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "techniques/base/progress.h"
#include "techniques/scene/gltf.h"

namespace sightlines {
namespace {

enum class Faces { inward, outward };

/// Four corners that run counter-clockwise as seen from the side that is the front.
void add_quad(Scene& scene, const std::array<vec3, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const vec3 corner : corners) {
        scene.positions.push_back(corner);
        scene.bounds.add(corner);
    }
    scene.triangles.push_back(uvec3(first, first + 1, first + 2));
    scene.triangles.push_back(uvec3(first, first + 2, first + 3));
}

void add_box(Scene& scene, const Box3& box, Faces faces, bool roof = true) {
    const vec3 l = box.lowest, h = box.highest;
    const std::array<std::array<vec3, 4>, 6> inward = {{
        {{{l.x, l.y, l.z}, {l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, l.y, l.z}}},  // floor
        {{{l.x, l.y, l.z}, {l.x, h.y, l.z}, {l.x, h.y, h.z}, {l.x, l.y, h.z}}},
        {{{h.x, l.y, l.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}}},
        {{{l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z}}},
        {{{l.x, l.y, h.z}, {l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z}}},
        {{{l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z}}},  // roof
    }};
    for (std::size_t side = 0; side < (roof ? 6u : 5u); ++side) {
        std::array<vec3, 4> corners = inward[side];
        if (faces == Faces::outward) std::ranges::reverse(corners);
        add_quad(scene, corners);
    }
}

Scene box_scene(vec3 size, Faces faces, bool roof = true) {
    Scene scene;
    const vec3 lowest(3.0f, -1.0f, 20.0f);
    add_box(scene, {lowest, lowest + size}, faces, roof);
    return scene;
}

/// About the vertical axis through the origin.
void turn(Scene& scene, float angle_deg) {
    const float c = std::cos(glm::radians(angle_deg)), s = std::sin(glm::radians(angle_deg));
    scene.bounds = {};
    for (vec3& p : scene.positions) {
        p = {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
        scene.bounds.add(p);
    }
}

bool holds(const Box3& box, vec3 point) {
    return glm::all(glm::greaterThan(point, box.lowest)) && glm::all(glm::lessThan(point, box.highest));
}

vec3 view_of(const Camera& camera) { return glm::normalize(camera.target - camera.position); }

void expect_only_outside(const Scene& scene) {
    const std::vector<Camera> cameras = automatic_cameras(scene);
    ASSERT_EQ(cameras.size(), 1u);
    Camera framing = framing_camera(scene.bounds);
    framing.name = "outside";
    EXPECT_EQ(cameras[0], framing);
}

TEST(AutomaticCameras, StandAtTheEndOfARoomAndLookAlongIt) {
    for (const vec3 size :
         {vec3(10, 4, 6), vec3(6, 4, 10), vec3(40, 3, 5), vec3(0.4f, 0.5f, 0.9f), vec3(90, 90, 300)}) {
        const Scene scene = box_scene(size, Faces::inward);
        const std::vector<Camera> cameras = automatic_cameras(scene);
        ASSERT_EQ(cameras.size(), 2u);
        EXPECT_EQ(cameras[0].name, "inside");
        EXPECT_EQ(cameras[1].name, "outside");
        EXPECT_TRUE(holds(scene.bounds, cameras[0].position));
        EXPECT_FLOAT_EQ(cameras[0].vertical_field_of_view_deg, 60.0f);
        EXPECT_NEAR(cameras[0].position.y, -1.0f + 0.2f * size.y, 1e-3f * size.y);
        const int axis = size.x > size.z ? 0 : 2;
        const vec3 view = view_of(cameras[0]);
        EXPECT_GT(std::abs(view[axis]), 0.99f);
        EXPECT_GT(view.y, 0.0f);
        const float wall = view[axis] > 0.0f ? scene.bounds.lowest[axis] : scene.bounds.highest[axis];
        EXPECT_NEAR(std::abs(cameras[0].position[axis] - wall), 0.1f * size[axis], 1e-3f * size[axis]);
    }
}

TEST(AutomaticCameras, FollowARoomThatIsBuiltAskew) {
    Scene scene = box_scene({20, 5, 5}, Faces::inward);
    turn(scene, 30.0f);
    const std::vector<Camera> cameras = automatic_cameras(scene);
    ASSERT_EQ(cameras.size(), 2u);
    const vec3 along(std::cos(glm::radians(30.0f)), 0.0f, -std::sin(glm::radians(30.0f)));
    EXPECT_GT(std::abs(glm::dot(view_of(cameras[0]), along)), 0.98f);
}

TEST(AutomaticCameras, SeeAClosedObjectFromOutside) { expect_only_outside(box_scene({10, 4, 6}, Faces::outward)); }

TEST(AutomaticCameras, TakeACourtThatIsOpenAboveForARoom) {
    EXPECT_EQ(automatic_cameras(box_scene({10, 4, 6}, Faces::inward, false)).size(), 2u);
}

TEST(AutomaticCameras, SeeOpenGroundFromOutside) {
    Scene scene = box_scene({100, 1, 100}, Faces::inward, false);
    scene.triangles.resize(2);  // the floor alone
    expect_only_outside(scene);
    for (int i = 0; i < 5; ++i) {  // some houses on it
        const vec3 corner(10.0f + 18.0f * static_cast<float>(i), -1.0f, 30.0f + 13.0f * static_cast<float>(i * i % 5));
        add_box(scene, {corner, corner + vec3(5, 6, 5)}, Faces::outward);
    }
    expect_only_outside(scene);
}

TEST(AutomaticCameras, AreNeverInsideAPillar) {
    for (int arrangement = 0; arrangement < 20; ++arrangement) {
        Scene scene = box_scene({24, 6, 12}, Faces::inward);
        std::vector<Box3> pillars;
        for (int i = 0; i < 12; ++i) {
            const auto shift = static_cast<float>((arrangement * 7 + i * 5) % 11) / 11.0f;
            const vec3 corner(4.0f + 2.0f * static_cast<float>(i) * 0.9f + shift, -1.0f, 20.5f + 9.5f * shift);
            pillars.push_back({corner, corner + vec3(1, 6, 1)});
            add_box(scene, pillars.back(), Faces::outward);
        }
        for (const Camera& camera : automatic_cameras(scene))
            for (const Box3& pillar : pillars) EXPECT_FALSE(holds(pillar, camera.position)) << arrangement;
    }
}

TEST(AutomaticCameras, LookOverATableInTheMiddle) {
    Scene scene = box_scene({12, 4, 7}, Faces::inward);
    const vec3 foot(9.0f, -1.0f, 23.5f);
    const Box3 table{foot - vec3(0.3f, 0.0f, 0.3f), foot + vec3(0.3f, 1.6f, 0.3f)};
    add_box(scene, table, Faces::outward);
    const std::vector<Camera> cameras = automatic_cameras(scene);
    ASSERT_EQ(cameras.size(), 2u);
    EXPECT_NEAR(cameras[0].position.y, -0.2f, 0.01f);
    EXPECT_FALSE(holds(table, cameras[0].position));
}

TEST(AutomaticCameras, StepOutFromUnderAGallery) {
    Scene scene = box_scene({30, 10, 8}, Faces::inward);  // from (3, -1, 20)
    for (const float x : {3.0f, 28.5f}) add_box(scene, {{x, 1.6f, 20.0f}, {x + 4.5f, 2.0f, 28.0f}}, Faces::outward);
    const std::vector<Camera> cameras = automatic_cameras(scene);
    ASSERT_EQ(cameras.size(), 2u);
    const float x = cameras[0].position.x;
    EXPECT_NEAR(std::min(x - 3.0f, 33.0f - x), 4.35f, 0.05f) << "a tenth of 30 m, and a twentieth of the 27 m ahead";
}

TEST(AutomaticCameras, AreOneCameraForAnEmptyOrFlatScene) {
    expect_only_outside(Scene{});
    Scene flat = box_scene({4, 0, 4}, Faces::inward);
    expect_only_outside(flat);
    flat.triangles.assign(1, uvec3(0));  // one that has no extent
    expect_only_outside(flat);
}

TEST(AutomaticCameras, AreTheSameEveryTime) {
    const Scene scene = box_scene({10, 4, 10}, Faces::inward, false);
    EXPECT_EQ(automatic_cameras(scene), automatic_cameras(scene));
}

struct SharedScene {
    const char* file;
    bool room;
};

void PrintTo(const SharedScene& row, std::ostream* stream) { *stream << row.file; }

class AutomaticCamerasOfFiles : public testing::TestWithParam<SharedScene> {};

TEST_P(AutomaticCamerasOfFiles, TellRoomsFromObjects) {
    const auto file = std::filesystem::path(SIGHTLINES_SHARED_FOLDER) / "scenes" / GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
    Progress progress;
    const SceneModel model = load_gltf(file, progress);
    const Scene scene = model.at(0.0);
    ASSERT_EQ(scene.cameras.size(), GetParam().room ? 2u : 1u);
    EXPECT_EQ(scene.cameras[0].name, GetParam().room ? "inside" : "outside");
    if (GetParam().room) {
        EXPECT_TRUE(holds(scene.bounds, scene.cameras[0].position));
        EXPECT_GT(std::abs(view_of(scene.cameras[0]).x), 0.99f) << "both naves run along x";
    }
    EXPECT_EQ(model.at(0.4).cameras, scene.cameras);
}

INSTANTIATE_TEST_SUITE_P(Shared, AutomaticCamerasOfFiles,
                         testing::Values(SharedScene{"sponza_crytek.glb", true}, SharedScene{"sibenik.glb", true},
                                         SharedScene{"flight_helmet_notex.glb", false}, SharedScene{"fox.glb", false},
                                         SharedScene{"rigid_anim_bunny.glb", false},
                                         SharedScene{"cesium_man.glb", false}),
                         [](const testing::TestParamInfo<SharedScene>& row) {
                             std::string name = row.param.file;
                             std::ranges::replace(name, '.', '_');
                             return name;
                         });

}  // namespace
}  // namespace sightlines
