// The pieces of the built-in garden; builtin_garden.cpp lays them out.
#pragma once

#include "techniques/scene/builtin_mesh.h"

namespace sightlines::garden {

/// Indices into materials().
enum MaterialIndex : std::uint32_t {
    gravel,
    gravel_light,
    gravel_dark,
    lawn,
    lawn_dark,
    lawn_light,
    soil,
    kerb,
    limestone,
    limestone_dark,
    stucco,
    stucco_trim,
    window_dark,
    roof_slate,
    timber,
    water,
    spray,
    terracotta,
    hedge_core,
    box_dark,  ///< three tones each from here on
    box_mid,
    box_light,
    yew_dark,
    yew_mid,
    yew_light,
    vine_dark,
    vine_mid,
    vine_light,
    blade_dark,
    blade_mid,
    blade_light,
    stem,
    red_deep,
    red_bright,
    red_pink,
    yellow_deep,
    yellow_bright,
    yellow_cream,
    violet_deep,
    violet_bright,
    violet_pale,
    white_pure,
    white_warm,
    white_blush,
};

std::vector<Material> materials();

// Measures, metres; the fountain stands at the origin, x runs along the garden, the palace is in the north (-z).
constexpr float half_x = 24.0f, half_z = 17.0f;
constexpr float plaza_radius = 5.2f;
constexpr float walk = 3.0f;  ///< between columns
constexpr int columns_each_row = 15;
constexpr float front_row_z = -10.2f, back_row_z = -13.0f;
constexpr float palace_z = -16.0f;

// Architecture (builtin_garden_stone.cpp).
Mesh ground_mesh();
Mesh column_mesh();
/// Beams and rafters on the two rows of columns.
Mesh pergola_mesh();
/// One bay of the palace's front, `walk` wide, at z = 0, facing +z.
Mesh palace_bay_mesh();
Mesh fountain_mesh();
Mesh urn_mesh();
Mesh bench_mesh();
/// Height of the columns.
constexpr float column_height = 3.3f;

// Plants (builtin_garden_plants.cpp).
/// A clipped hedge along x, its middle at the origin, on y = 0.
struct HedgeShape {
    float length_m, width_m, height_m;
    float leaf_m;
    std::uint32_t leaves_per_m2, first_tone;
};
Mesh hedge_mesh(const HedgeShape& shape, std::uint32_t seed);
Mesh cone_topiary_mesh(float radius_m, float height_m, std::uint32_t leaves, std::uint32_t seed);
Mesh ball_topiary_mesh(float radius_m, std::uint32_t leaves, std::uint32_t seed);
Mesh cypress_mesh(std::uint32_t leaves, std::uint32_t seed);
/// A flower on y = 0: two leaves, a stem and petals, in one of three tones from `first_tone`.
Mesh flower_mesh(std::uint32_t first_tone, std::uint32_t seed);
/// What climbs over the pergola and hangs from it.
Mesh vine_mesh(std::uint32_t leaves, std::uint32_t seed);
/// Short blades on the lawns.
Mesh lawn_blades_mesh(std::uint32_t blades, std::uint32_t seed);
/// Whether the place is one of the lawns.
bool on_lawn(vec2 place);

}  // namespace sightlines::garden
