// Shapes that several built-in scenes are put together from.
#pragma once

#include <functional>
#include <span>

#include "techniques/scene/builtin_mesh.h"

namespace sightlines {

/// A matrix whose columns are where x, y and z go, and the origin.
mat4 framed(vec3 x, vec3 y, vec3 z, vec3 origin);

/// Turned about an axis through the origin.
mat4 turned_about(vec3 axis, float angle_rad);

/// A flat polygon without crossings, convex or not, its corners counter-clockwise as seen from the side that it faces.
void add_outline(Mesh& mesh, std::span<const vec3> corners, std::uint32_t material);

/// A closed beam of rectangular section from `from` to `to`; `up` decides which way its height points.
void add_beam(Mesh& mesh, vec3 from, vec3 to, float width_m, float height_m, std::uint32_t material,
              vec3 up = {0.0f, 1.0f, 0.0f});

/// A closed round rod.
void add_rod(Mesh& mesh, vec3 from, vec3 to, float radius_m, int sides, std::uint32_t material);

/// A closed ellipsoid, its poles along y.
void add_ball(Mesh& mesh, vec3 centre, vec3 radii, int segments, std::uint32_t material);

/// Eight triangles: a bulb.
void add_octahedron(Mesh& mesh, vec3 centre, float radius_m, std::uint32_t material);

/// A box whose edges and corners are rounded by `radius_m`: upholstery. `steps` divisions of each rounded edge.
void add_cushion(Mesh& mesh, const Box3& box, float radius_m, int steps, std::uint32_t material);

/// Pulls `profile` (across, up; counter-clockwise as seen looking along the path) along the path, its edges sharp.
/// "Up" is `binormal`, square to the whole path or nearly so; "across" is along x binormal. `closed_path`: ends meet.
void add_sweep(Mesh& mesh, std::span<const vec3> path, vec3 binormal, std::span<const vec2> profile, bool closed_path,
               std::uint32_t material);

/// A prism over a convex outline (x, z), counter-clockwise as seen from above, without its underside.
void add_prism(Mesh& mesh, std::span<const vec2> outline, float low_y, float high_y, std::uint32_t wall,
               std::uint32_t top);

/// A point and the way out of what it is on.
struct SurfaceSpot {
    vec3 point{0.0f}, normal{0.0f, 1.0f, 0.0f};
};

/// `count` leaves, strewn where `spot` says, standing off as far as `lift_m`, in one of `tones` materials from `first`.
struct LeafCover {
    std::uint32_t count = 0;
    float length_m = 0.1f, width_share = 0.55f, lift_m = 0.04f;
    float steepness = 0.7f;  ///< 0: flat on the surface; 1: as much outwards as along
    std::uint32_t first = 0, tones = 3;
};
void add_leaf_cover(Mesh& mesh, const LeafCover& cover, Draws& draws, const std::function<SurfaceSpot(Draws&)>& spot);

/// Spots on a box (without its underside), evenly by area; on an upright cone or a ball.
SurfaceSpot spot_on_box(const Box3& box, Draws& draws);
SurfaceSpot spot_on_cone(vec3 foot, float radius_m, float height_m, Draws& draws);
SurfaceSpot spot_on_ball(vec3 centre, vec3 radii, Draws& draws);

/// A broad-leaved tree: trunk and boughs with `leaves` leaves in clouds about their ends, on y = 0.
struct TreeShape {
    float height_m = 7.0f, crown_radius_m = 2.4f, trunk_radius_m = 0.18f;
    std::uint32_t leaves = 2000;
    float leaf_length_m = 0.24f;
    std::uint32_t bark = 0, first_leaf = 0, tones = 3;
};
Mesh tree_mesh(const TreeShape& shape, std::uint32_t seed);

/// Smooth noise of the plane in [0, 1], its features about one unit wide.
float smooth_noise(vec2 place, std::uint32_t seed);

}  // namespace sightlines
