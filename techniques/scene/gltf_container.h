// The outermost layer of a glTF file: one JSON document, and the binary chunk of a `.glb`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace sightlines {

struct GltfContainer {
    nlohmann::json document;
    std::vector<std::uint8_t> file_bytes;
    std::optional<std::span<const std::uint8_t>> binary_chunk;  ///< into file_bytes
    std::vector<std::string> notes;
};

/// Reads the whole file (binary where it starts with "glTF" or is named `.glb`), checks the chunks and parses the JSON.
/// InputError for anything else than well-formed JSON of bounded size and depth whose root is an object.
GltfContainer read_gltf_container(const std::filesystem::path& file);

}  // namespace sightlines
