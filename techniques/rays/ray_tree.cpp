#include "techniques/rays/ray_tree.h"

#include <array>
#include <atomic>
#include <bit>
#include <cstring>

#include <tbb/task_arena.h>

#include "techniques/base/error.h"
#include "techniques/base/parallel.h"
#include "techniques/rays/embree_handles.h"

namespace sightlines {
namespace {

constexpr unsigned most_in_leaf = 4;
constexpr std::size_t most_triangles = std::size_t{1} << 29U;

struct ReleaseBuilder {
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
using BuilderHandle = std::unique_ptr<RTCBVHTy, ReleaseBuilder>;

/// A node while Embree builds: a leaf where `count` is not 0.
struct BuiltNode {
    std::array<Box3, 2> bounds;  ///< of the children
    std::array<BuiltNode*, 2> children{};
    std::array<std::uint32_t, most_in_leaf> triangles{};
    std::uint32_t count = 0;
};

/// A triangle of either geometry.
struct SourceTriangle {
    std::array<vec3, 3> corners;
    std::uint32_t cutout = no_cutout;
};

/// What Embree's call backs may touch.
struct Building {
    Progress& progress;
    std::atomic<int> percent{0};
};

void* new_node(RTCThreadLocalAllocator allocator, unsigned /*children*/, void* /*user*/) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), 16)) BuiltNode();
}

void set_children(void* node, void** children, unsigned count, void* /*user*/) {
    for (unsigned k = 0; k < count; ++k)
        static_cast<BuiltNode*>(node)->children[k] = static_cast<BuiltNode*>(children[k]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void* /*user*/) {
    for (unsigned k = 0; k < count; ++k) {
        const RTCBounds& box = *bounds[k];
        static_cast<BuiltNode*>(node)->bounds[k] = {{box.lower_x, box.lower_y, box.lower_z},
                                                    {box.upper_x, box.upper_y, box.upper_z}};
    }
}

void* new_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
               void* /*user*/) {
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), 16)) BuiltNode();
    leaf->count = static_cast<std::uint32_t>(count);
    for (std::size_t k = 0; k < count; ++k) leaf->triangles[k] = primitives[k].primID;
    return leaf;
}

/// Exceptions must not pass through Embree.
bool report(void* user, double fraction) {
    auto& building = *static_cast<Building*>(user);
    const int now = std::clamp(static_cast<int>(fraction * 100.0), 0, 100), before = building.percent.exchange(now);
    try {
        if (before < now) building.progress.advance(now - before);
    } catch (const Cancelled&) {
        return false;
    }
    return !building.progress.cancelled();
}

std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number); }
uvec4 words(vec3 corner, std::uint32_t last) { return {bits(corner.x), bits(corner.y), bits(corner.z), last}; }

std::uint32_t wrap_number(Wrap wrap) {
    return wrap == Wrap::repeat ? wrap_repeats : wrap == Wrap::mirrored_repeat ? wrap_mirrors : wrap_clamps;
}

/// The textures' records and alpha; their places.
std::vector<std::uint32_t> place_masks(const MaskedTriangles& masked, std::vector<uvec4>& cutouts) {
    std::vector<std::uint32_t> places;
    for (const AlphaMask& mask : masked.masks) {
        const auto place = static_cast<std::uint32_t>(cutouts.size());
        places.push_back(place);
        cutouts.emplace_back(mask.size.width, mask.size.height, wrap_number(mask.wrap_u), wrap_number(mask.wrap_v));
        cutouts.emplace_back(bits(mask.factor), bits(mask.cutoff), place + 2, 0);
        cutouts.resize(cutouts.size() + (mask.alpha.size() + 15) / 16, uvec4(0));
        std::memcpy(&cutouts[place + 2], mask.alpha.data(), mask.alpha.size());
    }
    return places;
}

void add_triangles(const EmbreeScene& embree, std::vector<uvec4>& cutouts, std::vector<SourceTriangle>& triangles) {
    if (embree.fixed) add_triangles(*embree.fixed, cutouts, triangles);
    const std::vector<std::uint32_t> masks = place_masks(embree.masked, cutouts);
    for (const unsigned id : {opaque_geometry, masked_geometry}) {
        const std::size_t count = embree.scene_triangles[id].size();
        if (count == 0) continue;
        const auto* indices = static_cast<const uvec3*>(rtcGetGeometryBufferData(
            rtcGetGeometry(embree.scene.get(), geometry_number(embree, id)), RTC_BUFFER_TYPE_INDEX, 0));
        for (std::size_t k = 0; k < count; ++k) {
            SourceTriangle triangle;
            for (int corner = 0; corner < 3; ++corner)
                triangle.corners[static_cast<std::size_t>(corner)] = embree.positions[indices[k][corner]];
            if (id == masked_geometry) {
                const MaskedTriangle& from = embree.masked.triangles[k];
                triangle.cutout = static_cast<std::uint32_t>(cutouts.size());
                cutouts.emplace_back(bits(from.corners[0].x), bits(from.corners[0].y), bits(from.corners[1].x),
                                     bits(from.corners[1].y));
                cutouts.emplace_back(bits(from.corners[2].x), bits(from.corners[2].y), masks[from.mask], 0);
            }
            triangles.push_back(triangle);
        }
    }
}

std::vector<SourceTriangle> all_triangles(const EmbreeScene& embree, std::vector<uvec4>& cutouts) {
    std::vector<SourceTriangle> triangles;
    add_triangles(embree, cutouts, triangles);
    return triangles;
}

void add_words(const SourceTriangle& triangle, std::vector<uvec4>& to) {
    to.push_back(words(triangle.corners[0], triangle.cutout));
    to.push_back(words(triangle.corners[1], 0));
    to.push_back(words(triangle.corners[2], 0));
}

Box3 bounds_of(const SourceTriangle& triangle) {
    Box3 box;
    for (const vec3 corner : triangle.corners) box.add(corner);
    return box;
}

std::vector<RTCBuildPrimitive> primitives_of(const std::vector<SourceTriangle>& triangles) {
    std::vector<RTCBuildPrimitive> primitives(triangles.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const Box3 box = bounds_of(triangles[k]);
        primitives[k] = {box.lowest.x,  box.lowest.y,  box.lowest.z,  0,
                         box.highest.x, box.highest.y, box.highest.z, static_cast<unsigned>(k)};
    }
    return primitives;
}

/// The tree in depth-first order, the child with the larger surface first: a ray is more likely to end there.
struct Flattening {
    const std::vector<SourceTriangle>& source;
    RayTree& tree;

    void add(const BuiltNode& node, const Box3& bounds) {
        const std::size_t at = tree.nodes.size();
        tree.nodes.push_back(words(bounds.lowest, 0));
        tree.nodes.push_back(words(bounds.highest, 0));
        if (node.count > 0) {
            const auto first = static_cast<std::uint32_t>(tree.triangles.size() / 3);
            tree.nodes[at + 1].w = first * leaf_scale + node.count;
            for (std::uint32_t k = 0; k < node.count; ++k) add_words(source[node.triangles[k]], tree.triangles);
        } else {
            const std::size_t larger = area(node.bounds[1]) > area(node.bounds[0]) ? 1 : 0;
            for (const std::size_t child : {larger, 1 - larger})
                if (node.children[child] != nullptr) add(*node.children[child], node.bounds[child]);
        }
        tree.nodes[at].w = tree.node_count();
    }
    static float area(const Box3& box) {
        const vec3 size = box.size();
        return size.x * size.y + size.y * size.z + size.z * size.x;
    }
};

}  // namespace

std::uint64_t triangle_count(const EmbreeScene& embree) {
    const std::uint64_t own =
        embree.scene_triangles[opaque_geometry].size() + embree.scene_triangles[masked_geometry].size();
    return embree.fixed ? own + triangle_count(*embree.fixed) : own;
}

TriangleTables list_triangles(const EmbreeScene& embree) {
    TriangleTables tables;
    for (const SourceTriangle& triangle : all_triangles(embree, tables.cutouts))
        add_words(triangle, triangle.cutout == no_cutout ? tables.opaque : tables.masked);
    return tables;
}

RayTree build_ray_tree(const EmbreeScene& embree, int threads, Progress& progress) {
    progress.begin("building the device's ray tree", 100);
    progress.check();
    RayTree tree;
    const std::vector<SourceTriangle> triangles = all_triangles(embree, tree.cutouts);
    if (triangles.empty()) return tree;
    if (triangles.size() >= most_triangles)
        throw EnvironmentError("ray tree", "more than 536 million triangles", "choose a smaller scene");
    std::vector<RTCBuildPrimitive> primitives = primitives_of(triangles);
    const BuilderHandle builder(rtcNewBVH(embree.device.get()));
    Building building{progress};
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 128;
    arguments.maxLeafSize = most_in_leaf;
    arguments.bvh = builder.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = new_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = new_leaf;
    arguments.buildProgress = report;
    arguments.userPtr = &building;
    const BuiltNode* root = nullptr;
    tbb::task_arena arena(thread_count(threads));
    arena.execute([&] { root = static_cast<const BuiltNode*>(rtcBuildBVH(&arguments)); });
    progress.check();
    if (root == nullptr) throw EnvironmentError("Embree", "could not build a tree", "choose a smaller scene");
    Box3 bounds;
    for (const SourceTriangle& triangle : triangles)
        for (const vec3 corner : triangle.corners) bounds.add(corner);
    Flattening{triangles, tree}.add(*root, bounds);
    return tree;
}

}  // namespace sightlines
