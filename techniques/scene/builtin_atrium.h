// The pieces of the built-in atrium, each in a frame of its own; builtin_atrium.cpp puts them together.
#pragma once

#include "techniques/scene/builtin_mesh.h"

namespace sightlines::atrium {

/// Indices into materials().
enum MaterialIndex : std::uint32_t {
    limestone,
    limestone_light,
    limestone_dark,
    marble,
    plaster,
    plaster_warm,
    plaster_pale,
    brick_red,
    tile_a,
    tile_b,
    tile_c,
    roof_tile,
    wood,
    wood_dark,
    bronze,
    water,
    crimson,
    ultramarine,
    saffron,
    emerald,
    clay,
    glaze_teal,
    glaze_white,
    soil,
    leaf_dark,
    leaf_mid,
    leaf_light,
    blade_green,
    twig,
    lantern_glass,
};

std::vector<Material> materials();

// Measures of the building, metres. The origin is the middle of the court, at the height of the arcades' floor.
constexpr float bay = 3.0f;                     ///< from column to column
constexpr int bays_x = 8, bays_z = 3;           ///< open arches along each side of the court
constexpr float court_x = 0.5f * bay * bays_x;  ///< half the distance between the columns' centres
constexpr float court_z = 0.5f * bay * bays_z;
constexpr float gallery_depth = 4.0f;  ///< column's centre to the outer wall's inner face
constexpr float wall_x = court_x + gallery_depth, wall_z = court_z + gallery_depth;
constexpr float wall_thickness = 0.5f;
constexpr float court_floor = -0.15f;
constexpr float column_height = 3.5f;  ///< base, shaft and capital, to the springing of the arches
constexpr float arch_radius = 1.1f;
constexpr float arcade_top = column_height + 1.65f;  ///< where the wall above the arches ends
constexpr float slab = 0.4f;
constexpr float upper_floor = arcade_top + slab;
constexpr float upper_top = upper_floor + arcade_top;
constexpr float eaves = upper_top + 0.35f;
constexpr float roof_top = eaves + 1.5f;

// Architecture (builtin_atrium_architecture.cpp).
/// A round column with base and capital on y = 0, its axis the y axis.
Mesh column_mesh();
/// A square pier of the same height, for the corners.
Mesh pier_mesh();
/// The wall above two columns at x = -bay / 2 and bay / 2, with its arch; springing at y = 0, middle plane z = 0.
Mesh arch_mesh();
/// A blind arch on a wall: the ring and jambs stand out from z = 0 towards +z; y = 0 is the floor.
Mesh blind_arch_mesh(std::uint32_t panel_material);
/// Handrail, plinth and balusters for one bay, along x, on y = 0.
Mesh balustrade_mesh();
/// Floors, steps, outer walls, slabs, beams and cornices.
Mesh floor_mesh();
Mesh walls_mesh();
Mesh slabs_mesh();
Mesh beams_mesh();
Mesh roof_mesh();

// Furnishing (builtin_atrium_furnishing.cpp).
/// Two halves of a curtain under an arch, gathered to the columns, on a rod at the springing; y = 0 is the floor.
Mesh curtain_mesh(std::uint32_t material, std::uint32_t seed);
/// A cloth slung from column to column, its folds hanging in chains; y = 0 is where it is tied, towards +z.
Mesh swag_mesh(std::uint32_t material);
/// A banner that hangs over a balustrade's rail (y = 0) towards +z.
Mesh banner_mesh(std::uint32_t material, std::uint32_t seed);
Mesh vase_mesh(std::uint32_t material);
/// What grows out of a vase's mouth at y = 0: a bush of about `leaves` leaves, or a fan of long blades.
Mesh bush_mesh(int leaves, std::uint32_t seed);
Mesh agave_mesh(int blades, std::uint32_t seed);
/// A fountain of two bowls on y = 0.
Mesh fountain_mesh();
/// A lantern on its chain, hung at y = 0; its lowest point is lantern_drop below.
Mesh lantern_mesh();
constexpr float lantern_drop = 1.16f;
/// A bench of wood and stone, for the galleries.
Mesh bench_mesh();

}  // namespace sightlines::atrium
