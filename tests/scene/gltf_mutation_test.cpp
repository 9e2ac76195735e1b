// Damaged files: whatever a byte says, the reader either loads or refuses in one line.
#include <algorithm>
#include <string>
#include <vector>

#include "techniques/base/random.h"
#include "tests/scene/gltf_testing.h"

namespace sightlines {
namespace {

using namespace testing_gltf;

const std::string shared_folder = SIGHTLINES_SHARED_FOLDER;

/// Small files that between them use every part of the reader.
const std::vector<std::string> seeds = {
    "corpus/valid/assimp/BoxTextured-glTF-Binary/BoxTextured.glb",
    "corpus/valid/assimp/BoxTexcoords-glTF/boxTexcoords.gltf",
    "corpus/valid/khronos-validator/base/data/animation/valid.gltf",
    "corpus/valid/khronos-validator/base/data/skin/valid.gltf",
    "corpus/valid/tinygltf/models/SparseMorphTargets-issue280/singleBlendshapeCube_sparse.glb",
    "corpus/valid/magnum/GltfImporter/Test/light.gltf",
    "corpus/valid/magnum/GltfImporter/Test/camera.gltf",
    "corpus/valid/khronos-validator/base/data/accessor_data/get_elements_matrix.gltf",
    "corpus/valid/tinygltf/models/box01.glb",
    "scenes/cornell_box.glb"};

std::vector<std::uint8_t> mutated(std::vector<std::uint8_t> bytes, std::uint32_t stream) {
    std::uint32_t counter = 0;
    const auto next = [&](std::size_t below) {
        return random_u32(2024, stream, counter++) % static_cast<std::uint32_t>(below);
    };
    if (next(8) == 0) bytes.resize(next(bytes.size()) + 1);
    // Digits and brackets rather than any byte: most of what an arbitrary byte breaks is the JSON grammar alone.
    const std::string likely = "0123456789-.[]{},\":e";
    for (std::uint32_t flips = 1 + next(3); flips > 0; --flips) {
        std::uint8_t& byte = bytes[next(bytes.size())];
        switch (next(3)) {
            case 0:
                byte = static_cast<std::uint8_t>(byte ^ (1u << next(8)));
                break;
            case 1:
                byte = static_cast<std::uint8_t>(next(256));
                break;
            default:
                if (byte >= '0' && byte <= '9')
                    byte = static_cast<std::uint8_t>('0' + next(10));
                else
                    byte = static_cast<std::uint8_t>(likely[next(likely.size())]);
        }
    }
    return bytes;
}

TEST(GltfMutation, DamagedFilesLoadOrAreRefused) {
    int refused = 0, loaded = 0;
    for (std::size_t seed = 0; seed < seeds.size(); ++seed) {
        const std::filesystem::path original = shared_folder + "/" + seeds[seed];
        if (!std::filesystem::exists(original)) GTEST_SKIP() << original << " is absent";
        const std::vector<std::uint8_t> bytes = read_file(original, 1u << 20u);
        const std::filesystem::path file = test_folder() / ("damaged" + original.extension().string());
        for (std::uint32_t round = 0; round < 60; ++round) {
            const std::vector<std::uint8_t> damaged = mutated(bytes, static_cast<std::uint32_t>(seed) * 1000u + round);
            save(file, std::string(damaged.begin(), damaged.end()));
            try {
                Progress progress;
                const SceneModel model = load_gltf(file, progress);
                model.at(0.3 * model.duration_s);
                ++loaded;
            } catch (const InputError& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(loaded, 50);
}

/// Numbers of the document, each in turn replaced by a hostile one.
void collect_numbers(json& value, std::vector<json*>& numbers) {
    if (value.is_number()) numbers.push_back(&value);
    if (value.is_structured())
        for (json& child : value) collect_numbers(child, numbers);
}

TEST(GltfMutation, HostileNumbersAnywhereLoadOrAreRefused) {
    Document document;
    const int positions = document.add_floats(unit_triangle);
    const int joints =
        document.add_accessor(document.add_view(std::vector<std::uint8_t>(12, 0)), unsigned_byte, "VEC4", 3);
    const int weights = document.add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    const int indices =
        document.add_accessor(document.add_view(std::vector<std::uint16_t>{0, 1, 2}), unsigned_short, "SCALAR", 3);
    const int times = document.add_floats({0, 1}, "SCALAR");
    const int rotations = document.add_floats({0, 0, 0, 1, 0, 1, 0, 0}, "VEC4");
    const json sparse = {
        {"count", 1},
        {"indices",
         {{"bufferView", document.add_view(std::vector<std::uint8_t>{1})}, {"componentType", unsigned_byte}}},
        {"values", {{"bufferView", document.add_view(std::vector<float>{1, 2, 3})}}}};
    const int morph = document.add_accessor(0, float_type, "VEC3", 3, {{"sparse", sparse}});
    document.show({{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
                   {"indices", indices},
                   {"mode", 4},
                   {"targets", json::array({{{"POSITION", morph}}})}});
    document.root["nodes"] = json::array({{{"mesh", 0}, {"skin", 0}, {"children", {1}}}, {{"translation", {1, 2, 3}}}});
    document.root["skins"] = json::array({{{"joints", {1}}}});
    document.root["animations"] =
        json::array({{{"channels", json::array({{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}})},
                      {"samplers", json::array({{{"input", times}, {"output", rotations}}})}}});
    document.root = json::parse(document.text());
    ASSERT_EQ(load(document).at(0.5).triangles.size(), 1u);

    std::vector<json*> numbers;
    collect_numbers(document.root, numbers);
    int refused = 0;
    for (json* number : numbers) {
        const json original = *number;
        for (const json& hostile : {json(-1), json(1), json(4294967295u), json(9007199254740991), json(1e300),
                                    json(0.5), json(5126), json(nullptr), json(1000000)}) {
            *number = hostile;
            try {
                load(document).at(0.5);
            } catch (const InputError&) {
                ++refused;
            }
        }
        *number = original;
    }
    EXPECT_GT(refused, static_cast<int>(4 * numbers.size()));
}

}  // namespace
}  // namespace sightlines
