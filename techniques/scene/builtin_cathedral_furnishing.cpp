#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_cathedral.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::cathedral {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

void add_candle(Mesh& mesh, vec3 foot, float height, float radius) {
    add_rod(mesh, foot, foot + vec3(0, height, 0), radius, 10, candle);
    add_ball(mesh, foot + vec3(0, height + 0.035f, 0), {0.010f, 0.028f, 0.010f}, 8, flame);
}

}  // namespace

std::vector<Material> materials() {
    std::vector<Material> all = {
        diffuse("stone", {0.56f, 0.51f, 0.43f}),        diffuse("light stone", {0.66f, 0.61f, 0.53f}),
        diffuse("dark stone", {0.38f, 0.345f, 0.295f}), diffuse("warm stone", {0.58f, 0.48f, 0.36f}),
        diffuse("vault", {0.68f, 0.64f, 0.56f}),        diffuse("pale floor", {0.62f, 0.58f, 0.50f}),
        diffuse("dark floor", {0.17f, 0.165f, 0.16f}),  diffuse("red floor", {0.40f, 0.16f, 0.11f}),
        diffuse("oak", {0.30f, 0.175f, 0.085f}),        diffuse("dark oak", {0.19f, 0.105f, 0.05f}),
        diffuse("brass", {0.56f, 0.40f, 0.15f}, 0.4f),  diffuse("iron", {0.07f, 0.07f, 0.075f}, 0.6f),
        diffuse("candle", {0.80f, 0.74f, 0.60f}),       diffuse("flame", {0.8f, 0.6f, 0.3f}),
        diffuse("red cloth", {0.42f, 0.03f, 0.04f}),    diffuse("white cloth", {0.80f, 0.78f, 0.72f}),
        diffuse("lead", {0.02f, 0.02f, 0.025f}),        diffuse("door", {0.21f, 0.12f, 0.06f}),
    };
    constexpr std::array<vec3, glass_colours> panes = {
        vec3(0.75f, 0.06f, 0.05f), vec3(0.85f, 0.20f, 0.04f), vec3(0.05f, 0.13f, 0.70f), vec3(0.06f, 0.24f, 0.85f),
        vec3(0.95f, 0.66f, 0.10f), vec3(0.90f, 0.82f, 0.45f), vec3(0.06f, 0.45f, 0.20f), vec3(0.42f, 0.10f, 0.55f)};
    for (std::uint32_t i = 0; i < glass_colours; ++i) {
        all.push_back(diffuse("glass " + std::to_string(i + 1), 0.3f * panes[i], 0.2f));
        all.back().emissive = 1.5f * panes[i];
    }
    for (Material& material : all) material.double_sided = false;
    all[flame].emissive = {9.0f, 5.0f, 1.6f};
    return all;
}

Mesh pew_mesh() {
    Mesh mesh;
    constexpr float half = 1.95f;
    add_box(mesh, {{-0.24f, 0.42f, -half}, {0.22f, 0.47f, half}}, oak);
    Mesh back;
    add_box(back, {{-0.02f, 0.0f, -half}, {0.02f, 0.46f, half}}, oak);
    for (int k = 0; k < 8; ++k) {  // panels
        const float z = -half + 0.06f + 0.475f * static_cast<float>(k);
        add_box(back, {{-0.032f, 0.08f, z}, {-0.02f, 0.38f, z + 0.40f}}, oak_dark);
    }
    add_rod(back, {0.0f, 0.47f, -half}, {0.0f, 0.47f, half}, 0.035f, 8, oak_dark);
    append(mesh, back, placed({-0.26f, 0.45f, 0.0f}) * turned_about({0, 0, 1}, 0.14f));
    add_box(mesh, {{-0.62f, 0.68f, -half + 0.06f}, {-0.36f, 0.70f, half - 0.06f}}, oak);  // shelf for books
    add_box(mesh, {{-0.75f, 0.12f, -half + 0.1f}, {-0.55f, 0.18f, half - 0.1f}}, cloth_red);
    // Carved ends: a curved outline with a poppyhead on top.
    constexpr std::array<vec2, 11> end = {vec2(-0.34f, 0.0f),  vec2(0.28f, 0.0f),   vec2(0.30f, 0.50f),
                                          vec2(0.18f, 0.60f),  vec2(0.02f, 0.70f),  vec2(-0.12f, 0.88f),
                                          vec2(-0.20f, 1.10f), vec2(-0.30f, 1.16f), vec2(-0.40f, 1.10f),
                                          vec2(-0.40f, 0.80f), vec2(-0.36f, 0.40f)};
    for (const float z : {-half - 0.06f, half}) {
        std::vector<vec3> front, rear;
        for (const vec2 p : end) front.push_back({p.x, p.y, z + 0.06f});
        for (const vec2 p : end) rear.insert(rear.begin(), {p.x, p.y, z});
        add_outline(mesh, front, oak_dark);
        add_outline(mesh, rear, oak_dark);
        for (std::size_t i = 0; i < end.size(); ++i) {
            const vec2 a = end[i], b = end[(i + 1) % end.size()];
            add_polygon(mesh,
                        std::array<vec3, 4>{vec3(a.x, a.y, z + 0.06f), vec3(a.x, a.y, z), vec3(b.x, b.y, z),
                                            vec3(b.x, b.y, z + 0.06f)},
                        oak_dark);
        }
        add_ball(mesh, {-0.30f, 1.22f, z + 0.03f}, {0.07f, 0.09f, 0.05f}, 14, oak_dark);
    }
    return mesh;
}

Mesh chandelier_mesh(float rod_m) {
    Mesh mesh;
    add_rod(mesh, {0, -rod_m - 0.1f, 0}, {0, 0, 0}, 0.018f, 6, iron);
    const float y = -rod_m - 1.0f;
    for (const auto& [radius, size] : {std::pair{chandelier_radius, 0.06f}, std::pair{0.45f, 0.05f}}) {
        std::vector<vec3> ring;
        for (int i = 0; i < 48; ++i) {
            const float angle = -2.0f * pi * static_cast<float>(i) / 48.0f;
            ring.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
        }
        const float h = 0.5f * size;
        const std::array<vec2, 4> square = {vec2(-h, -h), vec2(h, -h), vec2(h, h), vec2(-h, h)};
        add_sweep(mesh, ring, {0, 1, 0}, square, true, brass);
    }
    for (int k = 0; k < 8; ++k) {
        const float angle = 0.25f * pi * static_cast<float>(k);
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        add_rod(mesh, vec3(0, -rod_m - 0.05f, 0), vec3(0, y, 0) + chandelier_radius * out, 0.009f, 5, iron);
        add_rod(mesh, vec3(0, y, 0) + 0.45f * out, vec3(0, y, 0) + chandelier_radius * out, 0.012f, 5, brass);
    }
    for (int k = 0; k < chandelier_candles; ++k) {
        const float angle = 2.0f * pi * (static_cast<float>(k) + 0.5f) / chandelier_candles;
        const vec3 foot(chandelier_radius * std::cos(angle), y + 0.03f, chandelier_radius * std::sin(angle));
        Mesh dish;
        const std::array<vec2, 5> profile = {vec2(0.02f, 0), vec2(0.05f, 0.02f), vec2(0.06f, 0.05f),
                                             vec2(0.045f, 0.05f), vec2(0.0f, 0.03f)};
        add_revolution(dish, profile, 12, brass);
        append(mesh, dish, placed(foot));
        add_candle(mesh, foot + vec3(0, 0.03f, 0), 0.20f, 0.018f);
    }
    return mesh;
}

Mesh altar_mesh() {
    Mesh mesh;
    add_box(mesh, {{-0.55f, 0.0f, -1.6f}, {0.55f, 0.95f, 1.6f}}, stone_light);
    add_box(mesh, {{-0.65f, 0.95f, -1.75f}, {0.65f, 1.05f, 1.75f}}, stone);
    add_box(mesh, {{-0.67f, 1.05f, -1.2f}, {0.67f, 1.065f, 1.2f}}, cloth_white);
    add_surface(
        mesh, {60, 8}, false,
        [](vec2 uv) {
            return vec3(-0.68f - 0.02f * std::sin(40.0f * uv.x) * uv.y, 1.06f - 0.75f * uv.y, -1.2f + 2.4f * uv.x);
        },
        cloth_red);
    for (int k = 0; k < 6; ++k) {
        Mesh panel;
        add_ball(panel, {0, 0, 0}, {0.03f, 0.22f, 0.14f}, 16, stone);
        append(mesh, panel, placed({0.56f, 0.5f, -1.25f + 0.5f * static_cast<float>(k)}));
    }
    add_box(mesh, {{0.28f, 1.05f, -0.12f}, {0.44f, 1.15f, 0.12f}}, brass);
    add_box(mesh, {{0.34f, 1.15f, -0.025f}, {0.38f, 2.15f, 0.025f}}, brass);
    add_box(mesh, {{0.34f, 1.72f, -0.32f}, {0.38f, 1.78f, 0.32f}}, brass);
    return mesh;
}

Mesh candlestick_mesh() {
    Mesh mesh;
    constexpr std::array<vec2, 16> profile = {
        vec2(0.15f, 0),     vec2(0.15f, 0.03f), vec2(0.10f, 0.07f),  vec2(0.04f, 0.12f),
        vec2(0.03f, 0.35f), vec2(0.06f, 0.40f), vec2(0.03f, 0.46f),  vec2(0.028f, 0.85f),
        vec2(0.05f, 0.90f), vec2(0.03f, 0.95f), vec2(0.025f, 1.30f), vec2(0.04f, 1.34f),
        vec2(0.10f, 1.38f), vec2(0.11f, 1.42f), vec2(0.05f, 1.41f),  vec2(0.0f, 1.41f)};
    add_revolution(mesh, profile, 24, brass);
    add_candle(mesh, {0, 1.41f, 0}, 0.32f, 0.03f);
    return mesh;
}

Mesh pulpit_mesh() {
    Mesh mesh;
    constexpr std::array<vec2, 12> foot = {vec2(0.55f, 0),     vec2(0.55f, 0.12f), vec2(0.40f, 0.18f),
                                           vec2(0.26f, 0.30f), vec2(0.24f, 1.10f), vec2(0.34f, 1.24f),
                                           vec2(0.62f, 1.45f), vec2(0.86f, 1.62f), vec2(0.86f, 1.70f),
                                           vec2(0.80f, 1.72f), vec2(0.80f, 2.55f), vec2(0.0f, 2.55f)};
    add_revolution(mesh, foot, 8, stone_light);
    constexpr std::array<vec2, 6> rim = {vec2(0.80f, 2.55f), vec2(0.92f, 2.58f), vec2(0.94f, 2.66f),
                                         vec2(0.90f, 2.70f), vec2(0.70f, 2.70f), vec2(0.0f, 2.69f)};
    add_revolution(mesh, rim, 8, oak);
    constexpr std::array<vec2, 7> roof = {vec2(0.0f, 4.3f),  vec2(1.05f, 4.3f), vec2(1.15f, 4.36f), vec2(1.10f, 4.46f),
                                          vec2(0.5f, 4.75f), vec2(0.12f, 5.3f), vec2(0.0f, 5.9f)};
    add_revolution(mesh, roof, 8, oak_dark);
    add_box(mesh, {{0.70f, 2.4f, -0.25f}, {0.80f, 4.32f, 0.25f}}, oak_dark);
    return mesh;
}

}  // namespace sightlines::cathedral
