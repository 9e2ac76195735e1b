// Things that move: curves, nodes, skins and morph targets at known times.
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "techniques/scene/animation.h"
#include "tests/scene/gltf_testing.h"

namespace sightlines {
namespace {

using namespace testing_gltf;

/// One channel that moves `node`.
void animate(Document& document, int node, const char* path, int times, int values, const char* interpolation) {
    document.root["animations"] = json::array(
        {{{"channels", json::array({{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}})},
          {"samplers", json::array({{{"input", times}, {"output", values}, {"interpolation", interpolation}}})}}});
}

TEST(Animation, StepHoldsEachKeyframeUntilTheNext) {
    const AnimationCurve curve{Interpolation::step, 3, {1, 2, 4}, {0, 0, 0, 5, 0, 0, 9, 0, 0}};
    const std::vector<std::pair<double, float>> expected = {{0, 0},    {1, 0}, {1.99, 0}, {2, 5},
                                                            {3.99, 5}, {4, 9}, {100, 9}};
    for (const auto& [time_s, x] : expected) EXPECT_EQ(sample_vector(curve, time_s).x, x) << time_s;
}

TEST(Animation, LinearRunsStraightBetweenKeyframesAndStaysOutside) {
    const AnimationCurve curve{Interpolation::linear, 3, {1, 3}, {0, 10, 0, 4, 20, -8}};
    expect_near(sample_vector(curve, 1.5), {1, 12.5f, -2});
    expect_near(sample_vector(curve, 0.0), {0, 10, 0});
    expect_near(sample_vector(curve, 9.0), {4, 20, -8});
}

TEST(Animation, CubicSplinesFollowHermitesFormula) {
    // value 1 with out-tangent 2 at 0 s, value 3 with in-tangent -1 at 2 s:
    // at t = 0.5 of 2 s: 0.5 * 1 + 2 * 0.125 * 2 + 0.5 * 3 + 2 * (-0.125) * (-1) = 2.75
    const AnimationCurve curve{Interpolation::cubic_spline, 1, {0, 2}, {7, 1, 2, -1, 3, 7}};
    float value[1];
    sample_curve(curve, 1.0, value);
    EXPECT_FLOAT_EQ(value[0], 2.75f);
    sample_curve(curve, 0.0, value);
    EXPECT_FLOAT_EQ(value[0], 1.0f);
    sample_curve(curve, 2.0, value);
    EXPECT_FLOAT_EQ(value[0], 3.0f);
    // t = 0.25: (2/64 - 3/16 + 1) * 1 + 2 * (1/64 - 2/16 + 1/4) * 2 + (3/16 - 2/64) * 3 + 2 * (1/64 - 1/16) * (-1)
    sample_curve(curve, 0.5, value);
    EXPECT_FLOAT_EQ(value[0], 0.84375f + 0.5625f + 0.46875f + 0.09375f);
}

TEST(Animation, LinearRotationsTurnAtConstantSpeedTheShorterWay) {
    const float half = std::sqrt(0.5f);
    for (const float sign : {1.0f, -1.0f}) {  // q and -q are the same rotation
        const AnimationCurve curve{Interpolation::linear, 4, {0, 3}, {0, 0, 0, 1, 0, sign * half, 0, sign * half}};
        const vec3 turned = sample_rotation(curve, 1.0) * vec3(1, 0, 0);
        expect_near(turned, {std::cos(glm::radians(30.0f)), 0, -std::sin(glm::radians(30.0f))});
    }
}

TEST(Animation, EqualTimesDoNotDivideByZero) {
    const AnimationCurve curve{Interpolation::linear, 3, {1, 1, 2}, {0, 0, 0, 4, 0, 0, 6, 0, 0}};
    EXPECT_EQ(sample_vector(curve, 0.5).x, 0.0f);
    EXPECT_EQ(sample_vector(curve, 1.0).x, 4.0f);
    EXPECT_EQ(sample_vector(curve, 1.5).x, 5.0f);
}

TEST(Animation, TimeLoopsForwardsAndBackwards) {
    EXPECT_DOUBLE_EQ(looped_time_s(5.0, 2.0), 1.0);
    EXPECT_DOUBLE_EQ(looped_time_s(-0.5, 2.0), 1.5);
    EXPECT_DOUBLE_EQ(looped_time_s(3.0, 0.0), 0.0);
    EXPECT_DOUBLE_EQ(looped_time_s(std::numeric_limits<double>::quiet_NaN(), 2.0), 0.0);
    EXPECT_LT(looped_time_s(-1e-300, 2.0), 2.0);
}

TEST(GltfAnimation, ANodeCarriesItsChildrenAndTheirPartsSayThatTheyMove) {
    Document document = triangle_document();
    document.root["nodes"] =
        json::array({{{"children", {1}}}, {{"mesh", 0}, {"translation", {0, 1, 0}}}, {{"mesh", 0}}});
    document.root["scenes"][0]["nodes"] = {0, 2};
    animate(document, 0, "translation", document.add_floats({0, 2}, "SCALAR"), document.add_floats({0, 0, 0, 4, 0, 0}),
            "LINEAR");
    const SceneModel model = load(document);
    EXPECT_DOUBLE_EQ(model.duration_s, 2.0);
    const Scene scene = model.at(1.0);
    expect_near(scene.positions[0], {2, 1, 0});
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_TRUE(scene.parts[0].moves);
    EXPECT_FALSE(scene.parts[0].deforms);
    expect_near(vec3(scene.parts[0].world_from_part[3]), {2, 1, 0});
    EXPECT_FALSE(scene.parts[1].moves);
    expect_near(model.at(3.0).positions[0], scene.positions[0]);
    EXPECT_EQ(model.at(0.25).cameras, model.at(1.75).cameras);
}

/// Two joints, at the origin and at (0, 2, 0); vertex 1 hangs on both.
Document skinned_document() {
    Document document;
    const json attributes = {
        {"POSITION", document.add_floats({0, 0, 0, 1, 2, 0, 0, 3, 0})},
        {"JOINTS_0",
         document.add_accessor(document.add_view(std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}),
                               unsigned_byte, "VEC4", 3)},
        {"WEIGHTS_0", document.add_floats({1, 0, 0, 0, 0.25f, 0.75f, 0, 0, 1, 0, 0, 0}, "VEC4")}};
    document.show({{"attributes", attributes}});
    document.root["nodes"] = json::array(
        {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}}, {{"children", {2}}}, {{"translation", {0, 2, 0}}}});
    document.root["scenes"][0]["nodes"] = {0, 1};
    const std::vector<float> inverse_bind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1};
    document.root["skins"] =
        json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", document.add_floats(inverse_bind, "MAT4")}}});
    const float half = std::sqrt(0.5f);
    // the upper joint turns by 90 degrees about +Z within a second
    animate(document, 2, "rotation", document.add_floats({0, 1}, "SCALAR"),
            document.add_floats({0, 0, 0, 1, 0, 0, half, half}, "VEC4"), "STEP");
    return document;
}

TEST(GltfAnimation, AVertexOnTwoJointsGoesToTheirWeightedMean) {
    Document document = skinned_document();
    document.root["animations"][0]["samplers"][0]["input"] = document.add_floats({0, 0.5f, 1}, "SCALAR");
    const float half = std::sqrt(0.5f);
    document.root["animations"][0]["samplers"][0]["output"] =
        document.add_floats({0, 0, 0, 1, 0, 0, half, half, 0, 0, 0, 1}, "VEC4");
    const SceneModel model = load(document);
    const Scene rest = model.at(0.0);
    expect_near(rest.positions[0], {0, 0, 0});  // the mesh node's own translation does not count
    expect_near(rest.positions[1], {1, 2, 0});
    const Scene bent = model.at(0.75);
    // joint 1 turns (1, 0, 0), seen from it, into (0, 1, 0): 0.25 * (1, 2, 0) + 0.75 * (0, 3, 0)
    expect_near(bent.positions[1], {0.25f, 2.75f, 0});
    // (0, 1, 0), seen from it, into (-1, 0, 0)
    expect_near(bent.positions[2], {-1, 2, 0});
    ASSERT_EQ(bent.parts.size(), 1u);
    EXPECT_TRUE(bent.parts[0].deforms);
    EXPECT_FALSE(bent.parts[0].moves);
    EXPECT_EQ(bent.parts[0].world_from_part, mat4(1.0f));
}

TEST(GltfAnimation, RefusesAJointThatTheSkinDoesNotHave) {
    Document document = skinned_document();
    document.root["skins"][0]["joints"] = {1};
    EXPECT_TRUE(contains(refusal(document), "uses joint 1 of a skin of 1"));
}

TEST(GltfAnimation, RefusesTooFewInverseBindMatrices) {
    Document document = skinned_document();
    document.root["accessors"][static_cast<std::size_t>(document.root["skins"][0]["inverseBindMatrices"])]["count"] = 1;
    EXPECT_TRUE(contains(refusal(document), "has 1 matrices for 2 joints"));
}

TEST(GltfAnimation, MorphTargetsAddTheirWeightedDisplacements) {
    Document document = triangle_document();
    json& primitive = document.root["meshes"][0]["primitives"][0];
    primitive["targets"] = json::array({{{"POSITION", document.add_floats({0, 0, 4, 0, 0, 0, 0, 0, 0})}},
                                        {{"POSITION", document.add_floats({8, 0, 0, 0, 0, 0, 0, 2, 0})}}});
    document.root["meshes"][0]["weights"] = {0.5, 0.25};
    expect_near(scene_of(document).positions[0], {2, 0, 2});
    expect_near(scene_of(document).positions[2], {0, 1.5f, 0});
    EXPECT_FALSE(scene_of(document).parts[0].deforms);

    document.root["nodes"][0]["weights"] = {1, 0};
    expect_near(scene_of(document).positions[0], {0, 0, 4});

    animate(document, 0, "weights", document.add_floats({0, 2}, "SCALAR"),
            document.add_floats({0, 0, 1, 0.5f}, "SCALAR"), "LINEAR");
    const Scene scene = load(document).at(1.0);
    expect_near(scene.positions[0], {2, 0, 2});
    EXPECT_TRUE(scene.parts[0].deforms);
}

TEST(GltfAnimation, RefusesSamplersThatDoNotFit) {
    Document document = triangle_document();
    const int times = document.add_floats({0, 1}, "SCALAR"), values = document.add_floats({0, 0, 0, 1, 0, 0});
    animate(document, 0, "translation", times, values, "CUBICSPLINE");
    EXPECT_TRUE(contains(refusal(document), "has 2 elements; 2 keyframes need 6"));
    animate(document, 0, "rotation", times, values, "LINEAR");
    EXPECT_TRUE(contains(refusal(document), "wrong type"));
    animate(document, 0, "translation", times, values, "WOBBLE");
    EXPECT_TRUE(contains(refusal(document), "WOBBLE"));
    animate(document, 0, "translation", document.add_floats({1, 0}, "SCALAR"), values, "LINEAR");
    EXPECT_TRUE(contains(refusal(document), "go backwards"));
    document.root["animations"][0]["channels"][0]["sampler"] = 1;
    EXPECT_TRUE(contains(refusal(document), "refers to sampler 1 of 1"));
}

TEST(GltfAnimation, LaterAnimationsPlayOnlyWhereTheyMoveSomethingElse) {
    Document document = triangle_document();
    const int times = document.add_floats({0, 1}, "SCALAR"), values = document.add_floats({0, 0, 0, 1, 1, 1});
    animate(document, 0, "translation", times, values, "LINEAR");
    const json first = document.root["animations"][0];
    json scaling = first;
    scaling["channels"][0]["target"]["path"] = "scale";
    document.root["animations"] = json::array({first, first, scaling});
    const Scene scene = load(document).at(0.5);
    expect_near(scene.positions[1], {1, 0.5f, 0.5f});
    EXPECT_TRUE(contains(json(scene.notes).dump(), "of 3 animations 1 are not played"));
}

TEST(GltfAnimation, MomentsAreTheSameFromManyThreads) {
    const SceneModel model = load(skinned_document());
    const Scene expected = model.at(0.7);
    std::vector<Scene> scenes(4);
    std::vector<std::thread> threads;
    for (Scene& scene : scenes) threads.emplace_back([&] { scene = model.at(0.7); });
    for (std::thread& thread : threads) thread.join();
    for (const Scene& scene : scenes) EXPECT_EQ(scene.positions, expected.positions);
}

TEST(GltfAnimation, KnowsFromTheStartWhatItWillReach) {
    Document document = triangle_document();
    document.root["nodes"] = json::array({{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 50, 0}}}});
    document.root["scenes"][0]["nodes"] = {0, 1};
    const SceneModel still = load(document);
    EXPECT_EQ(still.at(0.0).motion_bounds, still.at(0.0).bounds);
    // There and back: at its farthest between two keyframes only.
    animate(document, 0, "translation", document.add_floats({0, 1, 2}, "SCALAR"),
            document.add_floats({0, 0, 0, 10, 0, 0, 0, 0, 0}), "LINEAR");
    const SceneModel model = load(document);
    const Box3 reached = model.at(0.0).motion_bounds;
    EXPECT_EQ(model.at(0.77).motion_bounds, reached);
    const float farthest = model.at(1.0).bounds.highest.x;
    EXPECT_NEAR(reached.highest.x, farthest, 0.03f * farthest);
    EXPECT_GE(reached.highest.x, farthest);
    EXPECT_EQ(reached.highest.y, still.at(0.0).bounds.highest.y) << "what stands still gets no margin";
}

TEST(GltfAnimation, SharedScenesStayInWhatTheySayTheyReach) {
    const std::filesystem::path folder = std::filesystem::path(SIGHTLINES_SHARED_FOLDER) / "scenes";
    for (const char* name : {"fox.glb", "cesium_man.glb", "rigid_anim_bunny.glb"}) {
        if (!std::filesystem::exists(folder / name)) GTEST_SKIP() << folder / name << " is absent";
        Progress progress;
        const SceneModel model = load_gltf(folder / name, progress);
        const Box3 reached = model.at(0.0).motion_bounds;
        for (int i = 0; i < 17; ++i) {
            const Box3 now = model.at(model.duration_s * i / 17.0).bounds;
            EXPECT_TRUE(glm::all(glm::lessThanEqual(reached.lowest, now.lowest))) << name << " " << i;
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(reached.highest, now.highest))) << name << " " << i;
        }
        EXPECT_LT(reached.diagonal(), 6.0f * model.at(0.0).bounds.diagonal()) << name;
    }
}

TEST(GltfAnimation, SharedScenesDeformOrMoveRigidly) {
    const std::filesystem::path folder = std::filesystem::path(SIGHTLINES_SHARED_FOLDER) / "scenes";
    for (const char* name : {"fox.glb", "cesium_man.glb", "rigid_anim_bunny.glb"}) {
        if (!std::filesystem::exists(folder / name)) GTEST_SKIP() << folder / name << " is absent";
        Progress progress;
        const SceneModel model = load_gltf(folder / name, progress);
        const bool rigid = std::string(name) == "rigid_anim_bunny.glb";
        EXPECT_GT(model.duration_s, 0.0);
        const Scene start = model.at(0.0), middle = model.at(0.5 * model.duration_s);
        EXPECT_NE(start.positions, middle.positions) << name;
        for (const Part& part : middle.parts) EXPECT_TRUE(rigid ? part.moves && !part.deforms : part.deforms) << name;
    }
}

}  // namespace
}  // namespace sightlines
