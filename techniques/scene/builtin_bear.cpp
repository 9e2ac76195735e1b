// The built-in bear: it gallops in a circle over a meadow; everything else stands still.
#include "techniques/scene/builtin_bear.h"

#include <cmath>
#include <memory>
#include <numbers>

#include "techniques/scene/builtin_models.h"
#include "techniques/scene/builtin_posed.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines {
namespace {

using namespace bear;

constexpr float pi = std::numbers::pi_v<float>;
constexpr float circle_m = 6.0f;  ///< twelve strides round
constexpr int strides = 12;
constexpr double duration_s = 7.2;
constexpr float half_meadow = 15.0f;

/// The two versions: how fine.
struct Detail {
    float cell_m;
    std::uint32_t hairs, blades;
    float blade_width_m;
};
constexpr Detail light_detail{0.030f, 18500, 12500, 0.026f};
constexpr Detail full_detail{0.020f, 398000, 92000, 0.012f};

float ground_height(vec2 place) {
    const float away = glm::length(place);
    const float wild = glm::smoothstep(1.2f, 4.0f, std::abs(away - circle_m));  // level where the bear runs
    return wild * (0.55f * (smooth_noise(0.22f * place, 21) - 0.5f) + 0.14f * (smooth_noise(0.9f * place, 22) - 0.5f)) +
           0.02f * (smooth_noise(2.3f * place, 23) - 0.5f) +
           0.010f * std::max(away - 9.0f, 0.0f) * std::max(away - 9.0f, 0.0f);
}

vec3 on_meadow(vec2 place) { return {place.x, ground_height(place), place.y}; }

/// 1 in the middle of the beaten track, 0 off it, its border ragged.
float track(vec2 place) {
    const float off = std::abs(glm::length(place) - circle_m) + 0.5f * (smooth_noise(1.7f * place, 24) - 0.5f);
    return 1.0f - glm::smoothstep(0.35f, 0.85f, off);
}

Mesh meadow_mesh() {
    Mesh mesh;
    // Rings about the middle, as the track is.
    add_surface(
        mesh, {176, 70}, true,
        [](vec2 uv) {
            const float angle = 2.0f * pi * uv.x;
            return on_meadow(half_meadow * uv.y * vec2(std::cos(angle), std::sin(angle)));
        },
        meadow);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const uvec3 t = mesh.triangles[i];
        const vec3 middle = (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0f;
        const vec2 place(middle.x, middle.z);
        const float tone = smooth_noise(0.5f * place, 25);
        mesh.materials[i] = track(place) > 0.5f ? earth
                            : tone < 0.4f       ? meadow_dark
                            : tone < 0.62f      ? meadow
                                                : meadow_light;
    }
    return mesh;
}

Mesh grass_mesh(const Detail& detail) {
    Mesh mesh;
    Draws draws{511};
    for (std::uint32_t i = 0; i < detail.blades;) {
        // Denser towards the middle, where it is seen from near.
        const float away = half_meadow * std::pow(draws.unit(), 0.72f), azimuth = 2.0f * pi * draws.unit();
        const vec2 place = 0.98f * away * vec2(std::cos(azimuth), std::sin(azimuth));
        if (track(place) > 0.9f * draws.unit() + 0.05f) continue;
        ++i;
        const float turn = 2.0f * pi * draws.unit();
        const vec3 outward(std::cos(turn), 0.0f, std::sin(turn));
        const vec3 direction = glm::normalize(vec3(0, 1, 0) + draws.between(0.1f, 0.75f) * outward);
        const bool flower = i % 61 == 0;
        const float tall = draws.between(0.10f, 0.26f) * (0.7f + 0.7f * smooth_noise(0.4f * place, 26));
        const vec3 base = on_meadow(place) - vec3(0, 0.015f, 0);
        add_leaf(mesh, base, direction, {-outward.z, 0.0f, outward.x}, tall, detail.blade_width_m,
                 draws.unit() < 0.1f ? static_cast<std::uint32_t>(blade_dry) : blade_dark + draws.below(3));
        if (!flower) continue;
        for (int k = 0; k < 5; ++k) {
            const float angle = 2.0f * pi * static_cast<float>(k) / 5.0f;
            const vec3 petal(std::cos(angle), 0.4f, std::sin(angle));
            add_leaf(mesh, base + tall * direction, glm::normalize(petal), {-petal.z, 0.0f, petal.x}, 0.035f, 0.026f,
                     draws.unit() < 0.5f ? flower_white : flower_yellow);
        }
    }
    return mesh;
}

Mesh rock_mesh(std::uint32_t seed) {
    Mesh mesh;
    add_surface(
        mesh, {20, 12}, true,
        [seed](vec2 uv) {
            const float azimuth = -2.0f * pi * uv.x, height = pi * (uv.y - 0.5f);
            const float ring = uv.y <= 0.0f || uv.y >= 1.0f ? 0.0f : std::cos(height);
            const vec3 unit(ring * std::cos(azimuth), std::sin(height), ring * std::sin(azimuth));
            const float phase = 1.7f * static_cast<float>(seed);
            const float bumps = 1.0f + 0.16f * std::sin(3.3f * unit.x + phase) * std::cos(2.9f * unit.z - phase) +
                                0.09f * std::sin(6.1f * unit.y + 4.3f * unit.x + phase);
            return bumps * unit * vec3(1.0f, 0.6f, 0.85f);
        },
        rock);
    return mesh;
}

/// A spruce: tiers of drooping sprays about a trunk.
Mesh spruce_mesh(std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const float height = draws.between(5.0f, 7.0f);
    const std::array<TubeRing, 3> trunk = {TubeRing{{0, -0.3f, 0}, 0.16f}, TubeRing{{0, 0.5f * height, 0}, 0.09f},
                                           TubeRing{{0, height, 0}, 0.01f}};
    add_tube(mesh, trunk, 8, bark);
    constexpr int sprays = 240;
    for (int k = 0; k < sprays; ++k) {
        const float t = std::pow((static_cast<float>(k) + 0.5f) / sprays, 1.25f);
        const float azimuth = 2.39996f * static_cast<float>(k) + draws.between(-0.2f, 0.2f);
        const vec3 outward(std::cos(azimuth), 0, std::sin(azimuth)), side(-outward.z, 0, outward.x);
        const float length = (0.16f + 1.45f * (1.0f - t)) * draws.between(0.75f, 1.1f);
        const vec3 base(0, 0.35f + t * (height - 0.4f), 0);
        const vec3 direction = glm::normalize(outward + vec3(0, draws.between(-0.45f, 0.1f), 0));
        add_leaf(mesh, base + 0.12f * length * outward, direction, side, length, 0.34f * length,
                 needle_dark + draws.below(3));
    }
    return mesh;
}

void add_surroundings(PartBuilder& builder, const Detail& detail) {
    builder.add(meadow_mesh(), "meadow");
    builder.add(grass_mesh(detail), "grass");
    Draws draws{521};
    for (std::uint32_t kind = 0; kind < 3; ++kind) {
        std::vector<mat4> rocks, spruces;
        for (int k = 0; k < 4; ++k) {
            const float azimuth = 2.0f * pi * draws.unit(),
                        away = k < 2 ? draws.between(1.0f, 3.8f) : draws.between(8.2f, 13.0f);
            const vec2 place = away * vec2(std::cos(azimuth), std::sin(azimuth));
            rocks.push_back(placed(on_meadow(place), draws.between(0.0f, 360.0f), draws.between(0.18f, 0.6f)));
        }
        // A wood along the far half of the meadow.
        for (int k = 0; k < 14; ++k) {
            const float azimuth =
                pi * (1.0f + (3.0f * static_cast<float>(k) + static_cast<float>(kind) + draws.unit()) / 42.0f);
            const vec2 place = draws.between(10.6f, 14.0f) * vec2(1.15f * std::cos(azimuth), std::sin(azimuth));
            const vec2 inside = place * std::min(1.0f, (half_meadow - 0.8f) / glm::length(place));
            spruces.push_back(placed(on_meadow(inside), draws.between(0.0f, 360.0f), draws.between(0.75f, 1.15f)));
        }
        builder.add(rock_mesh(kind), "rock", rocks);
        builder.add(spruce_mesh(531 + kind), "spruce", spruces);
    }
}

/// On the circle, looking along it, leaning inwards; at time 0 nearest to the camera.
mat4 world_from_bear(float turns) {
    const float angle = 0.5f * pi - 2.0f * pi * turns;
    const vec3 place = circle_m * vec3(std::cos(angle), 0, std::sin(angle));
    const vec3 forward(std::sin(angle), 0, -std::cos(angle));
    const vec3 up = glm::normalize(vec3(0, 1, 0) - 0.10f * place / circle_m);
    const vec3 right = glm::normalize(glm::cross(forward, up));
    return framed(forward, up, right, place);
}

std::vector<Camera> cameras() {
    Camera side{"default", CameraKind::perspective, {1.9f, 2.75f, 10.0f}, {0.15f, 0.45f, 5.5f}};
    side.vertical_field_of_view_deg = 40.0f;
    Camera ahead{"ahead", CameraKind::perspective, {4.3f, 2.1f, 7.6f}, {0.5f, 0.45f, 5.75f}};
    ahead.vertical_field_of_view_deg = 46.0f;
    Camera above{"above", CameraKind::perspective, {2.0f, 11.5f, 15.5f}, {0.0f, 0.0f, 0.6f}};
    above.vertical_field_of_view_deg = 44.0f;
    return {side, ahead, above};
}

PosableScene made_bear(const Detail& detail) {
    PosableScene made;
    Scene& scene = made.rest;
    scene.materials = materials();
    PartBuilder builder{scene};
    add_surroundings(builder, detail);
    const auto animal = std::make_shared<const Body>(body(detail.cell_m, detail.hairs));
    const std::size_t first = scene.positions.size();
    builder.add(animal->mesh, "bear");
    scene.parts.back().deforms = true;
    scene.cameras = cameras();
    scene.light_volume = {{-10.0f, 1.9f, -10.0f}, {10.0f, 6.5f, 10.0f}};
    SunArc sun;
    sun.irradiance = {5.6f, 4.7f, 3.5f};
    sun.first_azimuth_deg = sun.last_azimuth_deg = 38.0f;
    sun.lowest_elevation_deg = sun.highest_elevation_deg = 40.0f;
    scene.lights = {sun_light(sun, 0.0)};
    const std::vector<Light> sky = sky_lights(48, {1.0f, 1.3f, 1.75f});
    scene.lights.insert(scene.lights.end(), sky.begin(), sky.end());
    constexpr float body_m = 2.1f;  // from its middle to nose or heels, stretched out
    made.reach = Box3{{-circle_m - body_m, -0.3f, -circle_m - body_m}, {circle_m + body_m, 2.2f, circle_m + body_m}};
    made.pose = [animal, first](Scene& posed, double time_s) {
        const double loops = time_s / duration_s;
        const auto turns = static_cast<float>(loops - std::floor(loops));
        const float stride = strides * turns + 0.42f;  // stretched out at time 0
        pose_body(*animal, running(stride - std::floor(stride)), world_from_bear(turns), posed.positions.data() + first,
                  posed.normals.data() + first);
    };
    return made;
}

}  // namespace

namespace bear {

std::vector<Material> materials() {
    std::vector<Material> all = {
        diffuse("skin", {0.12f, 0.066f, 0.034f}),
        diffuse("dark fur", {0.115f, 0.062f, 0.031f}),
        diffuse("fur", {0.165f, 0.092f, 0.045f}),
        diffuse("light fur", {0.225f, 0.132f, 0.066f}),
        diffuse("muzzle", {0.36f, 0.25f, 0.15f}),
        diffuse("nose", {0.02f, 0.018f, 0.018f}, 0.4f),
        diffuse("eye", {0.015f, 0.01f, 0.008f}, 0.2f),
        diffuse("claw", {0.10f, 0.085f, 0.07f}, 0.5f),
        diffuse("meadow", {0.12f, 0.19f, 0.045f}),
        diffuse("dark meadow", {0.10f, 0.165f, 0.04f}),
        diffuse("light meadow", {0.145f, 0.205f, 0.055f}),
        diffuse("earth", {0.26f, 0.18f, 0.11f}),
        diffuse("dark blade", {0.11f, 0.21f, 0.035f}),
        diffuse("blade", {0.16f, 0.28f, 0.05f}),
        diffuse("light blade", {0.24f, 0.36f, 0.07f}),
        diffuse("dry blade", {0.46f, 0.40f, 0.18f}),
        diffuse("rock", {0.36f, 0.35f, 0.33f}),
        diffuse("bark", {0.15f, 0.10f, 0.07f}),
        diffuse("dark needles", {0.03f, 0.09f, 0.04f}),
        diffuse("needles", {0.045f, 0.125f, 0.05f}),
        diffuse("light needles", {0.075f, 0.17f, 0.06f}),
        diffuse("white flower", {0.84f, 0.84f, 0.80f}),
        diffuse("yellow flower", {0.84f, 0.64f, 0.06f}),
    };
    for (Material& material : all) material.double_sided = false;
    for (std::uint32_t sheet = fur_dark; sheet <= fur_muzzle; ++sheet) all[sheet].double_sided = true;
    for (std::uint32_t sheet = blade_dark; sheet <= blade_dry; ++sheet) all[sheet].double_sided = true;
    for (std::uint32_t sheet = needle_dark; sheet <= flower_yellow; ++sheet) all[sheet].double_sided = true;
    return all;
}

}  // namespace bear

SceneModel bear_model() {
    return posed_model("bear", "A bear gallops over a meadow: a body that deforms, in about 150,000 triangles.",
                       duration_s, [] { return made_bear(light_detail); });
}

SceneModel bear_full_model() {
    return posed_model("bear_full", "The same bear with all its fur, in about 1,486,000 triangles.", duration_s,
                       [] { return made_bear(full_detail); });
}

}  // namespace sightlines
