// The pieces of the built-in street; builtin_street.cpp puts them together.
#pragma once

#include "techniques/scene/builtin_mesh.h"

namespace sightlines::street {

/// Indices into materials().
enum MaterialIndex : std::uint32_t {
    cobble,  ///< three tones
    cobble_warm,
    cobble_dark,
    joint,
    slab,  ///< three tones
    slab_warm,
    slab_dark,
    kerb,
    trim,
    trim_dark,
    slate,  ///< three tones
    slate_blue,
    slate_dark,
    zinc,
    glass,
    glass_lit,
    curtain,
    window_frame,
    iron,
    brass,
    chimney,
    pot,
    canvas_red,
    canvas_green,
    canvas_cream,
    timber,
    cane,
    marble,
    bottle,
    wine,
    porcelain,
    bulb,
    lantern,
    tyre,
    paint_red,
    paint_blue,
    paint_cream,
    water,
    bark,
    leaf_dark,  ///< three tones
    leaf_mid,
    leaf_light,
    ivy_dark,  ///< three tones
    ivy_mid,
    ivy_light,
    petal_red,  ///< three tones
    petal_pink,
    petal_white,
    first_wall,                      ///< eight tones of plaster and stone
    first_shutter = first_wall + 8,  ///< five paints
};
constexpr std::uint32_t wall_tones = 8, shutter_tones = 5;

std::vector<Material> materials();

constexpr float ground_floor_height = 4.1f, floor_height = 3.35f;

/// A house whose front stands on the x axis, its middle at the origin, and faces +z.
struct HouseShape {
    float width_m = 9.0f, depth_m = 9.0f;
    int upper_floors = 4;
    bool left_front = false, right_front = false;  ///< windows on that side too, as one faces the house
    bool ivy = false;
    std::uint32_t wall = first_wall, shutter = first_shutter, canvas = canvas_red;
};
Mesh house_mesh(const HouseShape& shape, std::uint32_t seed);

/// A wall with its windows, 0 to `width_m` along x, at z = 0, facing +z (builtin_street_front.cpp).
Mesh front_mesh(const HouseShape& shape, float width_m, std::uint32_t seed);

/// A rectangle that faces +z.
void add_panel(Mesh& mesh, vec2 low, vec2 high, float z, std::uint32_t material);

/// The wall between `low` and `high` round an opening, its reveals, and a pane behind it.
struct Opening {
    vec2 low{0.0f}, high{0.0f};            ///< of the wall
    vec2 open_low{0.0f}, open_high{0.0f};  ///< of the hole
    float depth_m = 0.25f;
    std::uint32_t wall = first_wall, pane = glass;
};
void add_opening(Mesh& mesh, const Opening& opening);

/// The ground floor: a shop between pilasters, with awning and sign, or a gate.
void add_shop(Mesh& mesh, vec2 low, vec2 high, const HouseShape& shape, Draws& draws);

/// Things that stand in the street, on y = 0.
Mesh table_mesh(std::uint32_t seed);  ///< with what is drunk at it
Mesh chair_mesh();                    ///< one sits facing +z
Mesh parasol_mesh(std::uint32_t canvas);
Mesh lamp_mesh();
Mesh bicycle_mesh(std::uint32_t paint);  ///< its front wheel towards +x
Mesh planter_mesh(std::uint32_t seed);
Mesh fountain_mesh();
/// A cable that sags from `from` to `to`, with bulbs.
Mesh string_of_lights_mesh(vec3 from, vec3 to);

}  // namespace sightlines::street
