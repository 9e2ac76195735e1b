// Triangles out of primitives: modes, indices, vertex attributes, joints, morph targets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/base/types.h"
#include "techniques/scene/gltf_source.h"

namespace sightlines {

/// How one morph target moves each vertex at weight 1.
struct MorphTarget {
    std::vector<vec3> positions;  ///< [V] or empty
    std::vector<vec3> normals;    ///< [V] or empty
};

/// Triangles of one material, in the mesh's own space. Every vertex is used by a triangle.
struct GltfPrimitive {
    std::vector<vec3> positions;               ///< [V]
    std::vector<vec3> normals;                 ///< [V], unit
    std::vector<vec2> texture_coordinates[2];  ///< [V] or empty
    std::vector<uvec3> triangles;
    std::uint32_t material = 0;
    bool flat_normals = false;            ///< the file has none: each triangle has three vertices of its own
    std::uint32_t joints_per_vertex = 0;  ///< 0 or a multiple of 4
    std::vector<std::uint32_t> joints;    ///< [V * joints_per_vertex], index into the skin's joints
    std::vector<float> joint_weights;     ///< [V * joints_per_vertex], each vertex's sum to 1
    std::vector<MorphTarget> targets;
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;  ///< those with triangles
    std::uint32_t joints_needed = 0;        ///< of a skin: the highest index used, plus one
    std::size_t target_count = 0;           ///< the same for all primitives
    std::vector<float> weights;             ///< [target_count], where neither node nor animation says otherwise
};

/// All meshes of the document. A primitive that names no material gets the number after the document's last. InputError
/// for an index past the vertices, attributes of different lengths, wrong types, values that are not finite, and sizes
/// beyond the limits.
std::vector<GltfMesh> load_gltf_meshes(GltfSource& source, Progress& progress);

/// The unit normal of a triangle (+Y where it has no area).
vec3 triangle_normal(vec3 a, vec3 b, vec3 c);

}  // namespace sightlines
