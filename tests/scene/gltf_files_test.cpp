// What an untrusted file must not reach: other folders, endless nesting, memory without bounds.
#include <filesystem>
#include <string>

#include <sys/stat.h>

#include "tests/scene/gltf_testing.h"

namespace sightlines {
namespace {

using namespace testing_gltf;
namespace fs = std::filesystem;

/// A triangle whose buffer is the file that `uri` names.
Document with_external_buffer(const std::string& uri) {
    Document document = triangle_document();
    document.root["buffers"] = json::array({{{"byteLength", document.bytes.size()}, {"uri", uri}}});
    return document;
}

TEST(GltfFiles, ReadsABufferBesideTheSceneAndInAFolderBelow) {
    const Document document = triangle_document();
    fs::create_directories(test_folder() / "sub folder");
    write_file(test_folder() / "data.bin", document.bytes);
    write_file(test_folder() / "sub folder" / "data.bin", document.bytes);
    for (const char* uri : {"data.bin", "./data.bin", "sub%20folder/data.bin", "sub folder/data.bin"})
        EXPECT_EQ(scene_of(with_external_buffer(uri)).triangles.size(), 1u) << uri;
}

TEST(GltfFiles, RefusesEveryWayOutOfTheFolder) {
    const fs::path outside = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / "outside.bin";
    fs::create_directories(test_folder() / "inside");
    write_file(outside, triangle_document().bytes);
    const std::string absolute = fs::absolute(outside).string();
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("inside/../../outside.bin"), std::string("%2e%2e/outside.bin"),
          std::string("..%2Foutside.bin"), std::string("inside/%2E./../outside.bin"), absolute, "file://" + absolute,
          std::string("..\\outside.bin"), std::string("http://example.org/a.bin"), std::string(""),
          std::string("a%00b")}) {
        const std::string message = refusal(with_external_buffer(uri));
        EXPECT_TRUE(contains(message, "buffers[0].uri")) << message;
    }
}

TEST(GltfFiles, RefusesASymbolicLinkOutOfTheFolderAndFollowsOneInside) {
    const fs::path folder = test_folder();
    write_file(fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / "outside.bin", triangle_document().bytes);
    write_file(folder / "inside.bin", triangle_document().bytes);
    for (const char* link : {"out.bin", "in.bin", "up"}) fs::remove(folder / link);
    fs::create_symlink("../outside.bin", folder / "out.bin");
    fs::create_symlink("inside.bin", folder / "in.bin");
    fs::create_directory_symlink("..", folder / "up");
    EXPECT_TRUE(contains(refusal(with_external_buffer("out.bin")), "leads out of the scene's folder"));
    EXPECT_TRUE(contains(refusal(with_external_buffer("up/outside.bin")), "leads out of the scene's folder"));
    EXPECT_EQ(scene_of(with_external_buffer("in.bin")).triangles.size(), 1u);
}

TEST(GltfFiles, RefusesDirectoriesAndPipesAsBuffers) {
    fs::create_directories(test_folder() / "folder.bin");
    EXPECT_TRUE(contains(refusal(with_external_buffer("folder.bin")), "not a regular file"));
    const fs::path pipe = test_folder() / "pipe.bin";
    fs::remove(pipe);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_TRUE(contains(refusal(with_external_buffer("pipe.bin")), "not a regular file"));
}

TEST(GltfFiles, NamesAMissingBufferAndAMissingPicture) {
    EXPECT_TRUE(contains(refusal(with_external_buffer("missing.bin")), "missing.bin"));
    Document document = triangle_document();
    document.root["images"] = json::array({{{"uri", "missing.png"}}});
    EXPECT_TRUE(contains(refusal(document), "missing.png"));
}

TEST(GltfFiles, RefusesABufferThatIsShorterThanItSays) {
    Document document = triangle_document();
    document.root["buffers"] =
        json::array({{{"byteLength", 100}, {"uri", "data:application/octet-stream;base64," + base64(document.bytes)}}});
    EXPECT_TRUE(contains(refusal(document), "buffers[0]"));
}

TEST(GltfFiles, RefusesMalformedDataUris) {
    for (const char* uri : {"data:", "data:application/octet-stream;base64,A", "data:a;base64,AA*A"})
        EXPECT_TRUE(contains(refusal(with_external_buffer(uri)), "data URI")) << uri;
}

TEST(GltfFiles, ReadsDataUrisThatArePercentEncoded) {
    Document document = triangle_document();
    std::string uri = "data:application/octet-stream,";
    for (const std::uint8_t byte : document.bytes)
        uri += {'%', "0123456789ABCDEF"[byte / 16], "0123456789abcdef"[byte % 16]};
    expect_near(scene_of(with_external_buffer(uri)).positions[1], {1, 0, 0});
}

TEST(GltfFiles, RefusesMissingEmptyAndDirectoryInsteadOfAScene) {
    Progress progress;
    const fs::path folder = test_folder();
    save(folder / "empty.gltf", "");
    save(folder / "empty.glb", "");
    for (const fs::path& file : {folder / "no.gltf", folder, folder / "empty.gltf", folder / "empty.glb"})
        EXPECT_TRUE(contains(refusal([&] { load_gltf(file, progress); }), file.string()));
}

TEST(GltfFiles, RefusesNestingBeyondTheLimit) {
    const std::string deep(200000, '[');
    EXPECT_TRUE(
        contains(refusal([&] { load_text("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + deep); }), "limit of 64"));
    EXPECT_TRUE(contains(refusal([&] { load_text(deep); }), "limit of 64"));
}

TEST(GltfFiles, RefusesMoreValuesThanTheLimit) {
    std::string many = "{\"asset\":{\"version\":\"2.0\"},\"extras\":[0";
    for (int i = 0; i < (1 << 23); ++i) many += ",0";
    EXPECT_TRUE(contains(refusal([&] { load_text(many + "]}"); }), "limit of 8388608 values"));
}

TEST(GltfFiles, BracketsInsideStringsAreNoNesting) {
    Document document = triangle_document();
    document.root["nodes"][0]["name"] = std::string(1000, '[') + "\\\"" + std::string(1000, '{');
    EXPECT_EQ(scene_of(document).triangles.size(), 1u);
}

TEST(GltfFiles, RefusesAnUnknownRequiredExtensionByName) {
    Document document = triangle_document();
    document.root["extensionsRequired"] = {"KHR_texture_transform", "KHR_draco_mesh_compression"};
    const std::string message = refusal(document);
    EXPECT_TRUE(contains(message, "KHR_draco_mesh_compression"));
    EXPECT_FALSE(contains(message, "KHR_texture_transform"));
}

TEST(GltfFiles, RefusesInstancingThatMultipliesTrianglesBeyondTheLimit) {
    Document document;
    std::vector<std::uint8_t> corners(65536 * 3, 0);
    document.show(
        {{"attributes",
          {{"POSITION", document.add_floats(unit_triangle)}, {"NORMAL", document.add_floats(unit_triangle)}}},
         {"indices", document.add_accessor(document.add_view(corners), unsigned_byte, "SCALAR", corners.size())}});
    json nodes = json::array(), roots = json::array();
    for (int i = 0; i < 1000; ++i) {
        nodes.push_back({{"mesh", 0}});
        roots.push_back(i);
    }
    document.root["nodes"] = nodes;
    document.root["scenes"][0]["nodes"] = roots;
    EXPECT_TRUE(contains(refusal(document), "instancing brings the scene above the limit"));
}

TEST(GltfFiles, RefusesCountsBeyondTheLimitBeforeTheyCostMemory) {
    Document document;
    document.root["accessors"] =
        json::array({{{"componentType", float_type}, {"type", "VEC3"}, {"count", 2147483647}}});
    document.show({{"attributes", {{"POSITION", 0}}}});
    EXPECT_TRUE(contains(refusal(document), "limit"));
}

TEST(GltfFiles, StopsWhenItIsCancelled) {
    const fs::path file = test_folder() / "scene.gltf";
    write_file(file, triangle_document().text());
    Progress progress;
    progress.cancel();
    EXPECT_THROW(load_gltf(file, progress), Cancelled);
}

}  // namespace
}  // namespace sightlines
