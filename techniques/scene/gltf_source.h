// A glTF file that has been read and checked, before it becomes a scene: the document and the bytes it refers to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace sightlines {

struct GltfBuffer {
    std::uint64_t byte_length = 0;                       ///< as declared
    std::optional<std::span<const std::uint8_t>> bytes;  ///< exactly byte_length; nothing where the file gives none
};

/// A picture before decoding.
struct GltfImage {
    std::string place;     ///< "images[2]"
    std::string data_uri;  ///< one of these three, or none where another extension would bring it
    std::filesystem::path path;
    std::optional<int> buffer_view;
};

struct GltfSource {
    std::string file;  ///< as messages name it
    std::filesystem::path folder;
    tinygltf::Model document;  ///< without buffers and images: those are below, resolved by us
    std::vector<GltfBuffer> buffers;
    std::vector<GltfImage> images;
    std::vector<std::string> notes;
    std::vector<std::vector<std::uint8_t>> storage;  ///< what the spans point into
};

/// Reads the file and all its buffers, and checks everything that does not depend on decoded content: container,
/// schema, references, versions, required extensions, where external files lie, and the bounds of every view and
/// accessor. Every index in `document` is valid afterwards. InputError otherwise.
GltfSource read_gltf_source(const std::filesystem::path& file);

/// Appends `note` unless it is there.
void add_note(std::vector<std::string>& notes, const std::string& note);

/// "accessors[3]"
std::string gltf_place(const std::string& array, std::size_t index);

}  // namespace sightlines
