// The pieces of the built-in amusement park; builtin_park.cpp puts them together and moves them.
#pragma once

#include "techniques/scene/builtin_mesh.h"

namespace sightlines::park {

/// Indices into materials().
enum MaterialIndex : std::uint32_t {
    brick,
    brick_dark,
    brick_light,
    lawn,
    lawn_dark,
    lawn_light,
    kerb,
    steel_white,
    steel_blue,
    steel_dark,
    timber,
    timber_dark,
    canvas_white,
    canvas_red,
    canvas_blue,
    canvas_yellow,
    canvas_green,
    gold,
    horse_white,
    horse_brown,
    horse_black,
    saddle_red,
    train_red,
    train_green,
    train_black,
    bark,
    leaf_dark,
    leaf_mid,
    leaf_light,
    blade,
    bulb_warm,  ///< bulbs of six colours, which glow
    bulb_red,
    bulb_green,
    bulb_blue,
    bulb_violet,
    bulb_white,
};

std::vector<Material> materials();

/// A lamp of a mesh: where it shines from, and the colour of its bulb.
struct Lamp {
    vec3 position{0.0f};
    std::uint32_t bulb = bulb_warm;
};

/// A mesh with its lamps, in one frame.
struct LitMesh {
    Mesh mesh;
    std::vector<Lamp> lamps;
};

/// A bulb at `place`; it shines from a little way `out` of it (unit), clear of itself and of what it is fixed to.
void add_bulb(LitMesh& lit, vec3 place, vec3 out, std::uint32_t bulb);
/// The light of a lamp in the world.
Light lamp_light(const Lamp& lamp, const mat4& world_from_part);

// Rides (builtin_park_rides.cpp). Each stands on y = 0 unless it says otherwise.
constexpr float wheel_radius = 13.0f, wheel_hub = 15.0f;
constexpr int gondolas = 24, horses = 24, swing_seats = 24;
/// Turns about the z axis; its hub is the origin.
LitMesh wheel_mesh();
Mesh wheel_stand_mesh();
/// Hangs from the origin.
LitMesh gondola_mesh(std::uint32_t canvas);
constexpr float carousel_radius = 6.2f;
/// Turns about the y axis.
LitMesh carousel_mesh();
/// Its pole at the origin, looking along +x.
Mesh horse_mesh(std::uint32_t coat);
constexpr float swing_height = 9.0f, swing_crown = 4.6f;
LitMesh swing_crown_mesh();
Mesh swing_mast_mesh();
/// Hangs from the origin by its chains, straight down.
Mesh swing_seat_mesh(std::uint32_t paint);
constexpr float wagon_m = 3.3f;
LitMesh engine_mesh();
LitMesh wagon_mesh(std::uint32_t paint);

// Everything that stands still (builtin_park_grounds.cpp).
constexpr vec2 track_radii(37.0f, 28.5f);
Mesh ground_mesh();
Mesh track_mesh();
Mesh grass_mesh(std::uint32_t blades);
LitMesh stall_mesh(std::uint32_t canvas, std::uint32_t seed);
LitMesh tent_mesh();
LitMesh gate_mesh();
Mesh bench_mesh();
/// A string of `bulbs` bulbs that sags between two points.
void add_string(LitMesh& lit, vec3 from, vec3 to, float sag_m, int bulbs, std::uint32_t seed);

}  // namespace sightlines::park
