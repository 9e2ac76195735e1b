#include "techniques/scene/gltf_source.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/gltf_accessors.h"
#include "techniques/scene/gltf_container.h"
#include "techniques/scene/gltf_files.h"
#include "techniques/scene/gltf_limits.h"
#include "techniques/scene/gltf_schema.h"

namespace sightlines {
namespace {

using nlohmann::json;

std::vector<std::uint8_t> external_bytes(const GltfSource& source, const std::string& place, const std::string& uri) {
    if (is_data_uri(uri)) {
        auto bytes = decode_data_uri(uri);
        if (!bytes)
            throw InputError(source.file, place, "is a malformed data URI",
                             "write `data:application/octet-stream;base64,...`");
        return std::move(*bytes);
    }
    std::uint64_t used = 0;
    for (const auto& bytes : source.storage) used += bytes.size();
    return read_file(confined_path(source.file, place, source.folder, uri),
                     gltf_limits::file_bytes - std::min(used, gltf_limits::file_bytes));
}

void read_buffers(GltfSource& source, const json& buffers, std::optional<std::span<const std::uint8_t>> binary_chunk,
                  bool is_glb) {
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string place = gltf_place("buffers", i);
        GltfBuffer buffer{buffers[i].at("byteLength").get<std::uint64_t>(), std::nullopt};
        if (buffers[i].contains("uri")) {
            source.storage.push_back(external_bytes(source, place + ".uri", buffers[i].at("uri").get<std::string>()));
            buffer.bytes = source.storage.back();
        } else if (i == 0 && is_glb) {
            if (!binary_chunk) throw InputError(source.file, place, "the file has no binary chunk", "export it again");
            buffer.bytes = binary_chunk;
        }
        if (buffer.bytes && buffer.bytes->size() < buffer.byte_length)
            throw InputError(source.file, place,
                             "declares " + std::to_string(buffer.byte_length) + " bytes and has " +
                                 std::to_string(buffer.bytes->size()),
                             "the data is cut short");
        if (buffer.bytes) buffer.bytes = buffer.bytes->first(buffer.byte_length);
        source.buffers.push_back(buffer);
    }
}

void locate_images(GltfSource& source, const json& images) {
    for (std::size_t i = 0; i < images.size(); ++i) {
        GltfImage image;
        image.place = gltf_place("images", i);
        if (images[i].contains("bufferView")) image.buffer_view = images[i].at("bufferView").get<int>();
        if (images[i].contains("uri")) {
            const std::string uri = images[i].at("uri").get<std::string>();
            if (image.buffer_view)
                throw InputError(source.file, image.place, "has both `uri` and `bufferView`", "keep one");
            if (is_data_uri(uri))
                image.data_uri = uri;
            else
                image.path = confined_path(source.file, image.place + ".uri", source.folder, uri);
        }
        source.images.push_back(std::move(image));
    }
}

json taken(json& document, const char* property) {
    json value = document.contains(property) ? std::move(document.at(property)) : json::array();
    document.erase(property);
    return value;
}

/// A channel without a node belongs to an extension (KHR_animation_pointer); the parser would refuse the whole file.
void drop_channels_without_node(json& document, std::vector<std::string>& notes) {
    if (!document.contains("animations")) return;
    for (json& animation : document.at("animations")) {
        json kept = json::array();
        for (json& channel : animation.at("channels")) {
            if (channel.at("target").contains("node"))
                kept.push_back(std::move(channel));
            else
                add_note(notes, "animation channels that move something else than a node are ignored");
        }
        animation.at("channels") = std::move(kept);
    }
}

/// The parser gets the checked document and nothing else: no bytes to decode, no file to open, nothing unchecked.
void parse_document(GltfSource& source, const json& document) {
    const std::string text = document.dump();
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({nullptr, nullptr, nullptr, nullptr, nullptr});
    std::string problems, warnings;
    const bool parsed = parser.LoadASCIIFromString(&source.document, &problems, &warnings, text.c_str(),
                                                   static_cast<unsigned int>(text.size()), "");
    if (!parsed)
        throw InputError(source.file, "", problems.empty() ? "cannot be parsed as glTF" : problems.substr(0, 300));
}

}  // namespace

void add_note(std::vector<std::string>& notes, const std::string& note) {
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
}

std::string gltf_place(const std::string& array, std::size_t index) {
    return array + "[" + std::to_string(index) + "]";
}

GltfSource read_gltf_source(const std::filesystem::path& file) {
    GltfContainer container = read_gltf_container(file);
    GltfSource source;
    source.file = file.string();
    source.folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    source.notes = std::move(container.notes);
    const std::span<const std::uint8_t> file_bytes = container.file_bytes;
    const bool is_glb = file_bytes.size() >= 4 && std::equal(file_bytes.begin(), file_bytes.begin() + 4, "glTF");
    source.storage.push_back(std::move(container.file_bytes));  // moving keeps the chunk's span valid

    check_gltf_schema(source.file, container.document);
    check_gltf_version_and_extensions(source.file, container.document, source.notes);
    read_buffers(source, taken(container.document, "buffers"), container.binary_chunk, is_glb);
    locate_images(source, taken(container.document, "images"));
    drop_channels_without_node(container.document, source.notes);
    parse_document(source, container.document);
    check_views_and_accessors(source);
    return source;
}

}  // namespace sightlines
