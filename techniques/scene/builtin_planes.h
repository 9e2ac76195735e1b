// The pieces of the built-in planes over a city; builtin_planes.cpp puts them together.
#pragma once

#include "techniques/scene/builtin_mesh.h"

namespace sightlines::planes {

/// Indices into materials().
enum MaterialIndex : std::uint32_t {
    asphalt,
    asphalt_worn,
    pavement,
    marking,
    lawn,
    lawn_dark,
    roof_grey,
    roof_dark,
    roof_pale,
    metal,
    metal_dark,
    tank_wood,
    glass_dark,  ///< three panes
    glass_blue,
    glass_pale,
    trim_pale,
    trim_dark,
    awning_red,
    awning_green,
    awning_blue,
    paint_white,
    paint_red,
    paint_grey,
    paint_black,
    car_white,  ///< six cars
    car_black,
    car_silver,
    car_red,
    car_blue,
    car_yellow,
    bark,
    leaf_dark,
    leaf_mid,
    leaf_light,
    first_wall,  ///< twelve tones of stone, brick, plaster and cladding
};
constexpr std::uint32_t wall_tones = 12;

std::vector<Material> materials();

/// A house on y = 0 over the rectangle of `size_m` (x, z) about the origin.
struct HouseShape {
    vec2 size_m{14.0f};
    int floors = 8;
    int style = 0;  ///< 0: windows with sills; 1: ribbons of glass; 2: a glass tower with fins; 3: balconies
    std::uint32_t wall = first_wall;
};
Mesh house_mesh(const HouseShape& shape, std::uint32_t seed);
constexpr float floor_height = 3.3f;

Mesh car_mesh(std::uint32_t paint);
Mesh lamp_mesh();
/// Two engines, nose towards +x, its middle at the origin; `plane_span` from wing tip to wing tip.
Mesh plane_mesh();
constexpr float plane_span = 29.0f;

}  // namespace sightlines::planes
