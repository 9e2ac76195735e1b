// A tree of boxes over a scene's triangles for devices that have no ray tracing of their own (shaders/ray_tree.h),
// built by Embree's builder. Embree's own tree cannot be read.
#pragma once

#include <cstdint>
#include <vector>

#include "shaders/ray_tree_data.h"
#include "techniques/base/progress.h"
#include "techniques/rays/embree_scene.h"

namespace sightlines {

/// The three tables of shaders/ray_tree_data.h. A scene without triangles has no nodes.
struct RayTree {
    std::vector<uvec4> nodes;      ///< [N][2]
    std::vector<uvec4> triangles;  ///< [T][3], leaf by leaf
    std::vector<uvec4> cutouts;

    std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes.size() / 2); }
    std::size_t bytes() const { return (nodes.size() + triangles.size() + cutouts.size()) * sizeof(uvec4); }
};

/// The same triangles for devices that sort them by themselves.
struct TriangleTables {
    std::vector<uvec4> opaque, masked;  ///< [..][3] each, as RayTree::triangles; all of `masked` have records
    std::vector<uvec4> cutouts;         ///< as RayTree's
};

TriangleTables list_triangles(const EmbreeScene& embree);
std::uint64_t triangle_count(const EmbreeScene& embree);

/// Over the triangles of `embree`, with its holes. EnvironmentError where memory runs out or there are more than 2^29
/// triangles.
RayTree build_ray_tree(const EmbreeScene& embree, int threads, Progress& progress);

}  // namespace sightlines
