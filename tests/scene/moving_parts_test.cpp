#include "techniques/scene/moving_parts.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "techniques/scene/builtin_mesh.h"

namespace sightlines {
namespace {

/// A floor that stands still, two boxes of one mesh that move, a sheet that deforms.
Scene mixed_scene() {
    Scene scene;
    scene.materials = {diffuse("a", vec3(0.5f)), diffuse("b", vec3(0.2f))};
    Mesh floor, box, sheet;
    add_quad(floor, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 0);
    add_box(box, {vec3(-0.5f), vec3(0.5f)}, 1);
    add_quad(sheet, {0, 3, 0}, {0, 0, 1}, {1, 0, 0}, 0);
    add_part(scene, box, "first box", 1, placed({2, 1, 0}, 30.0f));
    add_part(scene, floor, "floor", 0, mat4(1.0f));
    add_part(scene, sheet, "sheet", 2, mat4(1.0f));
    add_part(scene, box, "second box", 1, placed({-2, 1, 3}, 120.0f));
    scene.parts[0].moves = scene.parts[3].moves = true;
    scene.parts[2].deforms = true;
    scene.bounds = scene.motion_bounds = tight_bounds(scene);
    return scene;
}

TEST(MovingParts, EveryTriangleIsEitherFixedOrChanging) {
    const Scene scene = mixed_scene();
    const Scene fixed = fixed_scene(scene), changing = changing_scene(scene);
    EXPECT_EQ(fixed.triangles.size(), 2u);
    EXPECT_EQ(changing.triangles.size(), 12u + 2u + 12u);
    EXPECT_EQ(fixed.triangles.size() + changing.triangles.size(), scene.triangles.size());
    EXPECT_EQ(fixed.bounds.highest.y, 0.0f);
    EXPECT_EQ(changing.motion_bounds.highest, scene.bounds.highest);
    EXPECT_EQ(changing.parts.size(), 3u);
    const uvec3 first = changing.triangles.at(0), original = scene.triangles.at(0);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(changing.positions[first[k]], scene.positions[original[k]]);
    EXPECT_EQ(changing.triangle_materials.at(0), 1u);
    EXPECT_TRUE(anything_moves(scene));
    EXPECT_FALSE(anything_moves(fixed));
}

TEST(MovingParts, TrianglesAreChosenByPart) {
    const Scene scene = mixed_scene();
    const auto all = triangles_of(scene, PartChoice::all), fixed = triangles_of(scene, PartChoice::fixed),
               changing = triangles_of(scene, PartChoice::changing);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        EXPECT_EQ(all[t], 1);
        EXPECT_EQ(fixed[t], t == 12 || t == 13);
        EXPECT_EQ(changing[t], !fixed[t]);
    }
}

TEST(MovingParts, BoxesHoldWhatChangesHoweverFewThereMayBe) {
    const Scene scene = mixed_scene();
    EXPECT_EQ(changing_boxes(scene, 10).size(), 3u);
    const std::vector<std::uint8_t> changing = triangles_of(scene, PartChoice::changing);
    for (const std::size_t most : {1u, 2u, 3u}) {
        const std::vector<Box3> boxes = changing_boxes(scene, most);
        EXPECT_EQ(boxes.size(), most);
        for (std::size_t t = 0; t < scene.triangles.size(); ++t)
            for (int k = 0; changing[t] != 0 && k < 3; ++k) {
                const vec3 corner = scene.positions[scene.triangles[t][k]];
                EXPECT_TRUE(std::ranges::any_of(boxes, [&](const Box3& box) {
                    return glm::all(glm::lessThanEqual(box.lowest, corner)) &&
                           glm::all(glm::lessThanEqual(corner, box.highest));
                }));
            }
    }
    EXPECT_EQ(changing_boxes(scene, 3)[0].lowest.y, 0.5f);
    Scene still = mixed_scene();
    for (Part& part : still.parts) part.moves = part.deforms = false;
    EXPECT_TRUE(changing_boxes(still, 3).empty());
}

TEST(MovingParts, InstancesOfOneMeshAreOneObject) {
    const Scene scene = mixed_scene();
    const std::vector<RigidObject> objects = rigid_objects(scene);
    ASSERT_EQ(objects.size(), 1u);
    EXPECT_EQ(objects[0].mesh, 1u);
    EXPECT_EQ(objects[0].parts, (std::vector<std::uint32_t>{0, 3}));
}

TEST(MovingParts, AnObjectPlacedByItsMatrixIsWhereTheSceneHasIt) {
    const Scene scene = mixed_scene();
    const RigidObject object = rigid_objects(scene).at(0);
    const Scene shape = object_scene(scene, object);
    EXPECT_NEAR(shape.bounds.lowest.x, -0.5f, 1e-5f);
    EXPECT_NEAR(shape.bounds.highest.y, 0.5f, 1e-5f);
    ASSERT_EQ(shape.triangles.size(), 12u);
    for (const std::uint32_t number : object.parts) {
        const Part& part = scene.parts[number];
        for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
            for (int k = 0; k < 3; ++k) {
                const vec3 placed_at = vec3(part.world_from_part * vec4(shape.positions[shape.triangles[t][k]], 1.0f));
                const vec3 there = scene.positions[scene.triangles[part.first_triangle + t][k]];
                EXPECT_LT(glm::distance(placed_at, there), 1e-5f);
            }
        }
    }
}

TEST(MovingParts, ASceneWithoutChangesIsAllFixed) {
    Scene scene = mixed_scene();
    for (Part& part : scene.parts) part.moves = part.deforms = false;
    EXPECT_EQ(fixed_scene(scene).triangles.size(), scene.triangles.size());
    EXPECT_TRUE(changing_scene(scene).triangles.empty());
    EXPECT_TRUE(rigid_objects(scene).empty());
}

}  // namespace
}  // namespace sightlines
