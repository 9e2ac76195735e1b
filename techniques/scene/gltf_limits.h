// How large an untrusted glTF file may make us: each limit is named by the message of whoever runs into it.
#pragma once

#include <cstdint>

namespace sightlines::gltf_limits {

constexpr std::uint64_t file_bytes = std::uint64_t{1} << 31;     ///< the file, and all its external files together
constexpr std::uint64_t json_bytes = std::uint64_t{1} << 27;     ///< the JSON text, data URIs included
constexpr std::uint64_t json_values = std::uint64_t{1} << 23;    ///< members and elements of the JSON document
constexpr int json_depth = 64;                                   ///< brackets inside brackets
constexpr std::uint64_t vertices = std::uint64_t{1} << 25;       ///< kept, and again after instancing
constexpr std::uint64_t vertices_read = std::uint64_t{1} << 28;  ///< primitives may share vertices: read anew for each
constexpr std::uint64_t triangles = std::uint64_t{1} << 25;      ///< kept, and again after instancing
constexpr std::uint64_t keyframe_values = std::uint64_t{1} << 25;  ///< floats of all animations together
constexpr std::uint64_t texels = std::uint64_t{1} << 27;           ///< of all pictures together
constexpr int image_side = 16384;                                  ///< width or height of one picture
constexpr std::uint64_t nodes = std::uint64_t{1} << 20;
constexpr int node_depth = 256;
constexpr std::uint32_t joint_sets = 4;  ///< JOINTS_0 to JOINTS_3: 16 joints a vertex
constexpr float coordinate_m = 1.0e9f;   ///< of a vertex in the world

}  // namespace sightlines::gltf_limits
