// The pieces of the built-in cathedral; builtin_cathedral.cpp puts them together.
#pragma once

#include "techniques/scene/builtin_mesh.h"

namespace sightlines::cathedral {

/// Indices into materials().
enum MaterialIndex : std::uint32_t {
    stone,
    stone_light,
    stone_dark,
    stone_warm,
    vault,
    floor_pale,
    floor_dark,
    floor_red,
    oak,
    oak_dark,
    brass,
    iron,
    candle,
    flame,
    cloth_red,
    cloth_white,
    lead,
    door_wood,
    glass_red,  ///< panes of eight colours, which glow
};
constexpr std::uint32_t glass_colours = 8;

std::vector<Material> materials();

// Measures, metres. x runs along the nave, the altar at +x; the origin is in the middle of the floor.
constexpr float bay = 6.0f;
constexpr int bays = 8;
constexpr float nave_end = 0.5f * bay * bays;  ///< |x| of the first and last piers
constexpr float nave_half = 5.5f;              ///< |z| of the piers
constexpr float aisle_wall = 11.5f;            ///< |z| of the aisles' outer walls
constexpr float pier_height = 7.0f;            ///< where the arcade springs
constexpr float gallery_floor = 11.6f;
constexpr float vault_spring = 14.0f, vault_rise = 7.0f;
constexpr float aisle_spring = 6.6f, aisle_rise = 3.9f;

/// A pointed arch's height over its springing at `x`, for a half span and a rise.
float pointed(float x, float half_span, float rise);

// Structure (builtin_cathedral_stone.cpp).
Mesh pier_mesh();
/// Four webs and the ribs of one bay, its middle at the origin; y = 0 is the springing.
Mesh vault_mesh(float half_x, float half_z, float rise);
/// A wall with a pointed opening, on y = 0, along x, its middle plane at z = 0.
struct OpeningShape {
    float half_wall, wall_height, half_span, sill, spring, rise, thickness;
};
void add_wall_with_opening(Mesh& mesh, const OpeningShape& shape, std::uint32_t material);
/// As many mouldings round an opening, one outside the other, towards +z at `z`.
void add_mouldings(Mesh& mesh, const OpeningShape& shape, float z, std::uint32_t material, int orders = 3);
/// Mullions, a rose of small arches, and glowing panes in a pattern of its own.
void add_window(Mesh& mesh, const OpeningShape& shape, int lancets, std::uint32_t seed);
Mesh arcade_bay_mesh();
/// Gallery, clerestory window and wall shafts over the arcade, facing +z (into the nave).
Mesh upper_bay_mesh(std::uint32_t seed);
Mesh aisle_bay_mesh(std::uint32_t seed);
Mesh west_front_mesh();
Mesh apse_mesh();
Mesh floor_mesh();

// Furnishing (builtin_cathedral_furnishing.cpp).
Mesh pew_mesh();
/// A ring of candles on a rod of `rod_m`, hung at y = 0.
constexpr int chandelier_candles = 16;
constexpr float chandelier_radius = 1.05f;
Mesh chandelier_mesh(float rod_m);
Mesh altar_mesh();
Mesh candlestick_mesh();
Mesh pulpit_mesh();

}  // namespace sightlines::cathedral
