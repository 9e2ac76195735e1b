#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_park.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::park {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr vec2 half_ground(42.0f, 33.0f);

/// Where people walk: the middle, the ways to the rides, a ring inside the track.
bool is_paved(vec2 place) {
    const float ring = glm::length(place / (track_radii - 6.0f));
    const bool avenue = std::abs(place.x) < 5.2f && place.y > -24.0f;
    const bool cross = std::abs(place.y) < 4.2f && ring < 1.0f;
    const bool plaza = glm::length(place) < 11.0f;
    const bool rides =
        glm::length(place - vec2(-19.0f, -11.0f)) < 8.5f || glm::length(place - vec2(17.0f, 11.0f)) < 8.6f ||
        glm::length(place - vec2(18.0f, -12.0f)) < 8.4f || glm::length(place - vec2(-18.0f, 12.5f)) < 9.5f;
    return avenue || cross || plaza || rides || (ring > 0.88f && ring < 1.0f);
}

vec2 on_track(float turns, float inset) {
    const float angle = 2.0f * pi * turns;
    const vec2 along = glm::normalize(vec2(-track_radii.x * std::sin(angle), track_radii.y * std::cos(angle)));
    return track_radii * vec2(std::cos(angle), std::sin(angle)) + inset * vec2(-along.y, along.x);
}

}  // namespace

std::vector<Material> materials() {
    std::vector<Material> all = {
        diffuse("brick", {0.34f, 0.20f, 0.14f}),
        diffuse("dark brick", {0.28f, 0.16f, 0.115f}),
        diffuse("light brick", {0.40f, 0.25f, 0.18f}),
        diffuse("lawn", {0.12f, 0.22f, 0.05f}),
        diffuse("dark lawn", {0.10f, 0.19f, 0.045f}),
        diffuse("light lawn", {0.145f, 0.245f, 0.06f}),
        diffuse("kerb", {0.46f, 0.44f, 0.40f}),
        diffuse("white steel", {0.72f, 0.72f, 0.70f}, 0.5f),
        diffuse("blue steel", {0.10f, 0.20f, 0.44f}, 0.5f),
        diffuse("dark steel", {0.10f, 0.10f, 0.11f}, 0.5f),
        diffuse("timber", {0.38f, 0.24f, 0.13f}),
        diffuse("dark timber", {0.22f, 0.13f, 0.07f}),
        diffuse("white canvas", {0.80f, 0.77f, 0.70f}),
        diffuse("red canvas", {0.62f, 0.05f, 0.05f}),
        diffuse("blue canvas", {0.06f, 0.16f, 0.48f}),
        diffuse("yellow canvas", {0.80f, 0.52f, 0.06f}),
        diffuse("green canvas", {0.05f, 0.34f, 0.16f}),
        diffuse("gold", {0.66f, 0.45f, 0.14f}, 0.4f),
        diffuse("white horse", {0.76f, 0.74f, 0.70f}),
        diffuse("brown horse", {0.36f, 0.18f, 0.08f}),
        diffuse("black horse", {0.06f, 0.05f, 0.05f}),
        diffuse("saddle", {0.58f, 0.05f, 0.06f}),
        diffuse("train red", {0.56f, 0.05f, 0.04f}),
        diffuse("train green", {0.05f, 0.28f, 0.13f}),
        diffuse("train black", {0.045f, 0.045f, 0.05f}),
        diffuse("bark", {0.17f, 0.115f, 0.075f}),
        diffuse("dark leaf", {0.06f, 0.17f, 0.035f}),
        diffuse("leaf", {0.10f, 0.24f, 0.045f}),
        diffuse("light leaf", {0.17f, 0.33f, 0.06f}),
        diffuse("blade", {0.16f, 0.29f, 0.06f}),
        diffuse("warm bulb", {0.8f, 0.7f, 0.5f}),
        diffuse("red bulb", {0.7f, 0.2f, 0.1f}),
        diffuse("green bulb", {0.2f, 0.7f, 0.3f}),
        diffuse("blue bulb", {0.2f, 0.3f, 0.8f}),
        diffuse("violet bulb", {0.6f, 0.2f, 0.7f}),
        diffuse("white bulb", vec3(0.8f)),
    };
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        const bool canvas = i >= canvas_white && i <= canvas_green, leaf = i >= leaf_dark && i <= blade;
        all[i].double_sided = canvas || leaf;
    }
    constexpr std::array<vec3, 6> glow = {vec3(1.9f, 1.05f, 0.30f), vec3(1.8f, 0.14f, 0.08f), vec3(0.16f, 1.5f, 0.30f),
                                          vec3(0.12f, 0.42f, 2.0f), vec3(1.2f, 0.16f, 1.6f),  vec3(1.6f, 1.6f, 1.5f)};
    for (std::uint32_t k = 0; k < glow.size(); ++k) all[bulb_warm + k].emissive = glow[k];
    return all;
}

Light lamp_light(const Lamp& lamp, const mat4& world_from_part) {
    // Much alike in brightness, whatever the hue.
    constexpr std::array<vec3, 6> colours = {vec3(1.35f, 0.92f, 0.46f), vec3(1.9f, 0.62f, 0.42f),
                                             vec3(0.55f, 1.35f, 0.62f), vec3(0.50f, 0.85f, 2.2f),
                                             vec3(1.5f, 0.60f, 1.8f),   vec3(1.05f, 1.0f, 0.92f)};
    constexpr float strength = 0.19f;  // W/sr
    Light light;
    light.position = vec3(world_from_part * vec4(lamp.position, 1.0f));
    light.intensity = strength * colours[lamp.bulb - bulb_warm];
    return light;
}

Mesh ground_mesh() {
    Mesh mesh;
    const ivec2 cells(168, 132);
    add_quad(
        mesh, {-half_ground.x, 0, half_ground.y}, {2 * half_ground.x, 0, 0}, {0, 0, -2 * half_ground.y}, cells,
        [&](ivec2 cell) -> std::uint32_t {
            const vec2 place = vec2(-half_ground.x, half_ground.y) + (vec2(cell) + 0.5f) * vec2(0.5f, -0.5f);
            if (!is_paved(place)) {
                const float tone = 0.75f * smooth_noise(0.35f * place, 41) + 0.25f * smooth_noise(1.1f * place, 42);
                return tone < 0.42f ? lawn_dark : tone < 0.6f ? lawn : lawn_light;
            }
            const int pattern = (cell.x / 2 + cell.y / 2) % 2;
            const float worn = random_unit(43, static_cast<std::uint32_t>(cell.x), static_cast<std::uint32_t>(cell.y));
            return worn < 0.15f ? brick_light : pattern == 0 ? brick : brick_dark;
        });
    return mesh;
}

Mesh track_mesh() {
    Mesh mesh;
    constexpr int ties = 330;
    for (int i = 0; i < ties; ++i) {
        const float turns = static_cast<float>(i) / ties;
        const vec2 inner = on_track(turns, -0.85f), outer = on_track(turns, 0.85f);
        add_beam(mesh, {inner.x, 0.05f, inner.y}, {outer.x, 0.05f, outer.y}, 0.22f, 0.10f, timber_dark);
    }
    for (const float inset : {-0.6f, 0.6f}) {
        std::vector<vec3> rail;
        for (int i = 0; i < 220; ++i) {
            const vec2 place = on_track(-static_cast<float>(i) / 220.0f, inset);
            rail.push_back({place.x, 0.15f, place.y});
        }
        const std::array<vec2, 4> section = {vec2(-0.03f, -0.05f), vec2(0.03f, -0.05f), vec2(0.03f, 0.05f),
                                             vec2(-0.03f, 0.05f)};
        add_sweep(mesh, rail, {0, 1, 0}, section, true, steel_dark);
    }
    for (int i = 0; i < 150; ++i) {  // a fence outside
        const vec2 a = on_track(static_cast<float>(i) / 150.0f, -2.0f),
                   b = on_track(static_cast<float>(i + 1) / 150.0f, -2.0f);
        add_box(mesh, {{a.x - 0.05f, 0, a.y - 0.05f}, {a.x + 0.05f, 1.1f, a.y + 0.05f}}, canvas_white);
        for (const float y : {0.5f, 0.95f}) add_beam(mesh, {a.x, y, a.y}, {b.x, y, b.y}, 0.03f, 0.09f, canvas_white);
    }
    return mesh;
}

Mesh grass_mesh(std::uint32_t blades) {
    Mesh mesh;
    Draws draws{601};
    for (std::uint32_t i = 0; i < blades;) {
        const vec2 place = half_ground * vec2(draws.between(-1, 1), draws.between(-1, 1));
        if (is_paved(place) || std::abs(glm::length(place / track_radii) - 1.0f) < 0.04f) continue;
        ++i;
        const float azimuth = 2.0f * pi * draws.unit();
        const vec3 outward(std::cos(azimuth), 0, std::sin(azimuth));
        add_leaf(mesh, {place.x, -0.01f, place.y}, glm::normalize(vec3(0, 1, 0) + draws.between(0.2f, 0.9f) * outward),
                 {-outward.z, 0, outward.x}, draws.between(0.10f, 0.22f), 0.04f,
                 i % 3 == 0 ? static_cast<std::uint32_t>(leaf_mid) : blade);
    }
    return mesh;
}

LitMesh stall_mesh(std::uint32_t canvas, std::uint32_t seed) {
    LitMesh stall;
    Mesh& mesh = stall.mesh;
    Draws draws{seed};
    // Open towards +z: counter, posts, back wall with shelves of prizes, an awning in stripes.
    add_box(mesh, {{-1.7f, 0, 0.9f}, {1.7f, 1.0f, 1.05f}}, canvas);
    add_box(mesh, {{-1.8f, 1.0f, 0.75f}, {1.8f, 1.07f, 1.2f}}, timber);
    add_box(mesh, {{-1.75f, 0, -1.1f}, {1.75f, 2.7f, -1.0f}}, timber_dark);
    for (const float x : {-1.75f, 1.65f}) add_box(mesh, {{x, 0, -1.0f}, {x + 0.10f, 2.6f, 0.9f}}, timber);
    for (const float x : {-1.7f, 1.7f}) add_box(mesh, {{x - 0.06f, 0, 1.0f}, {x + 0.06f, 2.75f, 1.12f}}, canvas_white);
    for (int shelf = 0; shelf < 3; ++shelf) {
        const float y = 0.9f + 0.55f * static_cast<float>(shelf);
        add_box(mesh, {{-1.65f, y, -1.0f}, {1.65f, y + 0.04f, -0.65f}}, timber);
        for (int k = 0; k < 8; ++k) {
            const vec3 foot(-1.45f + 0.41f * static_cast<float>(k) + draws.between(-0.04f, 0.04f), y + 0.04f, -0.82f);
            const std::uint32_t colour = canvas_white + draws.below(5);
            const float size = draws.between(0.09f, 0.14f);
            add_ball(mesh, foot + vec3(0, size, 0), vec3(size, size, 0.9f * size), 10, colour);
            add_ball(mesh, foot + vec3(0, 2.3f * size, 0.02f), vec3(0.65f * size), 10, colour);
            for (const float ear : {-0.5f, 0.5f})
                add_octahedron(mesh, foot + vec3(ear * size, 2.95f * size, 0.02f), 0.3f * size, colour);
        }
    }
    constexpr int stripes = 12;
    for (int k = 0; k < stripes; ++k) {
        const float x0 = -2.0f + 4.0f / stripes * static_cast<float>(k), width = 4.0f / stripes;
        const std::uint32_t colour = k % 2 == 0 ? canvas : canvas_white;
        add_surface(
            mesh, {1, 8}, false,
            [=](vec2 uv) {
                return vec3(x0 + width * uv.x, 2.55f + 0.75f * std::sin(0.5f * pi * (0.15f + 0.85f * uv.y)),
                            1.65f - 2.85f * uv.y);
            },
            colour);
        add_surface(
            mesh, {4, 1}, false,
            [=](vec2 uv) {
                return vec3(x0 + width * uv.x, 2.72f - (0.16f + 0.10f * std::sin(pi * uv.x)) * (1.0f - uv.y), 1.66f);
            },
            colour);
    }
    for (int i = 0; i < 24; ++i)
        add_bulb(stall, {-1.95f + 3.9f * static_cast<float>(i) / 23.0f, 2.78f, 1.70f}, {0, 0, 1},
                 i % 3 == 0   ? bulb_red
                 : i % 3 == 1 ? bulb_warm
                              : bulb_white);
    for (int i = 0; i < 8; ++i)
        add_bulb(stall, {-1.4f + 0.4f * static_cast<float>(i), 2.45f, 0.2f}, {0, -1, 0}, bulb_warm);
    return stall;
}

LitMesh tent_mesh() {
    LitMesh tent;
    Mesh& mesh = tent.mesh;
    constexpr int stripes = 32;
    constexpr float radius = 8.2f, eave = 3.6f, top = 9.8f;
    for (int k = 0; k < stripes; ++k) {
        const float from = 2.0f * pi * static_cast<float>(k) / stripes, width = 2.0f * pi / stripes;
        const bool door = k == 23 || k == 24 || k == 25;
        const std::uint32_t colour = k % 2 == 0 ? canvas_red : canvas_yellow;
        add_surface(
            mesh, {4, 14}, false,
            [&](vec2 uv) {
                const float angle = -(from + uv.x * width), r = 0.15f + (radius - 0.15f) * (1.0f - uv.y);
                const float billow = 1.0f + 0.012f * std::sin(pi * uv.x);
                return vec3(billow * r * std::cos(angle), eave + (top - eave) * std::pow(uv.y, 1.5f),
                            billow * r * std::sin(angle));
            },
            colour);
        add_surface(
            mesh, {6, 2}, false,
            [&](vec2 uv) {
                const float angle = -(from + uv.x * width), hem = 0.3f + 0.3f * std::sin(pi * uv.x);
                return vec3((radius + 0.15f) * std::cos(angle), eave + 0.05f - hem * (1.0f - uv.y),
                            (radius + 0.15f) * std::sin(angle));
            },
            k % 2 == 0 ? canvas_yellow : canvas_red);
        if (!door)
            add_surface(
                mesh, {6, 4}, false,
                [&](vec2 uv) {
                    const float angle = -(from + uv.x * width), r = radius - 0.1f + 0.06f * std::sin(2.0f * pi * uv.x);
                    return vec3(r * std::cos(angle), eave * uv.y, r * std::sin(angle));
                },
                colour);
        const float angle = -from;
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        for (int i = 0; i < 14; ++i) {
            const float v = (static_cast<float>(i) + 0.5f) / 14.0f, r = 0.15f + (radius - 0.15f) * (1.0f - v);
            const vec3 slope = glm::normalize(out * (top - eave) + vec3(0, radius, 0));
            add_bulb(tent, r * out + vec3(0, eave + (top - eave) * std::pow(v, 1.5f), 0) + 0.02f * slope, slope,
                     k % 2 == 0 ? bulb_warm : bulb_white);
        }
    }
    add_rod(mesh, {0, 0, 0}, {0, top + 2.2f, 0}, 0.12f, 10, steel_white);
    add_surface(
        mesh, {12, 4}, false,
        [](vec2 uv) {
            return vec3(0.12f + 1.5f * uv.x, top + 1.5f + 0.6f * uv.y * (1.0f - uv.x) + 0.08f * std::sin(6.0f * uv.x),
                        0.12f * std::sin(7.0f * uv.x));
        },
        canvas_blue);
    return tent;
}

LitMesh gate_mesh() {
    LitMesh gate;
    Mesh& mesh = gate.mesh;
    for (const float x : {-5.0f, 5.0f}) {
        add_box(mesh, {{x - 0.7f, 0, -0.7f}, {x + 0.7f, 4.6f, 0.7f}}, canvas_red);
        add_box(mesh, {{x - 0.85f, 4.6f, -0.85f}, {x + 0.85f, 4.9f, 0.85f}}, gold);
        add_ball(mesh, {x, 5.5f, 0}, vec3(0.62f), 20, canvas_yellow);
        for (int i = 0; i < 16; ++i)
            for (const float side : {-0.5f, 0.5f})
                add_bulb(gate, {x + side, 0.4f + 0.26f * static_cast<float>(i), 0.72f}, {0, 0, 1},
                         i % 2 == 0 ? bulb_warm : bulb_red);
    }
    std::vector<vec3> arch;
    for (int i = 0; i <= 24; ++i) {
        const float angle = pi * (1.0f - static_cast<float>(i) / 24.0f);
        arch.push_back({4.6f * std::cos(angle), 4.6f + 2.2f * std::sin(angle), 0});
    }
    const std::array<vec2, 4> section = {vec2(-0.25f, -0.4f), vec2(0.25f, -0.4f), vec2(0.25f, 0.4f),
                                         vec2(-0.25f, 0.4f)};
    add_sweep(mesh, arch, {0, 0, 1}, section, false, canvas_blue);
    for (int i = 0; i < 60; ++i) {
        const float angle = pi * (static_cast<float>(i) + 0.5f) / 60.0f;
        for (const float r : {-0.14f, 0.14f})
            add_bulb(gate, {(4.6f + r) * std::cos(angle), 4.6f + (2.2f + r) * std::sin(angle), 0.42f}, {0, 0, 1},
                     i % 3 == 0 ? bulb_violet : bulb_warm);
    }
    return gate;
}

Mesh bench_mesh() {
    Mesh mesh;
    for (int k = 0; k < 4; ++k) {
        const float z = -0.2f + 0.12f * static_cast<float>(k);
        add_box(mesh, {{-0.85f, 0.42f, z}, {0.85f, 0.45f, z + 0.10f}}, timber);
        add_box(mesh,
                {{-0.85f, 0.52f + 0.11f * static_cast<float>(k), -0.29f},
                 {0.85f, 0.61f + 0.11f * static_cast<float>(k), -0.26f}},
                timber);
    }
    for (const float x : {-0.7f, 0.7f}) {
        add_box(mesh, {{x - 0.03f, 0, -0.26f}, {x + 0.03f, 0.42f, 0.26f}}, steel_dark);
        add_box(mesh, {{x - 0.03f, 0.42f, -0.32f}, {x + 0.03f, 0.95f, -0.29f}}, steel_dark);
    }
    return mesh;
}

void add_string(LitMesh& lit, vec3 from, vec3 to, float sag_m, int bulbs, std::uint32_t seed) {
    const auto at = [&](float t) { return glm::mix(from, to, t) - vec3(0, 4.0f * sag_m * t * (1.0f - t), 0); };
    std::vector<TubeRing> wire;
    for (int i = 0; i <= 12; ++i) wire.push_back({at(static_cast<float>(i) / 12.0f), 0.012f});
    add_tube(lit.mesh, wire, 3, steel_dark);
    for (int i = 0; i < bulbs; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(bulbs);
        const std::uint32_t draw = random_u32(71, seed, static_cast<std::uint32_t>(i)) % 10u;
        add_bulb(lit, at(t) - vec3(0, 0.03f, 0), {0, -1, 0},
                 draw < 5 ? static_cast<std::uint32_t>(bulb_warm) : bulb_red + draw % 5u);
    }
}

}  // namespace sightlines::park
