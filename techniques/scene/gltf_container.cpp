#include "techniques/scene/gltf_container.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string_view>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/gltf_limits.h"

namespace sightlines {
namespace {

constexpr std::uint32_t magic_gltf = 0x46546C67u;    // "glTF"
constexpr std::uint32_t chunk_json = 0x4E4F534Au;    // "JSON"
constexpr std::uint32_t chunk_binary = 0x004E4942u;  // "BIN\0"

using Bytes = std::span<const std::uint8_t>;

std::uint32_t little_endian_u32(Bytes bytes, std::size_t offset) {
    return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8u |
           static_cast<std::uint32_t>(bytes[offset + 2]) << 16u | static_cast<std::uint32_t>(bytes[offset + 3]) << 24u;
}

bool is_binary(const std::filesystem::path& file, Bytes bytes) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char letter) { return std::tolower(letter); });
    return extension == ".glb" || (bytes.size() >= 4 && little_endian_u32(bytes, 0) == magic_gltf);
}

struct Chunks {
    Bytes json;
    std::optional<Bytes> binary;
    bool extra_data = false;
};

Chunks split_chunks(const std::string& file, Bytes bytes) {
    const std::string cut = "the file is cut short: copy or export it again";
    if (bytes.size() < 12) throw InputError(file, "", "is shorter than the header of a GLB file (12 bytes)", cut);
    if (little_endian_u32(bytes, 0) != magic_gltf) throw InputError(file, "", "does not start with `glTF`");
    if (const std::uint32_t version = little_endian_u32(bytes, 4); version != 2)
        throw InputError(file, "", "is GLB version " + std::to_string(version), "export it as glTF 2.0");
    const std::uint64_t length = little_endian_u32(bytes, 8);
    if (length > bytes.size())
        throw InputError(
            file, "", "declares " + std::to_string(length) + " bytes and holds " + std::to_string(bytes.size()), cut);
    if (length < 20)
        throw InputError(file, "", "declares a length of " + std::to_string(length) + ", too small for a chunk");

    Chunks chunks;
    chunks.extra_data = bytes.size() > length;
    std::size_t offset = 12;
    for (int index = 0; offset < length; ++index) {
        const std::string place = "chunk " + std::to_string(index);
        if (length - offset < 8) throw InputError(file, place, "its header is incomplete", cut);
        const std::uint64_t size = little_endian_u32(bytes, offset);
        const std::uint32_t type = little_endian_u32(bytes, offset + 4);
        offset += 8;
        if (size > length - offset) throw InputError(file, place, "reaches past the end of the file", cut);
        if (size % 4 != 0) throw InputError(file, place, "its length is not a multiple of 4");
        const Bytes content = bytes.subspan(offset, size);
        offset += size;
        if (index == 0) {
            if (type != chunk_json) throw InputError(file, place, "the first chunk is not the JSON document");
            if (size == 0) throw InputError(file, place, "the JSON document is empty");
            chunks.json = content;
        } else if (type == chunk_json || (type == chunk_binary && chunks.binary)) {
            throw InputError(file, place, "there is a second chunk of the same type");
        } else if (type == chunk_binary) {
            chunks.binary = content;
        }
    }
    return chunks;
}

/// Parsers and destructors of nested values may recurse, and each value costs far more memory than its text: neither
/// brackets by the million inside each other nor values by the hundred million must reach the parser.
void check_depth_and_values(const std::string& file, std::string_view json) {
    int depth = 0;
    std::uint64_t values = 0;
    bool in_text = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char letter = json[i];
        if (in_text) {
            if (letter == '\\') ++i;
            if (letter == '"') in_text = false;
        } else if (letter == '"') {
            in_text = true;
        } else if (letter == '{' || letter == '[') {
            if (++depth > gltf_limits::json_depth)
                throw InputError(file, "byte " + std::to_string(i) + " of the JSON document",
                                 "nests deeper than the limit of " + std::to_string(gltf_limits::json_depth));
        } else if (letter == '}' || letter == ']') {
            --depth;
        }
        if (!in_text && (letter == ',' || letter == '{' || letter == '[')) ++values;
    }
    if (values > gltf_limits::json_values)
        throw InputError(
            file, "",
            "its JSON document holds more than the limit of " + std::to_string(gltf_limits::json_values) + " values",
            "split the scene");
}

nlohmann::json parse_json(const std::string& file, Bytes bytes) {
    std::string_view json(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    while (!json.empty() && json.back() == '\0') json.remove_suffix(1);  // some exporters pad the chunk with zeros
    if (json.size() > gltf_limits::json_bytes)
        throw InputError(file, "",
                         "its JSON document holds " + std::to_string(json.size()) + " bytes; the limit is " +
                             std::to_string(gltf_limits::json_bytes),
                         "keep buffers in .bin files or use .glb");
    if (std::ranges::all_of(json, [](unsigned char letter) { return std::isspace(letter) != 0; }))
        throw InputError(file, "", "is empty");
    check_depth_and_values(file, json);
    try {
        nlohmann::json document = nlohmann::json::parse(json.begin(), json.end());
        if (!document.is_object()) throw InputError(file, "", "its JSON document is not an object");
        return document;
    } catch (const nlohmann::json::exception& failure) {
        std::string reason = failure.what();
        if (const std::size_t bracket = reason.find("] "); bracket != std::string::npos) reason.erase(0, bracket + 2);
        throw InputError(file, "", "is not valid JSON: " + reason.substr(0, 200));
    }
}

}  // namespace

GltfContainer read_gltf_container(const std::filesystem::path& file) {
    GltfContainer container;
    container.file_bytes = read_file(file, gltf_limits::file_bytes);
    const std::string name = file.string();
    if (!is_binary(file, container.file_bytes)) {
        container.document = parse_json(name, container.file_bytes);
        return container;
    }
    const Chunks chunks = split_chunks(name, container.file_bytes);
    container.document = parse_json(name, chunks.json);
    container.binary_chunk = chunks.binary;
    if (chunks.extra_data) container.notes.push_back("data after the end of the GLB container is ignored");
    return container;
}

}  // namespace sightlines
