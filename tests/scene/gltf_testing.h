// Small glTF files made inside tests.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/gltf.h"

namespace sightlines::testing_gltf {

using nlohmann::json;

constexpr int byte_type = 5120, unsigned_byte = 5121, short_type = 5122, unsigned_short = 5123, unsigned_int = 5125,
              float_type = 5126;

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = (bits << 8u) | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[(bits >> (18u - 6u * k)) & 63u];
    }
    return text;
}

/// The folder of the running test, empty at its start.
inline std::filesystem::path test_folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    for (char& letter : name)
        if (letter == '/') letter = '_';
    const std::filesystem::path folder = std::filesystem::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / name;
    std::filesystem::create_directories(folder);
    return folder;
}

/// A document with one buffer that grows by what is added to it.
struct Document {
    json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", json::array({{{"nodes", {0}}}})}};
    std::vector<std::uint8_t> bytes;

    template <class Value>
    int add_view(const std::vector<Value>& values, int stride_bytes = 0) {
        while (bytes.size() % 4 != 0) bytes.push_back(0);
        json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(Value)}};
        if (stride_bytes > 0) view["byteStride"] = stride_bytes;
        const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
        bytes.insert(bytes.end(), first, first + values.size() * sizeof(Value));
        root["bufferViews"].push_back(view);
        return static_cast<int>(root["bufferViews"].size()) - 1;
    }
    int add_accessor(int view, int component_type, const char* type, std::size_t count,
                     const json& more = json::object()) {
        json accessor = {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}};
        accessor.update(more);
        root["accessors"].push_back(accessor);
        return static_cast<int>(root["accessors"].size()) - 1;
    }
    /// Packed floats.
    int add_floats(const std::vector<float>& values, const char* type = "VEC3") {
        const std::string name = type;
        const std::size_t each = name == "SCALAR" ? 1
                                 : name == "VEC2" ? 2
                                 : name == "VEC3" ? 3
                                 : name == "VEC4" ? 4
                                                  : 16;
        return add_accessor(add_view(values), float_type, type, values.size() / each);
    }
    /// Mesh 0 at node 0.
    void show(const json& primitive) {
        root["meshes"] = json::array({{{"primitives", json::array({primitive})}}});
        root["nodes"] = json::array({{{"mesh", 0}}});
    }
    std::string text() const {
        json whole = root;
        if (!bytes.empty() && !whole.contains("buffers"))
            whole["buffers"] = json::array(
                {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}});
        return whole.dump();
    }
};

inline const std::vector<float> unit_triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// One triangle in the plane z = 0.
inline Document triangle_document() {
    Document document;
    document.show({{"attributes", {{"POSITION", document.add_floats(unit_triangle)}}}});
    return document;
}

/// Without the care (and the time) that write_file takes.
inline void save(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

inline SceneModel load_text(const std::string& text) {
    const std::filesystem::path file = test_folder() / "scene.gltf";
    save(file, text);
    Progress progress;
    return load_gltf(file, progress);
}

inline SceneModel load(const Document& document) { return load_text(document.text()); }
inline Scene scene_of(const Document& document) { return load(document).at(0.0); }

/// The message of the InputError that `work` ends with; a failure of the test where it does not.
inline std::string refusal(const std::function<void()>& work) {
    try {
        work();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    ADD_FAILURE() << "was accepted";
    return "";
}

inline std::string refusal(const Document& document) {
    return refusal([&] { load(document); });
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline void expect_near(vec3 actual, vec3 expected, float tolerance = 1e-5f) {
    EXPECT_LE(glm::length(actual - expected), tolerance)
        << actual.x << ' ' << actual.y << ' ' << actual.z << " instead of " << expected.x << ' ' << expected.y << ' '
        << expected.z;
}

}  // namespace sightlines::testing_gltf
