// The built-in amusement park by night: rides that turn, and 7,088 bulbs, each a light.
#include "techniques/scene/builtin_park.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "techniques/scene/builtin_models.h"
#include "techniques/scene/builtin_posed.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines {
namespace {

using namespace park;

constexpr float pi = std::numbers::pi_v<float>;
constexpr double duration_s = 24.0;
constexpr std::size_t lamps_in_all = 7088;
constexpr int wagons = 6;

constexpr vec3 wheel_place(-19.0f, 0.0f, -13.0f), carousel_place(17.0f, 0.0f, 11.0f), swing_place(18.0f, 0.0f, -12.0f),
    tent_place(-18.0f, 0.0f, 12.5f);

/// Instances of one mesh that move, with the lamps that each carries.
struct Ride {
    std::vector<RigidPart> parts;
    std::vector<Lamp> lamps;
};

/// All that the animation needs.
struct Rides {
    Ride wheel, carousel, crown, engine;
    std::array<Ride, 3> gondola_kinds, horse_kinds, seat_kinds, wagon_kinds;
    std::vector<Light> still_lights;
};

/// Part of the loop, 0 to 1.
float loop_share(double time_s) {
    const double share = time_s / duration_s;
    return static_cast<float>(share - std::floor(share));
}

void place_ride(Scene& scene, const Ride& ride, std::size_t instance, const mat4& world_from_part) {
    place_part(scene, ride.parts[instance], world_from_part);
    for (const Lamp& lamp : ride.lamps) scene.lights.push_back(lamp_light(lamp, world_from_part));
}

mat4 shifted(vec3 by) { return placed(by); }

void pose_wheel(Scene& scene, const Rides& rides, float share) {
    const vec3 hub = wheel_place + vec3(0, wheel_hub, 0);
    const float turn = 2.0f * pi * share;
    place_ride(scene, rides.wheel, 0, shifted(hub) * turned_about({0, 0, 1}, turn));
    for (int k = 0; k < gondolas; ++k) {
        const float angle = turn + 2.0f * pi * static_cast<float>(k) / gondolas;
        const vec3 place = hub + wheel_radius * vec3(std::cos(angle), std::sin(angle), 0);
        const float sway = 0.06f * std::sin(2.0f * pi * 6.0f * share + 2.4f * static_cast<float>(k));
        place_ride(scene, rides.gondola_kinds[static_cast<std::size_t>(k % 3)], static_cast<std::size_t>(k / 3),
                   shifted(place) * turned_about({0, 0, 1}, sway));
    }
}

void pose_carousel(Scene& scene, const Rides& rides, float share) {
    const float turn = -2.0f * pi * 2.0f * share;
    const mat4 platform = shifted(carousel_place) * turned_about({0, 1, 0}, turn);
    place_ride(scene, rides.carousel, 0, platform);
    for (int k = 0; k < horses; ++k) {
        const bool outer = k % 2 == 0;
        const float angle = 360.0f * static_cast<float>(k) / horses, radius = outer ? 5.2f : 3.6f;
        const float bob = 0.22f * std::sin(2.0f * pi * (10.0f * share + 0.37f * static_cast<float>(k)));
        // Looking along the way it goes: clockwise as seen from above.
        const mat4 place =
            platform * placed(vec3(0.0f), angle) * shifted({radius, 0.55f + bob, 0}) * placed(vec3(0.0f), 270.0f);
        place_ride(scene, rides.horse_kinds[static_cast<std::size_t>(k % 3)], static_cast<std::size_t>(k / 3), place);
    }
}

void pose_swings(Scene& scene, const Rides& rides, float share) {
    const float turn = 2.0f * pi * 4.0f * share;
    const mat4 crown = shifted(swing_place + vec3(0, swing_height, 0)) * turned_about({0, 1, 0}, turn);
    place_ride(scene, rides.crown, 0, crown);
    constexpr float lean = 0.62f;  // outwards, by the turning
    for (int k = 0; k < swing_seats; ++k) {
        const float angle = 360.0f * (static_cast<float>(k) + 0.5f) / swing_seats;
        const float reach = k % 2 == 0 ? swing_crown - 0.25f : swing_crown - 1.5f;
        const mat4 place = crown * placed(vec3(0.0f), angle) * shifted({reach, k % 2 == 0 ? -0.1f : -0.22f, 0}) *
                           turned_about({0, 0, 1}, lean);
        place_ride(scene, rides.seat_kinds[static_cast<std::size_t>(k % 3)], static_cast<std::size_t>(k / 3), place);
    }
}

/// On the track's ellipse, looking along it.
mat4 on_rails(float angle) {
    const vec3 place(track_radii.x * std::cos(angle), 0.2f, track_radii.y * std::sin(angle));
    const vec3 forward = glm::normalize(vec3(-track_radii.x * std::sin(angle), 0, track_radii.y * std::cos(angle)));
    return framed(forward, {0, 1, 0}, glm::cross(forward, vec3(0, 1, 0)), place);
}

void pose_train(Scene& scene, const Rides& rides, float share) {
    float angle = 2.0f * pi * share + 1.15f;
    place_ride(scene, rides.engine, 0, on_rails(angle));
    for (int k = 0; k < wagons; ++k) {
        // Back along the track by a wagon's length.
        angle -= wagon_m / glm::length(track_radii * vec2(std::sin(angle), std::cos(angle)));
        place_ride(scene, rides.wagon_kinds[static_cast<std::size_t>(k % 3)], static_cast<std::size_t>(k / 3),
                   on_rails(angle));
    }
}

Ride add_ride(PartBuilder& builder, LitMesh lit, const std::string& name, int count) {
    return {builder.add_rigid(std::move(lit.mesh), name, count), std::move(lit.lamps)};
}

void add_rides(PartBuilder& builder, Rides& rides) {
    rides.wheel = add_ride(builder, wheel_mesh(), "wheel", 1);
    rides.carousel = add_ride(builder, carousel_mesh(), "carousel", 1);
    rides.crown = add_ride(builder, swing_crown_mesh(), "swing crown", 1);
    rides.engine = add_ride(builder, engine_mesh(), "engine", 1);
    constexpr std::array<std::uint32_t, 3> canvases = {canvas_red, canvas_blue, canvas_green},
                                           coats = {horse_white, horse_brown, horse_black},
                                           paints = {train_green, train_red, canvas_blue};
    for (std::size_t k = 0; k < 3; ++k) {
        rides.gondola_kinds[k] = add_ride(builder, gondola_mesh(canvases[k]), "gondola", gondolas / 3);
        rides.horse_kinds[k] = add_ride(builder, {horse_mesh(coats[k]), {}}, "horse", horses / 3);
        rides.seat_kinds[k] = add_ride(builder, {swing_seat_mesh(canvases[k]), {}}, "swing seat", swing_seats / 3);
        rides.wagon_kinds[k] = add_ride(builder, wagon_mesh(paints[k]), "wagon", wagons / 3);
    }
}

void add_lit(PartBuilder& builder, std::vector<Light>& lights, const LitMesh& lit, const std::string& name,
             const std::vector<mat4>& places) {
    builder.add(lit.mesh, name, places);
    for (const mat4& place : places)
        for (const Lamp& lamp : lit.lamps) lights.push_back(lamp_light(lamp, place));
}

void add_grounds(PartBuilder& builder, std::vector<Light>& lights) {
    builder.add(ground_mesh(), "ground");
    builder.add(track_mesh(), "track");
    builder.add(grass_mesh(15000), "grass");
    builder.add(wheel_stand_mesh(), "wheel stand", {placed(wheel_place)});
    builder.add(swing_mast_mesh(), "swing mast", {placed(swing_place)});
    add_lit(builder, lights, tent_mesh(), "tent", {placed(tent_place, 60.0f)});
    add_lit(builder, lights, gate_mesh(), "gate", {placed({0, 0, 23.0f})});
    constexpr std::array<std::uint32_t, 4> canvases = {canvas_red, canvas_blue, canvas_green, canvas_yellow};
    std::array<std::vector<mat4>, 4> stalls;
    for (int k = 0; k < 14; ++k) {
        const float side = k % 2 == 0 ? -1.0f : 1.0f, z = 18.5f - 5.6f * static_cast<float>(k / 2);
        if (std::abs(z) < 4.0f) continue;
        stalls[static_cast<std::size_t>(k % 4)].push_back(placed({side * 7.0f, 0, z}, side < 0.0f ? 90.0f : 270.0f));
    }
    for (std::uint32_t k = 0; k < 4; ++k)
        add_lit(builder, lights, stall_mesh(canvases[k], 611 + k), "stall", stalls[k]);
    std::vector<mat4> benches;
    for (const float z : {15.7f, 10.1f, -6.7f, -12.3f, -17.9f})  // between the stalls
        for (const float side : {-1.0f, 1.0f})
            benches.push_back(placed({side * 5.9f, 0, z}, side < 0.0f ? 90.0f : 270.0f));
    builder.add(bench_mesh(), "bench", benches);
    Draws draws{621};
    for (std::uint32_t kind = 0; kind < 4; ++kind) {
        TreeShape shape;
        shape.height_m = draws.between(6.0f, 8.0f);
        shape.leaves = 1550;
        shape.leaf_length_m = 0.32f;
        shape.bark = bark;
        shape.first_leaf = leaf_dark;
        std::vector<mat4> trees;
        for (int k = 0; k < 8; ++k) {
            const float angle =
                2.0f * pi * (static_cast<float>(4 * k) + static_cast<float>(kind) + draws.between(-0.3f, 0.3f)) / 32.0f;
            const vec2 place =
                (k % 3 == 0 ? vec2(28.5f, 20.5f) : vec2(39.8f, 31.2f)) * vec2(std::cos(angle), std::sin(angle));
            if (std::abs(place.x) < 6.5f) continue;
            trees.push_back(placed({place.x, 0, place.y}, draws.between(0.0f, 360.0f), draws.between(0.85f, 1.2f)));
        }
        builder.add(tree_mesh(shape, 631 + kind), "tree", trees);
    }
}

/// Strings of bulbs between poles, over the avenue and about the plaza, as many bulbs as are left to hang.
LitMesh strings_mesh(std::size_t bulbs) {
    LitMesh strings;
    std::vector<std::array<vec3, 2>> spans;
    const auto pole = [&](vec2 place, float height) {
        add_rod(strings.mesh, {place.x, 0, place.y}, {place.x, height, place.y}, 0.07f, 8, steel_dark);
        return vec3(place.x, height - 0.1f, place.y);
    };
    std::vector<vec3> left, right;
    for (int k = 0; k < 8; ++k) {
        const float z = 20.5f - 5.6f * static_cast<float>(k);
        left.push_back(pole({-4.9f, z}, 5.2f));
        right.push_back(pole({4.9f, z}, 5.2f));
        spans.push_back({left.back(), right.back()});
        if (k == 0) continue;
        const auto before = static_cast<std::size_t>(k - 1);
        spans.push_back({left[before], right.back()});
        spans.push_back({right[before], left.back()});
        spans.push_back({left[before], left.back()});
        spans.push_back({right[before], right.back()});
    }
    for (const float side : {-1.0f, 1.0f}) {
        vec3 north = pole({side * 9.0f, -4.0f}, 5.2f), south = pole({side * 9.0f, 4.0f}, 5.2f);
        for (int k = 1; k < 5; ++k) {
            const float x = side * (9.0f + 5.4f * static_cast<float>(k));
            const vec3 next_north = pole({x, -4.0f}, 5.2f), next_south = pole({x, 4.0f}, 5.2f);
            for (const auto& span : {std::array<vec3, 2>{north, next_north},
                                     {south, next_south},
                                     {north, next_south},
                                     {south, next_north},
                                     {next_north, next_south}})
                spans.push_back(span);
            north = next_north;
            south = next_south;
        }
    }
    for (std::size_t k = 0; k < spans.size(); ++k) {
        const std::size_t share = bulbs * (k + 1) / spans.size() - bulbs * k / spans.size();
        add_string(strings, spans[k][0], spans[k][1], 0.75f, static_cast<int>(share), static_cast<std::uint32_t>(k));
    }
    return strings;
}

std::size_t moving_lamps(const Rides& rides) {
    std::size_t lamps = 0;
    const auto count = [&](const Ride& ride) { lamps += ride.lamps.size() * ride.parts.size(); };
    for (const Ride* ride : {&rides.wheel, &rides.carousel, &rides.crown, &rides.engine}) count(*ride);
    for (const auto* kinds : {&rides.gondola_kinds, &rides.horse_kinds, &rides.seat_kinds, &rides.wagon_kinds})
        for (const Ride& ride : *kinds) count(ride);
    return lamps;
}

std::vector<Camera> cameras() {
    Camera gate{"default", CameraKind::perspective, {9.5f, 11.5f, 22.0f}, {-5.5f, 4.2f, -6.0f}};
    gate.vertical_field_of_view_deg = 50.0f;
    Camera carousel{"carousel", CameraKind::perspective, {10.2f, 2.6f, 2.6f}, {16.4f, 2.4f, 10.4f}};
    carousel.vertical_field_of_view_deg = 56.0f;
    Camera above{"above", CameraKind::perspective, {0.0f, 58.0f, 44.0f}, {0.0f, 0.0f, 1.5f}};
    above.vertical_field_of_view_deg = 46.0f;
    return {gate, carousel, above};
}

PosableScene made_park() {
    PosableScene made;
    Scene& scene = made.rest;
    scene.materials = materials();
    PartBuilder builder{scene};
    Rides rides;
    add_grounds(builder, rides.still_lights);
    add_rides(builder, rides);
    add_lit(builder, rides.still_lights, strings_mesh(lamps_in_all - rides.still_lights.size() - moving_lamps(rides)),
            "strings of bulbs", {mat4(1.0f)});
    scene.cameras = cameras();
    scene.light_volume = {{-30.0f, 3.0f, -22.0f}, {30.0f, 16.0f, 22.0f}};
    made.pose = [rides = std::make_shared<const Rides>(std::move(rides))](Scene& posed, double time_s) {
        const float share = loop_share(time_s);
        posed.lights = rides->still_lights;
        pose_wheel(posed, *rides, share);
        pose_carousel(posed, *rides, share);
        pose_swings(posed, *rides, share);
        pose_train(posed, *rides, share);
    };
    return made;
}

}  // namespace

SceneModel park_model() {
    return posed_model("park",
                       "An amusement park by night: wheel, carousel, swings and train turn, lit by 7,088 bulbs.",
                       duration_s, made_park);
}

}  // namespace sightlines
