// The built-in planes: two instances of one plane fly loops over a city.
#include "techniques/scene/builtin_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_models.h"
#include "techniques/scene/builtin_posed.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines {
namespace {

using namespace planes;

constexpr float pi = std::numbers::pi_v<float>;
constexpr double duration_s = 24.0;
constexpr int blocks = 7;
constexpr float block_m = 31.0f, street_m = 11.0f, pitch_m = block_m + street_m;
constexpr float half_city = 0.5f * (pitch_m * blocks + street_m);

vec2 block_middle(int column, int row) {
    constexpr float middle = 0.5f * static_cast<float>(blocks - 1);
    return pitch_m * (vec2(column, row) - middle);
}

bool is_park(int column, int row) { return (column == 2 && row == 3) || (column == 5 && row == 5); }

Mesh streets_mesh() {
    Mesh mesh;
    constexpr int cells = 90;
    add_quad(
        mesh, {-half_city, 0.0f, half_city}, {2.0f * half_city, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f * half_city},
        {cells, cells}, [](ivec2 cell) {
            return static_cast<std::uint32_t>(smooth_noise(0.23f * vec2(cell), 5) < 0.55f ? asphalt : asphalt_worn);
        });
    for (int line = 0; line <= blocks; ++line) {
        const float middle = pitch_m * (static_cast<float>(line) - 0.5f * blocks);
        for (float at = -half_city + 2.0f; at < half_city - 3.0f; at += 5.0f) {
            const float within = std::fmod(at + half_city, pitch_m);
            if (within < street_m + 3.0f) continue;
            add_box(mesh, {{at, 0.0f, middle - 0.1f}, {at + 2.2f, 0.02f, middle + 0.1f}}, marking);
            add_box(mesh, {{middle - 0.1f, 0.0f, at}, {middle + 0.1f, 0.02f, at + 2.2f}}, marking);
        }
        // Crossings before each junction.
        for (int other = 0; other <= blocks; ++other) {
            const float across = pitch_m * (static_cast<float>(other) - 0.5f * blocks);
            for (int stripe = 0; stripe < 6; ++stripe) {
                const float offset = -0.5f * street_m + 1.6f + 1.4f * static_cast<float>(stripe);
                for (const float side : {-1.0f, 1.0f}) {
                    const float far = across + side * (0.5f * street_m + 1.6f);
                    if (std::abs(far) > half_city - 2.0f) continue;
                    add_box(mesh, {{middle + offset, 0.0f, far - 1.2f}, {middle + offset + 0.7f, 0.02f, far + 1.2f}},
                            marking);
                }
            }
        }
    }
    for (int row = 0; row < blocks; ++row)
        for (int column = 0; column < blocks; ++column) {
            const vec2 middle = block_middle(column, row);
            const float half = 0.5f * block_m;
            add_tile(mesh, {{middle.x - half, 0.0f, middle.y - half}, {middle.x + half, 0.16f, middle.y + half}}, 0.08f,
                     pavement);
            if (!is_park(column, row)) continue;
            const float inner = half - 3.0f;
            add_box(mesh, {{middle.x - inner, 0.1f, middle.y - inner}, {middle.x - 1.2f, 0.2f, middle.y + inner}},
                    lawn);
            add_box(mesh, {{middle.x + 1.2f, 0.1f, middle.y - inner}, {middle.x + inner, 0.2f, middle.y + inner}},
                    lawn_dark);
        }
    return mesh;
}

/// Higher towards the middle of the city, as cities are.
int floors_at(vec2 place, Draws& draws) {
    const float middle = std::exp(-glm::dot(place, place) / (85.0f * 85.0f));
    return 3 + static_cast<int>(draws.between(0.0f, 3.5f) + middle * draws.between(1.5f, 9.5f));
}

void add_houses(PartBuilder& builder) {
    Draws draws{901};
    std::uint32_t seed = 1000;
    for (int row = 0; row < blocks; ++row) {
        for (int column = 0; column < blocks; ++column) {
            if (is_park(column, row)) continue;
            const vec2 middle = block_middle(column, row);
            const bool whole = draws.unit() < 0.08f;
            const float lot = whole ? block_m - 4.0f : 0.5f * (block_m - 4.0f);
            for (int k = 0; k < (whole ? 1 : 4); ++k) {
                const vec2 offset =
                    whole ? vec2(0.0f) : 0.5f * lot * vec2(k % 2 == 0 ? -1.0f : 1.0f, k / 2 == 0 ? -1.0f : 1.0f);
                HouseShape shape;
                shape.size_m = vec2(lot - draws.between(0.2f, whole ? 5.0f : 1.6f),
                                    lot - draws.between(0.2f, whole ? 5.0f : 1.6f));
                shape.floors = floors_at(middle + offset, draws);
                const float style = draws.unit();
                shape.style = style < 0.42f ? 0 : style < 0.62f ? 1 : style < 0.76f ? 2 : 3;
                shape.wall = first_wall + draws.below(wall_tones);
                const vec2 place = middle + offset;
                builder.add(house_mesh(shape, ++seed), "house", {placed({place.x, 0.16f, place.y})});
            }
        }
    }
}

void add_street_life(PartBuilder& builder) {
    Draws draws{951};
    std::array<std::vector<mat4>, 6> cars;
    for (int line = 0; line <= blocks; ++line) {
        const float middle = pitch_m * (static_cast<float>(line) - 0.5f * blocks);
        for (float at = -half_city + 6.0f; at < half_city - 6.0f; at += draws.between(7.0f, 22.0f)) {
            const bool forth = draws.unit() < 0.5f, along_x = draws.unit() < 0.5f;
            const float lane = (forth ? 1.0f : -1.0f) * (draws.unit() < 0.5f ? 1.9f : 4.3f);
            const vec3 place = along_x ? vec3(at, 0.0f, middle + lane) : vec3(middle - lane, 0.0f, at);
            const float turn = (along_x ? 0.0f : 270.0f) + (forth ? 0.0f : 180.0f);
            cars[draws.below(6)].push_back(placed(place, turn));
        }
    }
    for (std::uint32_t k = 0; k < cars.size(); ++k) builder.add(car_mesh(car_white + k), "car", cars[k]);
    std::array<std::vector<mat4>, 4> trees;
    std::vector<mat4> lamps;
    for (int row = 0; row < blocks; ++row) {
        for (int column = 0; column < blocks; ++column) {
            const vec2 middle = block_middle(column, row);
            const float rim = 0.5f * block_m - 0.9f;
            if (is_park(column, row)) {
                for (int k = 0; k < 16; ++k) {
                    const float x = (k % 2 == 0 ? -1.0f : 1.0f) * draws.between(3.0f, 12.0f);
                    trees[draws.below(4)].push_back(
                        placed({middle.x + x, 0.15f, middle.y + draws.between(-12.0f, 12.0f)},
                               draws.between(0.0f, 360.0f), draws.between(0.9f, 1.4f)));
                }
                continue;
            }
            for (int side = 0; side < 4; ++side) {
                const float turn = 90.0f * static_cast<float>(side);
                const mat4 block = placed({middle.x, 0.15f, middle.y}, turn);
                lamps.push_back(block * placed({-0.3f * block_m, 0.0f, rim}, 270.0f));
                if (draws.unit() < 0.76f) continue;
                for (const float x : {-10.0f, 0.0f, 10.0f})
                    trees[draws.below(4)].push_back(block * placed({x + draws.between(-1.0f, 1.0f), 0.0f, rim},
                                                                   draws.between(0.0f, 360.0f),
                                                                   draws.between(0.6f, 0.85f)));
            }
        }
    }
    builder.add(lamp_mesh(), "street lamp", lamps);
    for (std::uint32_t k = 0; k < trees.size(); ++k) {
        TreeShape shape;
        shape.leaves = 210;
        shape.leaf_length_m = 0.78f;
        shape.bark = bark;
        shape.first_leaf = leaf_dark;
        builder.add(tree_mesh(shape, 960 + k), "tree", trees[k]);
    }
}

/// A plane's way: an ellipse, once round in the scene's duration.
struct Flight {
    vec3 middle;
    vec2 radii;
    float bob_m, start_turns, direction;
};

constexpr std::array<Flight, 2> flights = {{
    {{8.0f, 54.0f, 4.0f}, {74.0f, 56.0f}, 3.0f, 0.16f, 1.0f},
    {{-14.0f, 82.0f, -6.0f}, {92.0f, 66.0f}, 5.0f, 0.70f, -1.0f},
}};

vec3 place_on(const Flight& flight, float turns) {
    const float angle = 2.0f * pi * flight.direction * turns;
    return flight.middle + vec3(flight.radii.x * std::cos(angle), flight.bob_m * std::sin(2.0f * angle),
                                flight.radii.y * std::sin(angle));
}

mat4 plane_pose(const Flight& flight, double time_s) {
    const double phase = time_s / duration_s + flight.start_turns;
    const auto turns = static_cast<float>(phase - std::floor(phase));
    constexpr float step = 2e-3f;
    const vec3 place = place_on(flight, turns);
    const vec3 forward = glm::normalize(place_on(flight, turns + step) - place_on(flight, turns - step));
    // Banked into the turn: its lift points up and to the ellipse's inside.
    const vec3 inward = glm::normalize(flight.middle - place) * vec3(1.0f, 0.0f, 1.0f);
    const vec3 lift = vec3(0.0f, 1.0f, 0.0f) + 0.45f * inward;
    const vec3 right = glm::normalize(glm::cross(forward, lift));
    return framed(forward, glm::cross(right, forward), right, place);
}

std::vector<Camera> cameras() {
    Camera air{"default", CameraKind::perspective, {96.0f, 122.0f, 104.0f}, {4.0f, 4.0f, 2.0f}};
    air.vertical_field_of_view_deg = 46.0f;
    Camera roofs{"roofs", CameraKind::perspective, {58.0f, 92.0f, -78.0f}, {6.0f, 14.0f, -2.0f}};
    roofs.vertical_field_of_view_deg = 50.0f;
    Camera above{"above", CameraKind::perspective, {6.0f, 215.0f, 64.0f}, {2.0f, 0.0f, 2.0f}};
    above.vertical_field_of_view_deg = 46.0f;
    return {air, roofs, above};
}

PosableScene made_planes() {
    PosableScene city;
    city.rest.materials = materials();
    PartBuilder builder{city.rest};
    builder.add(streets_mesh(), "streets");
    add_houses(builder);
    add_street_life(builder);
    const std::vector<RigidPart> flying = builder.add_rigid(plane_mesh(), "plane", static_cast<int>(flights.size()));
    city.rest.cameras = cameras();
    // In the air over the roofs, above the low plane's way for the most part.
    city.rest.light_volume = {{-105.0f, 56.0f, -105.0f}, {105.0f, 100.0f, 105.0f}};
    SunArc sun;
    sun.irradiance = {5.2f, 4.5f, 3.6f};
    sun.first_azimuth_deg = sun.last_azimuth_deg = 62.0f;
    sun.lowest_elevation_deg = sun.highest_elevation_deg = 52.0f;
    city.rest.lights = {sun_light(sun, 0.0)};
    const std::vector<Light> sky = sky_lights(48, {0.95f, 1.25f, 1.7f});
    city.rest.lights.insert(city.rest.lights.end(), sky.begin(), sky.end());
    city.pose = [flying](Scene& scene, double time_s) {
        for (std::size_t i = 0; i < flying.size(); ++i) place_part(scene, flying[i], plane_pose(flights[i], time_s));
    };
    return city;
}

}  // namespace

SceneModel planes_model() {
    return posed_model("planes", "Two instances of one plane fly loops over a city; the low one shades the houses.",
                       duration_s, made_planes);
}

}  // namespace sightlines
