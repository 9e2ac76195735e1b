// What stands in the built-in street: the terrace, lamps, bicycles, planters, a fountain, strings of lights.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_shapes.h"
#include "techniques/scene/builtin_street.h"

namespace sightlines::street {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// A tube of even radius through the points.
void add_pipe(Mesh& mesh, std::span<const vec3> points, float radius_m, int sides, std::uint32_t material) {
    std::vector<TubeRing> rings;
    for (const vec3 point : points) rings.push_back({point, radius_m});
    add_tube(mesh, rings, sides, material);
}

/// Points on an arc in the plane of two axes about `centre`.
std::vector<vec3> arc(vec3 centre, vec3 axis_u, vec3 axis_v, float from_rad, float to_rad, int steps) {
    std::vector<vec3> points;
    for (int i = 0; i <= steps; ++i) {
        const float angle = from_rad + (to_rad - from_rad) * static_cast<float>(i) / static_cast<float>(steps);
        points.push_back(centre + std::cos(angle) * axis_u + std::sin(angle) * axis_v);
    }
    return points;
}

void add_turned(Mesh& mesh, vec3 foot, std::span<const vec2> profile, int segments, std::uint32_t material) {
    Mesh turned;
    add_revolution(turned, profile, segments, material);
    append(mesh, turned, placed(foot));
}

void add_glass(Mesh& mesh, vec3 foot) {
    const std::array<vec2, 9> profile = {vec2(0.0f, 0.0f),    vec2(0.034f, 0.0f),  vec2(0.006f, 0.008f),
                                         vec2(0.005f, 0.08f), vec2(0.03f, 0.1f),   vec2(0.038f, 0.13f),
                                         vec2(0.03f, 0.18f),  vec2(0.028f, 0.18f), vec2(0.03f, 0.14f)};
    add_turned(mesh, foot, profile, 16, porcelain);
    const std::array<vec2, 3> drink = {vec2(0.005f, 0.09f), vec2(0.034f, 0.135f), vec2(0.0f, 0.135f)};
    add_turned(mesh, foot, drink, 16, wine);
}

void add_cup(Mesh& mesh, vec3 foot) {
    const std::array<vec2, 4> saucer = {vec2(0.0f, 0.0f), vec2(0.04f, 0.0f), vec2(0.08f, 0.014f), vec2(0.0f, 0.01f)};
    add_turned(mesh, foot, saucer, 20, porcelain);
    const std::array<vec2, 5> cup = {vec2(0.02f, 0.01f), vec2(0.036f, 0.03f), vec2(0.04f, 0.07f), vec2(0.037f, 0.07f),
                                     vec2(0.03f, 0.03f)};
    add_turned(mesh, foot, cup, 18, porcelain);
    const std::vector<vec3> ear =
        arc(foot + vec3(0.04f, 0.045f, 0.0f), {0.02f, 0.0f, 0.0f}, {0.0f, 0.02f, 0.0f}, -0.5f * pi, 0.5f * pi, 8);
    add_pipe(mesh, ear, 0.004f, 6, porcelain);
}

void add_bottle(Mesh& mesh, vec3 foot) {
    const std::array<vec2, 7> profile = {vec2(0.0f, 0.0f),    vec2(0.038f, 0.0f),  vec2(0.038f, 0.19f),
                                         vec2(0.03f, 0.215f), vec2(0.014f, 0.24f), vec2(0.014f, 0.3f),
                                         vec2(0.0f, 0.3f)};
    add_turned(mesh, foot, profile, 18, bottle);
}

/// A wheel in the plane z = 0 about `centre`.
void add_wheel(Mesh& mesh, vec3 centre) {
    constexpr float radius = 0.34f;
    const std::vector<vec3> ring = arc(centre, {radius, 0.0f, 0.0f}, {0.0f, radius, 0.0f}, 0.0f, 2.0f * pi, 36);
    add_pipe(mesh, ring, 0.018f, 8, tyre);
    for (int i = 0; i < 24; ++i) {
        const float angle = 2.0f * pi * static_cast<float>(i) / 24.0f;
        const vec3 rim = centre + radius * vec3(std::cos(angle), std::sin(angle), 0.0f);
        add_rod(mesh, centre + vec3(0.0f, 0.0f, i % 2 == 0 ? 0.025f : -0.025f), rim, 0.0018f, 4, zinc);
    }
    add_rod(mesh, centre - vec3(0.0f, 0.0f, 0.05f), centre + vec3(0.0f, 0.0f, 0.05f), 0.02f, 10, zinc);
}

}  // namespace

Mesh table_mesh(std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    constexpr float high = 0.74f;
    const std::array<vec2, 7> top = {vec2(0.0f, high - 0.03f),
                                     vec2(0.34f, high - 0.03f),
                                     vec2(0.35f, high - 0.022f),
                                     vec2(0.352f, high - 0.015f),
                                     vec2(0.35f, high - 0.006f),
                                     vec2(0.34f, high),
                                     vec2(0.0f, high)};
    add_turned(mesh, {}, top, 40, marble);
    const std::array<vec2, 8> stem = {vec2(0.05f, 0.08f),  vec2(0.055f, 0.14f), vec2(0.03f, 0.2f),  vec2(0.022f, 0.32f),
                                      vec2(0.035f, 0.37f), vec2(0.022f, 0.42f), vec2(0.02f, 0.64f), vec2(0.12f, 0.71f)};
    add_turned(mesh, {}, stem, 16, iron);
    for (int i = 0; i < 3; ++i) {
        const float angle = 2.0f * pi * static_cast<float>(i) / 3.0f;
        const vec3 out(std::cos(angle), 0.0f, std::sin(angle));
        const std::array<vec3, 5> foot = {vec3(0.0f, 0.16f, 0.0f), 0.1f * out + vec3(0.0f, 0.15f, 0.0f),
                                          0.2f * out + vec3(0.0f, 0.07f, 0.0f), 0.28f * out + vec3(0.0f, 0.02f, 0.0f),
                                          0.33f * out + vec3(0.0f, 0.02f, 0.0f)};
        add_pipe(mesh, foot, 0.018f, 8, iron);
    }
    const auto spot = [&](float from_deg) {
        const float angle = from_deg / 180.0f * pi + draws.between(-0.5f, 0.5f), radius = draws.between(0.14f, 0.25f);
        return vec3(radius * std::cos(angle), high, radius * std::sin(angle));
    };
    for (const float turn : {20.0f, 110.0f, 200.0f})
        if (draws.unit() < 0.55f)
            add_glass(mesh, spot(turn));
        else
            add_cup(mesh, spot(turn));
    if (draws.unit() < 0.6f) add_bottle(mesh, spot(290.0f));
    return mesh;
}

Mesh chair_mesh() {
    Mesh mesh;
    constexpr float seat = 0.46f, half = 0.2f;
    const std::array<vec2, 5> pad = {vec2(0.0f, seat - 0.025f), vec2(half, seat - 0.025f),
                                     vec2(half + 0.012f, seat - 0.01f), vec2(half, seat + 0.005f), vec2(0.0f, seat)};
    add_turned(mesh, {}, pad, 28, cane);
    add_pipe(mesh, arc({0.0f, seat - 0.02f, 0.0f}, {half, 0.0f, 0.0f}, {0.0f, 0.0f, half}, 0.0f, 2.0f * pi, 28), 0.016f,
             8, timber);
    for (const float x : {-1.0f, 1.0f}) {
        const std::array<vec3, 4> front_leg = {vec3(x * 0.15f, seat, 0.14f), vec3(x * 0.17f, 0.3f, 0.16f),
                                               vec3(x * 0.19f, 0.1f, 0.19f), vec3(x * 0.2f, 0.0f, 0.21f)};
        add_pipe(mesh, front_leg, 0.014f, 8, timber);
        const std::array<vec3, 4> back_leg = {vec3(x * 0.15f, seat, -0.15f), vec3(x * 0.165f, 0.3f, -0.18f),
                                              vec3(x * 0.18f, 0.1f, -0.22f), vec3(x * 0.19f, 0.0f, -0.25f)};
        add_pipe(mesh, back_leg, 0.014f, 8, timber);
    }
    add_pipe(mesh, arc({0.0f, 0.2f, 0.0f}, {0.17f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.19f}, 0.0f, 2.0f * pi, 20), 0.008f, 6,
             timber);
    // The bent back: an outer and an inner hoop, and woven cane between.
    for (const float size : {1.0f, 0.62f}) {
        std::vector<vec3> hoop;
        for (int i = 0; i <= 24; ++i) {
            const float t = static_cast<float>(i) / 24.0f, angle = pi * t;
            const float up = size * 0.46f * std::pow(std::max(std::sin(angle), 0.0f), 0.6f);
            hoop.push_back({-0.17f * size * std::cos(angle), seat + up, -0.16f - 0.22f * up});
        }
        add_pipe(mesh, hoop, 0.012f, 8, timber);
    }
    for (int i = -4; i <= 4; ++i) {
        const float x = 0.022f * static_cast<float>(i);
        add_rod(mesh, {x, seat, -0.165f}, {x, seat + 0.27f, -0.222f}, 0.0035f, 5, cane);
    }
    for (int i = 1; i < 9; ++i) {
        const float up = 0.029f * static_cast<float>(i);
        add_rod(mesh, {-0.1f, seat + up, -0.163f - 0.22f * up}, {0.1f, seat + up, -0.163f - 0.22f * up}, 0.0035f, 5,
                cane);
    }
    return mesh;
}

Mesh parasol_mesh(std::uint32_t canvas) {
    Mesh mesh;
    constexpr float rim = 2.25f, apex = 2.85f, radius = 1.55f;
    add_rod(mesh, {0.0f, 0.0f, 0.0f}, {0.0f, apex, 0.0f}, 0.025f, 12, timber);
    const std::array<vec2, 4> base = {vec2(0.0f, 0.0f), vec2(0.28f, 0.0f), vec2(0.26f, 0.07f), vec2(0.0f, 0.1f)};
    add_turned(mesh, {}, base, 24, iron);
    constexpr int ribs = 8;
    for (int i = 0; i < ribs; ++i) {
        const float from = 2.0f * pi * static_cast<float>(i) / ribs, step = 2.0f * pi / ribs;
        add_surface(
            mesh, {8, 8}, false,
            [&](vec2 uv) {
                const float angle = from + step * (1.0f - uv.x), sag = 4.0f * uv.x * (1.0f - uv.x);
                const float out = radius * (1.0f - uv.y) * (1.0f - 0.05f * sag);
                return vec3(out * std::cos(angle), apex - (apex - rim) * (1.0f - uv.y) - 0.07f * sag * (1.0f - uv.y),
                            out * std::sin(angle));
            },
            canvas);
        const vec3 tip(radius * std::cos(from), rim, radius * std::sin(from));
        add_rod(mesh, {0.0f, apex - 0.03f, 0.0f}, tip - vec3(0.0f, 0.03f, 0.0f), 0.009f, 6, timber);
        add_rod(mesh, {0.0f, rim - 0.1f, 0.0f}, glm::mix(vec3(0.0f, apex, 0.0f), tip, 0.55f), 0.007f, 5, timber);
    }
    return mesh;
}

Mesh lamp_mesh() {
    Mesh mesh;
    const std::array<vec2, 15> column = {
        vec2(0.22f, 0.0f),  vec2(0.22f, 0.12f), vec2(0.16f, 0.18f), vec2(0.15f, 0.6f),   vec2(0.18f, 0.66f),
        vec2(0.1f, 0.78f),  vec2(0.075f, 0.9f), vec2(0.06f, 2.2f),  vec2(0.085f, 2.26f), vec2(0.055f, 2.34f),
        vec2(0.045f, 3.3f), vec2(0.08f, 3.36f), vec2(0.04f, 3.44f), vec2(0.03f, 3.7f),   vec2(0.0f, 3.7f)};
    add_turned(mesh, {}, column, 20, iron);
    for (int i = 0; i < 10; ++i) {
        const float angle = 2.0f * pi * static_cast<float>(i) / 10.0f;
        const vec3 out(std::cos(angle), 0.0f, std::sin(angle));
        add_rod(mesh, 0.072f * out + vec3(0.0f, 0.92f, 0.0f), 0.06f * out + vec3(0.0f, 2.18f, 0.0f), 0.011f, 5, iron);
    }
    const std::array<vec2, 4> light = {vec2(0.1f, 0.0f), vec2(0.17f, 0.42f), vec2(0.12f, 0.5f), vec2(0.0f, 0.5f)};
    const std::array<vec2, 6> cap = {vec2(0.21f, 0.42f), vec2(0.22f, 0.45f), vec2(0.13f, 0.56f),
                                     vec2(0.05f, 0.62f), vec2(0.02f, 0.72f), vec2(0.0f, 0.72f)};
    for (const float side : {-1.0f, 0.0f, 1.0f}) {
        const vec3 foot(0.62f * side, side == 0.0f ? 3.7f : 3.42f, 0.0f);
        add_turned(mesh, foot, light, 6, lantern);
        add_turned(mesh, foot, cap, 12, iron);
        for (int i = 0; i < 6; ++i) {
            const float angle = 2.0f * pi * static_cast<float>(i) / 6.0f;
            const vec3 out(std::cos(angle), 0.0f, std::sin(angle));
            add_rod(mesh, foot + 0.103f * out, foot + 0.173f * out + vec3(0.0f, 0.43f, 0.0f), 0.009f, 5, iron);
        }
        if (side == 0.0f) continue;
        std::vector<vec3> arm =
            arc({0.31f * side, 3.42f, 0.0f}, {-0.31f * side, 0.0f, 0.0f}, {0.0f, -0.32f, 0.0f}, 0.0f, pi, 20);
        add_pipe(mesh, arm, 0.018f, 8, iron);
        add_pipe(mesh, arc({0.25f * side, 3.42f, 0.0f}, {0.1f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.0f}, 0.0f, 1.7f * pi, 18),
                 0.012f, 6, iron);
    }
    return mesh;
}

Mesh bicycle_mesh(std::uint32_t paint) {
    Mesh mesh;
    const vec3 front(0.52f, 0.36f, 0.0f), back(-0.52f, 0.36f, 0.0f), crank(-0.08f, 0.3f, 0.0f);
    const vec3 seat(-0.22f, 0.86f, 0.0f), head(0.36f, 0.84f, 0.0f);
    add_wheel(mesh, front);
    add_wheel(mesh, back);
    for (const auto& [from, to] : {std::pair{crank, seat}, {seat - vec3(0.0f, 0.12f, 0.0f), head}, {crank, head}})
        add_rod(mesh, from, to, 0.016f, 10, paint);
    for (const float z : {-0.04f, 0.04f}) {
        const vec3 off(0.0f, 0.0f, z);
        add_rod(mesh, back + off, crank, 0.009f, 8, paint);
        add_rod(mesh, back + off, seat - vec3(0.0f, 0.1f, 0.0f), 0.009f, 8, paint);
        add_rod(mesh, front + off, head - vec3(0.0f, 0.1f, 0.0f), 0.011f, 8, paint);
    }
    add_rod(mesh, head - vec3(0.0f, 0.1f, 0.0f), head + vec3(-0.04f, 0.16f, 0.0f), 0.014f, 10, zinc);
    const vec3 bar = head + vec3(-0.04f, 0.16f, 0.0f);
    const std::array<vec3, 5> handle = {bar + vec3(-0.2f, 0.0f, -0.28f), bar + vec3(-0.05f, 0.01f, -0.24f), bar,
                                        bar + vec3(-0.05f, 0.01f, 0.24f), bar + vec3(-0.2f, 0.0f, 0.28f)};
    add_pipe(mesh, handle, 0.011f, 8, zinc);
    add_rod(mesh, seat, seat + vec3(-0.02f, 0.1f, 0.0f), 0.013f, 8, zinc);
    add_cushion(mesh, {seat + vec3(-0.16f, 0.1f, -0.08f), seat + vec3(0.12f, 0.16f, 0.08f)}, 0.03f, 3, timber);
    add_rod(mesh, crank - vec3(0.0f, 0.0f, 0.06f), crank + vec3(0.0f, 0.0f, 0.06f), 0.09f, 24, zinc);
    // A basket before the handlebar.
    const vec3 basket = head + vec3(0.2f, 0.0f, 0.0f);
    for (int row = 0; row < 6; ++row) {
        const float size = 0.1f + 0.012f * static_cast<float>(row);
        add_pipe(mesh,
                 arc(basket + vec3(0.0f, 0.04f * static_cast<float>(row), 0.0f), {size, 0.0f, 0.0f},
                     {0.0f, 0.0f, 1.3f * size}, 0.0f, 2.0f * pi, 20),
                 0.006f, 5, cane);
    }
    return mesh;
}

Mesh planter_mesh(std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const std::array<vec2, 7> pot_profile = {vec2(0.0f, 0.0f),  vec2(0.24f, 0.0f),  vec2(0.34f, 0.48f),
                                             vec2(0.37f, 0.5f), vec2(0.37f, 0.56f), vec2(0.33f, 0.56f),
                                             vec2(0.0f, 0.5f)};
    add_turned(mesh, {}, pot_profile, 28, pot);
    const vec3 centre(0.0f, 0.95f, 0.0f), radii(0.42f, 0.46f, 0.42f);
    const auto spot = [&](Draws& d) { return spot_on_ball(centre, d.between(0.5f, 1.0f) * radii, d); };
    add_leaf_cover(mesh, {2600, 0.085f, 0.5f, 0.05f, 0.9f, leaf_dark, 3}, draws, spot);
    add_leaf_cover(mesh, {160, 0.06f, 0.95f, 0.08f, 0.9f, petal_red + draws.below(3), 1}, draws, spot);
    return mesh;
}

Mesh fountain_mesh() {
    Mesh mesh;
    const std::array<vec2, 10> basin = {vec2(1.85f, 0.0f),  vec2(1.85f, 0.15f), vec2(1.7f, 0.2f),  vec2(1.72f, 0.42f),
                                        vec2(1.84f, 0.48f), vec2(1.84f, 0.56f), vec2(1.6f, 0.56f), vec2(1.6f, 0.3f),
                                        vec2(1.5f, 0.28f),  vec2(0.0f, 0.28f)};
    add_turned(mesh, {}, basin, 72, trim_dark);
    add_turned(mesh, {0.0f, 0.45f, 0.0f}, std::array<vec2, 2>{vec2(1.6f, 0.0f), vec2(0.0f, 0.0f)}, 72, water);
    const std::array<vec2, 16> stem = {vec2(0.4f, 0.3f),   vec2(0.4f, 0.55f),  vec2(0.22f, 0.66f), vec2(0.16f, 0.9f),
                                       vec2(0.2f, 1.05f),  vec2(0.14f, 1.15f), vec2(0.3f, 1.28f),  vec2(0.78f, 1.5f),
                                       vec2(0.84f, 1.58f), vec2(0.76f, 1.58f), vec2(0.3f, 1.44f),  vec2(0.13f, 1.42f),
                                       vec2(0.1f, 1.8f),   vec2(0.16f, 1.95f), vec2(0.06f, 2.1f),  vec2(0.0f, 2.3f)};
    add_turned(mesh, {}, stem, 56, trim);
    for (int i = 0; i < 14; ++i) {
        const float angle = 2.0f * pi * static_cast<float>(i) / 14.0f;
        const vec3 out(std::cos(angle), 0.0f, std::sin(angle));
        std::vector<vec3> jet;
        for (int k = 0; k <= 10; ++k) {
            const float t = static_cast<float>(k) / 10.0f;
            jet.push_back(vec3(0.0f, 1.56f - 1.1f * t * t, 0.0f) + (0.84f + 0.4f * t) * out);
        }
        add_pipe(mesh, jet, 0.012f, 6, water);
    }
    return mesh;
}

Mesh string_of_lights_mesh(vec3 from, vec3 to) {
    Mesh mesh;
    constexpr int steps = 28;
    std::vector<vec3> cable;
    for (int i = 0; i <= steps; ++i) {
        const float t = static_cast<float>(i) / steps;
        cable.push_back(glm::mix(from, to, t) - vec3(0.0f, 0.9f * 4.0f * t * (1.0f - t), 0.0f));
    }
    add_pipe(mesh, cable, 0.008f, 5, iron);
    for (int i = 2; i < steps; i += 2) {
        add_rod(mesh, cable[static_cast<std::size_t>(i)], cable[static_cast<std::size_t>(i)] - vec3(0.0f, 0.07f, 0.0f),
                0.02f, 8, iron);
        add_ball(mesh, cable[static_cast<std::size_t>(i)] - vec3(0.0f, 0.13f, 0.0f), vec3(0.06f), 14, bulb);
    }
    return mesh;
}

}  // namespace sightlines::street
