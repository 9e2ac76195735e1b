// A small toolkit for the built-in scenes: meshes put together from patches, boxes, lathe work and tubes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "techniques/base/random.h"
#include "techniques/scene/scene.h"

namespace sightlines {

/// Triangles in a frame of their own, in metres, counter-clockwise as seen from the side that their normals point to.
struct Mesh {
    std::vector<vec3> positions, normals;  ///< [V]; normals unit
    std::vector<uvec3> triangles;          ///< [T]
    std::vector<std::uint32_t> materials;  ///< [T]
};

/// Uniform random numbers in order, each a hash of (stream, position): a helper for code that draws many.
struct Draws {
    std::uint32_t stream = 0;
    std::uint32_t next_sample = 0;

    float unit() { return random_unit(0x51c17, stream, next_sample++); }
    float between(float low, float high) { return low + (high - low) * unit(); }
    std::uint32_t below(std::uint32_t count) { return random_u32(0x51c17, stream, next_sample++) % count; }
};

std::uint32_t add_vertex(Mesh& mesh, vec3 position, vec3 normal);

/// One without area (as at a surface's poles) is left out.
void add_triangle(Mesh& mesh, uvec3 vertices, std::uint32_t material);

/// A flat parallelogram that faces cross(edge_u, edge_v), divided evenly. `material_of` names each division's material.
void add_quad(Mesh& mesh, vec3 corner, vec3 edge_u, vec3 edge_v, ivec2 divisions,
              const std::function<std::uint32_t(ivec2)>& material_of);
void add_quad(Mesh& mesh, vec3 corner, vec3 edge_u, vec3 edge_v, std::uint32_t material);

/// A flat convex polygon, its corners counter-clockwise as seen from the side that it faces.
void add_polygon(Mesh& mesh, std::span<const vec3> corners, std::uint32_t material);

void add_box(Mesh& mesh, const Box3& box, std::uint32_t material);

/// A box whose upper edges are cut off by `bevel_m`, without its underside: a paving stone.
void add_tile(Mesh& mesh, const Box3& box, float bevel_m, std::uint32_t material);

/// Smooth surface point(u, v), u and v in [0, 1], facing d(point)/du x d(point)/dv. `closed_u`: u = 0 and u = 1 meet.
void add_surface(Mesh& mesh, ivec2 divisions, bool closed_u, const std::function<vec3(vec2)>& point,
                 std::uint32_t material);

/// Lathe work about the y axis: `profile` holds (radius, height) with the material on its left as one walks along it
/// (from the bottom up for the outside). Edges sharper than 40 degrees stay sharp.
void add_revolution(Mesh& mesh, std::span<const vec2> profile, int segments, std::uint32_t material);

/// One ring of a tube: its middle and radius.
struct TubeRing {
    vec3 centre{0.0f};
    float radius = 0.0f;
};

/// A smooth tube through the rings, open at the beginning and pointed or open at the end.
void add_tube(Mesh& mesh, std::span<const TubeRing> rings, int sides, std::uint32_t material);

/// A leaf of two triangles folded along its midrib: from `base` along `direction` (unit), `side` (unit) across.
void add_leaf(Mesh& mesh, vec3 base, vec3 direction, vec3 side, float length_m, float width_m, std::uint32_t material);

/// Adds `added`, moved by a rigid or evenly scaling matrix.
void append(Mesh& mesh, const Mesh& added, const mat4& mesh_from_added);

/// Adds the mesh to the scene as a part: one instance of mesh number `mesh_number`, placed by a rigid or evenly scaling
/// matrix.
void add_part(Scene& scene, const Mesh& mesh, const std::string& name, std::uint32_t mesh_number,
              const mat4& world_from_part);

/// The bounds of the scene's vertices.
Box3 tight_bounds(const Scene& scene);

/// A diffuse, double-sided, opaque material.
Material diffuse(const std::string& name, vec3 base_color, float roughness = 1.0f);

/// Moved to `position` and turned about the y axis: the part's +x points along (cos, 0, -sin) of `turn_deg`.
mat4 placed(vec3 position, float turn_deg = 0.0f, float scale = 1.0f);

}  // namespace sightlines
