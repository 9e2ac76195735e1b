// Accessors, primitives, nodes: what ends up where, against values worked out by hand.
#include <string>
#include <vector>

#include "tests/scene/gltf_testing.h"

namespace sightlines {
namespace {

using namespace testing_gltf;

/// Corners of the scene's triangles as positions.
std::vector<vec3> corners_of(const Scene& scene) {
    std::vector<vec3> corners;
    for (const uvec3& triangle : scene.triangles)
        for (int corner = 0; corner < 3; ++corner) corners.push_back(scene.positions[triangle[corner]]);
    return corners;
}

/// The x coordinates 0, 1, 2 ... name the vertices.
std::vector<int> vertex_names(const Scene& scene) {
    std::vector<int> names;
    for (const vec3& corner : corners_of(scene)) names.push_back(static_cast<int>(std::lround(corner.x)));
    return names;
}

vec3 geometric_normal(const Scene& scene, std::size_t triangle) {
    const auto corners = corners_of(scene);
    return glm::normalize(glm::cross(corners[3 * triangle + 1] - corners[3 * triangle],
                                     corners[3 * triangle + 2] - corners[3 * triangle]));
}

const std::vector<float> five_points = {0, 0, 0, 1, 1, 0, 2, 0, 0, 3, 1, 0, 4, 0, 0};

Document five_point_document(int mode) {
    Document document;
    document.show({{"attributes", {{"POSITION", document.add_floats(five_points)}}}, {"mode", mode}});
    return document;
}

TEST(GltfGeometry, StripsAlternateTheirCornersSoThatTheWindingStays) {
    const Scene scene = scene_of(five_point_document(5));
    EXPECT_EQ(vertex_names(scene), (std::vector<int>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    for (std::size_t i = 0; i < 3; ++i) expect_near(geometric_normal(scene, i), {0, 0, -1});
}

TEST(GltfGeometry, FansTurnAroundTheirFirstVertex) {
    EXPECT_EQ(vertex_names(scene_of(five_point_document(6))), (std::vector<int>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(GltfGeometry, StitchesOfAStripAreNoTriangles) {
    Document document;
    document.show({{"attributes", {{"POSITION", document.add_floats(five_points)}}},
                   {"mode", 5},
                   {"indices", document.add_accessor(document.add_view(std::vector<std::uint8_t>{0, 1, 2, 2, 3, 4}),
                                                     unsigned_byte, "SCALAR", 6)}});
    EXPECT_EQ(vertex_names(scene_of(document)), (std::vector<int>{0, 1, 2, 2, 4, 3}));
}

TEST(GltfGeometry, LeftOverCornersAreLeftOutWithANote) {
    const Scene scene = scene_of(five_point_document(4));
    EXPECT_EQ(vertex_names(scene), (std::vector<int>{0, 1, 2}));
    EXPECT_TRUE(contains(json(scene.notes).dump(), "no whole triangle"));
}

TEST(GltfGeometry, PointsAndLinesLoadAsAnEmptySceneWithANote) {
    for (int mode = 0; mode < 4; ++mode) {
        const Scene scene = scene_of(five_point_document(mode));
        EXPECT_TRUE(scene.triangles.empty() && scene.bounds.empty());
        EXPECT_TRUE(contains(json(scene.notes).dump(), "points and lines"));
        EXPECT_EQ(scene.cameras.size(), 1u);
    }
}

TEST(GltfGeometry, IndicesOfEveryWidthSelectTheSameVertices) {
    const auto names_by = [](auto index, int type) {
        Document document;
        const std::vector<decltype(index)> indices = {4, 2, 0};
        document.show({{"attributes", {{"POSITION", document.add_floats(five_points)}}},
                       {"indices", document.add_accessor(document.add_view(indices), type, "SCALAR", 3)}});
        return vertex_names(scene_of(document));
    };
    const std::vector<int> expected = {4, 2, 0};
    EXPECT_EQ(names_by(std::uint8_t{}, unsigned_byte), expected);
    EXPECT_EQ(names_by(std::uint16_t{}, unsigned_short), expected);
    EXPECT_EQ(names_by(std::uint32_t{}, unsigned_int), expected);
}

TEST(GltfGeometry, RefusesAnIndexPastTheVertices) {
    Document document;
    document.show({{"attributes", {{"POSITION", document.add_floats(five_points)}}},
                   {"indices", document.add_accessor(document.add_view(std::vector<std::uint8_t>{0, 1, 5}),
                                                     unsigned_byte, "SCALAR", 3)}});
    EXPECT_TRUE(contains(refusal(document), "element 2 is 5; there are 5 vertices"));
}

TEST(GltfGeometry, InterleavedAttributesAreReadByTheirStride) {
    Document document;
    // position, normal, texture coordinate, and 4 bytes of padding: 36 bytes a vertex
    const int view = document.add_view(std::vector<float>{0, 0,     5, 0,  0, 2, 0.25f, 0.5f, -1, 1, 0, 5, 0, 3,
                                                          0, 0.75f, 1, -1, 0, 1, 5,     4,    0,  0, 0, 2, -1},
                                       36);
    document.show({{"attributes",
                    {{"POSITION", document.add_accessor(view, float_type, "VEC3", 3)},
                     {"NORMAL", document.add_accessor(view, float_type, "VEC3", 3, {{"byteOffset", 12}})},
                     {"TEXCOORD_0", document.add_accessor(view, float_type, "VEC2", 3, {{"byteOffset", 24}})}}}});
    const Scene scene = scene_of(document);
    ASSERT_EQ(scene.positions.size(), 3u);
    expect_near(scene.positions[1], {1, 0, 5});
    expect_near(scene.normals[0], {0, 0, 1});
    expect_near(scene.normals[1], {0, 1, 0});
    expect_near(scene.normals[2], {1, 0, 0});
    EXPECT_EQ(scene.texture_coordinates[0], (std::vector<vec2>{{0.25f, 0.5f}, {0.75f, 1.0f}, {0.0f, 2.0f}}));
    EXPECT_TRUE(scene.texture_coordinates[1].empty());
}

TEST(GltfGeometry, RefusesAnAccessorThatReachesPastItsView) {
    Document document = triangle_document();
    document.root["accessors"][0]["count"] = 4;
    EXPECT_TRUE(contains(refusal(document), "accessors[0]: reaches to byte 48 of bufferViews[0], which holds 36"));
    document = triangle_document();
    document.root["accessors"][0]["byteOffset"] = 4;
    EXPECT_TRUE(contains(refusal(document), "reaches to byte 40"));
    document = triangle_document();
    document.root["bufferViews"][0]["byteOffset"] = 4;
    EXPECT_TRUE(contains(refusal(document), "bufferViews[0]: reaches to byte 40 of a buffer of 36"));
    document = triangle_document();
    document.root["bufferViews"][0]["byteStride"] = 8;
    EXPECT_TRUE(contains(refusal(document), "overlap"));
}

/// Texture coordinates (u of each vertex) that were stored as integers.
template <class Component>
std::vector<float> normalised_u(int type, std::vector<Component> values) {
    Document document;
    const int positions = document.add_floats(unit_triangle);
    const std::size_t padding = 4 / sizeof(Component);
    std::vector<Component> padded(3 * padding * 1, 0);
    std::vector<Component> pairs;
    for (const Component value : values) {
        pairs.push_back(value);
        for (std::size_t i = 1; i < padding; ++i) pairs.push_back(0);
    }
    const int view = document.add_view(pairs, 4);
    document.show({{"attributes",
                    {{"POSITION", positions},
                     {"TEXCOORD_0", document.add_accessor(view, type, "VEC2", 3, {{"normalized", true}})}}}});
    std::vector<float> result;
    for (const vec2& coordinate : scene_of(document).texture_coordinates[0]) result.push_back(coordinate.x);
    return result;
}

TEST(GltfGeometry, NormalisedIntegersCoverTheUnitInterval) {
    EXPECT_EQ(normalised_u<std::uint8_t>(unsigned_byte, {0, 51, 255}), (std::vector<float>{0.0f, 0.2f, 1.0f}));
    EXPECT_EQ(normalised_u<std::uint16_t>(unsigned_short, {0, 13107, 65535}), (std::vector<float>{0.0f, 0.2f, 1.0f}));
    EXPECT_EQ(normalised_u<std::int8_t>(byte_type, {-128, -127, 127}), (std::vector<float>{-1.0f, -1.0f, 1.0f}));
    EXPECT_EQ(normalised_u<std::int16_t>(short_type, {-32768, 0, 32767}), (std::vector<float>{-1.0f, 0.0f, 1.0f}));
}

TEST(GltfGeometry, QuantisedPositionsAreWholeNumbers) {
    Document document;
    document.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int view = document.add_view(std::vector<std::int16_t>{-5, 0, 7, 0, 300, 0, 0, 0, 0, -2, 0, 0}, 8);
    document.show({{"attributes", {{"POSITION", document.add_accessor(view, short_type, "VEC3", 3)}}}});
    const Scene scene = scene_of(document);
    expect_near(scene.positions[0], {-5, 0, 7});
    expect_near(scene.positions[1], {300, 0, 0});
    expect_near(scene.positions[2], {0, -2, 0});
}

json sparse_of(Document& document, const std::vector<std::uint16_t>& indices, const std::vector<float>& values) {
    return {{"count", indices.size()},
            {"indices", {{"bufferView", document.add_view(indices)}, {"componentType", unsigned_short}}},
            {"values", {{"bufferView", document.add_view(values)}}}};
}

TEST(GltfGeometry, SparseValuesReplaceThoseOfTheView) {
    Document document = triangle_document();
    document.root["accessors"][0]["sparse"] = sparse_of(document, {0, 2}, {9, 8, 7, 6, 5, 4});
    const Scene scene = scene_of(document);
    expect_near(scene.positions[0], {9, 8, 7});
    expect_near(scene.positions[1], {1, 0, 0});
    expect_near(scene.positions[2], {6, 5, 4});
}

TEST(GltfGeometry, SparseValuesWithoutAViewReplaceZeros) {
    Document document;
    document.root["accessors"] = json::array({{{"componentType", float_type}, {"type", "VEC3"}, {"count", 3}}});
    document.root["accessors"][0]["sparse"] = sparse_of(document, {1}, {1, 2, 3});
    document.show({{"attributes", {{"POSITION", 0}}}});
    const Scene scene = scene_of(document);
    expect_near(scene.positions[0], {0, 0, 0});
    expect_near(scene.positions[1], {1, 2, 3});
}

TEST(GltfGeometry, RefusesSparseIndicesThatDoNotIncreaseOrReachPastTheEnd) {
    for (const std::vector<std::uint16_t>& indices : {std::vector<std::uint16_t>{2, 1}, {1, 1}, {0, 3}}) {
        Document document = triangle_document();
        document.root["accessors"][0]["sparse"] = sparse_of(document, indices, {9, 8, 7, 6, 5, 4});
        EXPECT_TRUE(contains(refusal(document), "accessors[0].sparse.indices"));
    }
}

TEST(GltfGeometry, RefusesPositionsThatAreNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Document document;
        document.show({{"attributes", {{"POSITION", document.add_floats({0, 0, 0, 1, bad, 0, 0, 1, 0})}}}});
        EXPECT_TRUE(contains(refusal(document), "not a finite number"));
    }
}

TEST(GltfGeometry, RefusesNodesThatCarryVerticesOutOfRange) {
    Document document = triangle_document();
    document.root["nodes"][0]["scale"] = {1e30, 1e30, 1e30};
    EXPECT_TRUE(contains(refusal(document), "farther than the limit"));
}

TEST(GltfGeometry, AttributesOfDifferentLengthsAreRefused) {
    Document document = triangle_document();
    document.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = document.add_floats({0, 0, 1, 0, 0, 1});
    EXPECT_TRUE(contains(refusal(document), "NORMAL: has 2 elements for 3 vertices"));
}

TEST(GltfGeometry, MeshesWithoutNormalsGetTheirTrianglesNormals) {
    Document document;
    // two triangles that share an edge and stand at a right angle
    const int indices = document.add_accessor(document.add_view(std::vector<std::uint8_t>{0, 1, 2, 0, 3, 1}),
                                              unsigned_byte, "SCALAR", 6);
    document.show({{"attributes", {{"POSITION", document.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})}}},
                   {"indices", indices}});
    const Scene scene = scene_of(document);
    ASSERT_EQ(scene.positions.size(), 6u);
    for (int corner = 0; corner < 3; ++corner) {
        expect_near(scene.normals[scene.triangles[0][corner]], {0, 0, 1});
        expect_near(scene.normals[scene.triangles[1][corner]], {0, 1, 0});
    }
}

TEST(GltfGeometry, NormalsWithoutDirectionAreRepaired) {
    Document document = triangle_document();
    document.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        document.add_floats({0, 0, 0, 1, 0, 0, 0, 5, 0});
    const Scene scene = scene_of(document);
    expect_near(scene.normals[0], {0, 0, 1});
    expect_near(scene.normals[1], {1, 0, 0});
    expect_near(scene.normals[2], {0, 1, 0});
}

TEST(GltfGeometry, NodesTransformTheirChildren) {
    Document document = triangle_document();
    document.root["nodes"] = json::array(
        {{{"translation", {10, 0, 0}}, {"rotation", {0, 0.70710678118, 0, 0.70710678118}}, {"children", {1}}},
         {{"mesh", 0}, {"scale", {2, 3, 4}}}});
    const Scene scene = scene_of(document);
    // x is scaled by 2, then turned by 90 degrees about +Y into -z
    expect_near(scene.positions[0], {10, 0, 0});
    expect_near(scene.positions[1], {10, 0, -2});
    expect_near(scene.positions[2], {10, 3, 0});
    expect_near(scene.normals[0], {1, 0, 0});
}

TEST(GltfGeometry, NormalsTurnAsSurfacesDoUnderUnevenScale) {
    Document document;
    const float s = 0.70710678f;
    document.show({{"attributes",
                    {{"POSITION", document.add_floats({0, 1, 0, 1, 0, 0, 0, 1, -1})},
                     {"NORMAL", document.add_floats({s, s, 0, s, s, 0, s, s, 0})}}}});
    document.root["nodes"][0]["scale"] = {2, 1, 1};
    expect_near(scene_of(document).normals[0], glm::normalize(vec3(1, 2, 0)));
}

TEST(GltfGeometry, AMirroringNodeKeepsTheFrontInFront) {
    for (const bool with_normals : {false, true}) {
        Document document = triangle_document();
        if (with_normals)
            document.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
                document.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1});
        document.root["nodes"][0]["scale"] = {-1, 1, 1};
        const Scene scene = scene_of(document);
        expect_near(scene.positions[scene.triangles[0].y] + scene.positions[scene.triangles[0].z], {-1, 1, 0});
        expect_near(geometric_normal(scene, 0), {0, 0, 1});
        expect_near(scene.normals[0], {0, 0, 1});
    }
}

TEST(GltfGeometry, InstancesShareTheirMeshIdAndHaveTheirOwnPlace) {
    Document document = triangle_document();
    document.root["nodes"] =
        json::array({{{"mesh", 0}, {"name", "left"}}, {{"mesh", 0}, {"name", "right"}, {"translation", {5, 0, 0}}}});
    document.root["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = scene_of(document);
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[0].name, "left");
    EXPECT_EQ(scene.parts[0].mesh, scene.parts[1].mesh);
    EXPECT_EQ(scene.parts[1].first_triangle, 1u);
    EXPECT_EQ(scene.parts[1].triangle_count, 1u);
    EXPECT_FALSE(scene.parts[1].moves || scene.parts[1].deforms);
    expect_near(vec3(scene.parts[1].world_from_part[3]), {5, 0, 0});
    expect_near(scene.bounds.highest, {6, 1, 0});
}

TEST(GltfGeometry, OnlyTheDefaultSceneIsShown) {
    Document document = triangle_document();
    document.root["nodes"] = json::array({{{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}});
    document.root["scenes"] = json::array({{{"nodes", {0}}}, {{"nodes", {1}}}});
    document.root["scene"] = 1;
    const Scene scene = scene_of(document);
    ASSERT_EQ(scene.triangles.size(), 1u);
    expect_near(scene.bounds.lowest, {5, 0, 0});
}

TEST(GltfGeometry, RefusesLoopsSecondParentsAndTooDeepTrees) {
    Document document = triangle_document();
    document.root["nodes"] = json::array({{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}});
    EXPECT_TRUE(contains(refusal(document), "its own ancestor"));
    document.root["nodes"] = json::array({{{"mesh", 0}}, {{"children", {0}}}, {{"children", {0}}}});
    EXPECT_TRUE(contains(refusal(document), "nodes[2].children"));
    document.root["nodes"] = json::array({{{"mesh", 0}, {"children", {0}}}});
    EXPECT_TRUE(contains(refusal(document), "its own ancestor"));
    json chain = json::array();
    for (int i = 0; i < 5000; ++i) chain.push_back({{"children", {i + 1}}});
    chain.push_back(json::object());
    document.root["nodes"] = chain;
    EXPECT_TRUE(contains(refusal(document), "limit of 256"));
}

}  // namespace
}  // namespace sightlines
