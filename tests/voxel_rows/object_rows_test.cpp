// Wang 2017, Algorithm 5: what is built for objects that move rigidly, when, and what the moments share.
#include "techniques/voxel_rows/object_rows.h"

#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "tests/voxel_rows/moving_boxes.h"

namespace sightlines::voxel_rows {
namespace {

using testing::boxes_over_a_floor;
using testing::scattered_places;
using testing::small_parameters;

Structure built(const Scene& scene, ParameterValues parameters, std::any kept = {}) {
    BuildRequest request;
    request.scene = &scene;
    request.parameters = std::move(parameters);
    request.kept = std::move(kept);
    Progress progress;
    return technique().build(request, progress);
}

double statistic(const Structure& structure, std::string_view name) {
    for (const Statistic& value : technique().statistics(structure).values)
        if (value.name == name) return value.value;
    ADD_FAILURE() << "no " << name;
    return 0.0;
}

TEST(ObjectRows, InstancesOfOneMeshShareOneArray) {
    const Structure one = built(boxes_over_a_floor(scattered_places(1, 1)), small_parameters());
    const Structure three = built(boxes_over_a_floor(scattered_places(3, 1)), small_parameters());
    EXPECT_EQ(objects(three).types.size(), 1u);
    EXPECT_EQ(objects(three).placed.size(), 3u);
    EXPECT_EQ(statistic(three, "objects that move"), 3.0);
    EXPECT_EQ(technique().statistics(three).structure_bytes, technique().statistics(one).structure_bytes);
    EXPECT_EQ(technique().statistics(three).structure_bytes - row_array(three).words.bytes(),
              46u * 46u * 32u * 32u * sizeof(std::uint32_t));
}

TEST(ObjectRows, AnArrayHoldsItsObjectAtTheObjectsResolution) {
    ParameterValues parameters = small_parameters();
    parameters["object_resolution"] = 64.0;
    const Structure structure = built(boxes_over_a_floor(scattered_places(2, 1)), parameters);
    const RowGrid& grid = objects(structure).types[0].grid;
    EXPECT_EQ(grid.resolution, 64);
    EXPECT_EQ(row_array(structure).grid.resolution, 48);
    const float half_voxel = 0.5f * 1.8f / 64.0f;
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(grid.bounds.highest[axis], testing::moving_box.highest[axis] + half_voxel, 1e-4f);
}

TEST(ObjectRows, AnotherMomentVoxelisesNothingAgain) {
    const Scene before = boxes_over_a_floor(scattered_places(2, 1)), after = boxes_over_a_floor(scattered_places(2, 2));
    const Structure first = built(before, small_parameters());
    const Structure second = built(after, small_parameters(), technique().kept(first));
    EXPECT_EQ(row_array(second).words.words.data(), row_array(first).words.words.data());
    EXPECT_EQ(objects(second).types.data(), objects(first).types.data());
    EXPECT_EQ(objects(second).placed[1].world_from_object, after.parts[2].world_from_part);
    EXPECT_NE(objects(second).placed[1].world_from_object, objects(first).placed[1].world_from_object);
}

TEST(ObjectRows, AKeptArrayAnswersAsAFreshOne) {
    const Scene before = boxes_over_a_floor(scattered_places(2, 1)), after = boxes_over_a_floor(scattered_places(2, 2));
    const Structure kept = built(after, small_parameters(), technique().kept(built(before, small_parameters())));
    const Structure fresh = built(after, small_parameters());
    const SurfaceBuffer surfaces = testing::surfaces_all_over({64, 64});
    const std::vector<Light> lights = testing::lights_above(20, false);
    RenderRequest request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.parameters = small_parameters();
    request.keep_verdicts = true;
    Progress progress;
    const RenderResult a = technique().render(kept, request, progress),
                       b = technique().render(fresh, request, progress);
    std::uint64_t differing = 0;
    for (std::size_t k = 0; k < a.verdicts.words.size(); ++k)
        differing += static_cast<std::uint64_t>(std::popcount(a.verdicts.words[k] ^ b.verdicts.words[k]));
    EXPECT_LT(differing, a.rays / 1000);  // the object's vertices come back from the world's with rounding
}

TEST(ObjectRows, AutomaticTakesObjectsWhereFewMoveRigidly) {
    ParameterValues parameters = small_parameters();
    parameters.erase("motion");
    Scene scene = boxes_over_a_floor(scattered_places(3, 1));
    EXPECT_EQ(objects(built(scene, parameters)).placed.size(), 3u);
    EXPECT_TRUE(objects(built(boxes_over_a_floor(scattered_places(200, 1)), parameters)).empty());
    scene.parts[1].moves = false;
    scene.parts[1].deforms = true;
    EXPECT_TRUE(objects(built(scene, parameters)).empty());
    EXPECT_TRUE(objects(built(boxes_over_a_floor({}), parameters)).empty());
}

TEST(ObjectRows, ScenesWithPartsThatDeformAreNeverAskedByObjects) {
    Scene scene = boxes_over_a_floor(scattered_places(2, 1));
    scene.parts[1].deforms = true;
    const Structure structure = built(scene, small_parameters());
    EXPECT_TRUE(objects(structure).empty());
    ParameterValues changes = small_parameters();
    changes["motion"] = 0.0;
    EXPECT_TRUE(std::ranges::equal(row_array(structure).words.words, row_array(built(scene, changes)).words.words));
}

TEST(ObjectRows, AnInstanceWithoutAnExtentIsLeftOut) {
    std::vector<mat4> places = scattered_places(2, 1);
    places[0] = placed({0, 2, 0}, 0.0f, 0.0f);
    const Structure one_left = built(boxes_over_a_floor(places), small_parameters());
    EXPECT_EQ(objects(one_left).placed.size(), 1u);
    EXPECT_TRUE(technique().kept(one_left).has_value());
    places[1] = places[0];
    const Structure none_left = built(boxes_over_a_floor(places), small_parameters());
    EXPECT_TRUE(objects(none_left).empty());
    EXPECT_FALSE(technique().kept(none_left).has_value()) << "another moment must voxelise the object";
}

TEST(ObjectRows, WhereNothingStandsStillThereIsNextToNoArrayOfIt) {
    Scene scene = boxes_over_a_floor(scattered_places(2, 1));
    scene.parts[0].moves = true;
    const Structure structure = built(scene, small_parameters());
    EXPECT_EQ(objects(structure).types.size(), 2u);
    EXPECT_EQ(objects(structure).placed.size(), 3u);
    EXPECT_LT(row_array(structure).words.bytes(), objects(structure).types[0].words.bytes());
    EXPECT_TRUE(std::ranges::all_of(row_array(structure).words.words, [](std::uint32_t word) { return word == 0; }));
    const auto instances = object_instances(objects(structure), small_parameters());
    const Segment through_the_floor{vec3(1.0f, 0.8f, 1.0f), vec3(1.2f, -0.8f, 0.9f)};
    EXPECT_TRUE(is_blocked(instances, through_the_floor, vec3(0.0f)));
}

TEST(ObjectRows, RefusesParametersOutOfRange) {
    EXPECT_THROW(check_parameters(technique().parameters, {{"object_resolution", 8.0}}), InputError);
    EXPECT_THROW(check_parameters(technique().parameters, {{"object_resolution", 129.0}}), InputError);
    EXPECT_THROW(parse_parameter(technique().parameters, "motion", "rigid"), InputError);
    EXPECT_EQ(parse_parameter(technique().parameters, "motion", "objects"), 2.0);
}

TEST(ObjectRows, BoundsInTheWorldHoldTheTurnedObject) {
    const Scene scene = boxes_over_a_floor(scattered_places(5, 9));
    const Structure structure = built(scene, small_parameters());
    for (std::size_t k = 0; k < 5; ++k) {
        const PlacedObject& box = objects(structure).placed[k];
        const Box3 bounds = world_bounds(objects(structure).types[box.type], box.world_from_object);
        const Part& part = scene.parts[k + 1];
        Box3 tight;
        for (std::uint32_t t = 0; t < part.triangle_count; ++t)
            for (int corner = 0; corner < 3; ++corner)
                tight.add(scene.positions[scene.triangles[part.first_triangle + t][corner]]);
        EXPECT_TRUE(glm::all(glm::lessThanEqual(bounds.lowest, tight.lowest)));
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(bounds.highest, tight.highest)));
        EXPECT_LT(bounds.diagonal(), 1.2f * tight.diagonal());
    }
}

}  // namespace
}  // namespace sightlines::voxel_rows
