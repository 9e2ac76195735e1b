#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_atrium.h"

namespace sightlines::atrium {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// 0 to 1 with level ends.
float eased(float t) {
    const float c = glm::clamp(t, 0.0f, 1.0f);
    return c * c * (3.0f - 2.0f * c);
}

/// A direction near `axis`, off by up to about `spread` (tangent of the angle).
vec3 near_direction(vec3 axis, float spread, Draws& draws) {
    const float u = draws.unit(), v = draws.unit();
    return glm::normalize(axis + spread * sphere_direction(u, v));
}

/// Unit vector across `direction`, level where that is possible, rolled by `roll_rad`.
vec3 across(vec3 direction, float roll_rad) {
    const vec3 level = glm::cross(direction, vec3(0.0f, 1.0f, 0.0f));
    const vec3 side = glm::dot(level, level) > 1e-6f ? glm::normalize(level) : vec3(1.0f, 0.0f, 0.0f);
    return glm::normalize(std::cos(roll_rad) * side + std::sin(roll_rad) * glm::cross(direction, side));
}

/// One half of a curtain: from the middle of the opening to the column at x = side * 1.22, drawn aside at the tie.
vec3 curtain_point(vec2 uv, float side, float phase) {
    constexpr float top = 3.18f, tie = 0.60f;
    const float v = uv.y;
    const float inner =
        v < tie ? 0.02f + 0.91f * std::pow(v / tie, 2.2f) : 0.93f - 0.30f * eased((v - tie) / (1.0f - tie));
    constexpr float outer = 1.24f;
    const float width = outer - inner;
    // The cloth keeps its length: the narrower it is drawn, the deeper its folds; pinched where the tie holds it.
    const float pinch = 1.0f - 0.45f * std::exp(-std::pow((v - tie) / 0.05f, 2.0f));
    const float depth = glm::clamp(0.05f + 0.04f * (1.2f - width), 0.0f, 0.068f) * pinch;
    const float fold = 2.0f * pi * 4.0f * uv.x + phase + 0.8f * std::sin(2.3f * v + phase);
    const float x = inner + width * uv.x + 0.2f * depth * std::sin(2.0f * fold) * uv.x * (1.0f - uv.x);
    const float droop = 0.15f * (1.0f - uv.x) * eased(v / tie) * (1.0f - eased((v - tie) / 0.30f));
    return {side * x, top - (top - 0.04f) * v - droop,
            depth * std::sin(fold) + 0.25f * depth * std::sin(0.5f * fold + 1.0f)};
}

}  // namespace

std::vector<Material> materials() {
    std::vector<Material> all = {
        diffuse("limestone", {0.60f, 0.47f, 0.31f}),
        diffuse("light limestone", {0.71f, 0.61f, 0.45f}),
        diffuse("dark limestone", {0.42f, 0.32f, 0.21f}),
        diffuse("marble", {0.78f, 0.74f, 0.67f}, 0.6f),
        diffuse("plaster", {0.62f, 0.42f, 0.24f}),
        diffuse("warm plaster", {0.56f, 0.35f, 0.19f}),
        diffuse("pale plaster", {0.66f, 0.48f, 0.30f}),
        diffuse("red brick", {0.44f, 0.13f, 0.07f}),
        diffuse("terracotta tile", {0.42f, 0.17f, 0.085f}),
        diffuse("light terracotta tile", {0.49f, 0.22f, 0.115f}),
        diffuse("dark terracotta tile", {0.34f, 0.125f, 0.065f}),
        diffuse("roof tile", {0.45f, 0.16f, 0.075f}),
        diffuse("wood", {0.20f, 0.105f, 0.05f}),
        diffuse("dark wood", {0.125f, 0.062f, 0.03f}),
        diffuse("bronze", {0.22f, 0.14f, 0.06f}, 0.4f),
        diffuse("water", {0.05f, 0.17f, 0.20f}, 0.1f),
        diffuse("crimson cloth", {0.46f, 0.025f, 0.035f}),
        diffuse("ultramarine cloth", {0.035f, 0.075f, 0.36f}),
        diffuse("saffron cloth", {0.74f, 0.36f, 0.035f}),
        diffuse("emerald cloth", {0.02f, 0.24f, 0.13f}),
        diffuse("clay", {0.50f, 0.20f, 0.10f}),
        diffuse("teal glaze", {0.03f, 0.20f, 0.24f}, 0.3f),
        diffuse("white glaze", {0.75f, 0.75f, 0.70f}, 0.3f),
        diffuse("soil", {0.07f, 0.045f, 0.03f}),
        diffuse("dark leaf", {0.045f, 0.15f, 0.03f}),
        diffuse("leaf", {0.09f, 0.25f, 0.04f}),
        diffuse("light leaf", {0.19f, 0.36f, 0.06f}),
        diffuse("agave", {0.13f, 0.27f, 0.15f}),
        diffuse("twig", {0.14f, 0.08f, 0.04f}),
        diffuse("lantern glass", {0.8f, 0.6f, 0.3f}),
    };
    all[lantern_glass].emissive = {3.2f, 1.7f, 0.6f};
    // Cloths, leaves and blades are sheets; all else bounds something solid.
    for (Material& material : all) material.double_sided = false;
    for (const auto sheet : {crimson, ultramarine, saffron, emerald, leaf_dark, leaf_mid, leaf_light, blade_green})
        all[sheet].double_sided = true;
    return all;
}

Mesh curtain_mesh(std::uint32_t material, std::uint32_t seed) {
    Mesh mesh;
    for (const float side : {-1.0f, 1.0f}) {
        const float phase = 6.0f * random_unit(0, seed, side > 0.0f ? 1 : 0);
        add_surface(
            mesh, {36, 34}, false, [=](vec2 uv) { return curtain_point(uv, side, phase); }, material);
        // The tie: a band round the gathered cloth.
        add_surface(
            mesh, {24, 2}, true,
            [=](vec2 uv) {
                const float angle = 2.0f * pi * uv.x;
                return vec3(side * 1.085f + 0.18f * std::cos(angle), 1.19f + 0.09f * uv.y + 0.02f * std::cos(angle),
                            0.13f * std::sin(angle));
            },
            saffron);
    }
    const std::array<TubeRing, 2> rod = {TubeRing{{-1.3f, 3.2f, 0.0f}, 0.025f}, TubeRing{{1.3f, 3.2f, 0.0f}, 0.025f}};
    add_tube(mesh, rod, 8, bronze);
    return mesh;
}

Mesh swag_mesh(std::uint32_t material) {
    Mesh mesh;
    add_surface(
        mesh, {36, 22}, false,
        [](vec2 uv) {
            const float along = 2.0f * uv.x - 1.0f, hang = 1.0f - along * along;
            const float fold = std::sin(2.0f * pi * 3.5f * uv.y);
            const float sag = 0.22f + 0.85f * std::pow(uv.y, 1.15f);
            return vec3(1.24f * along, -0.16f * uv.y - sag * hang + 0.02f * fold * hang,
                        0.04f + hang * (0.20f * std::sin(0.5f * pi * uv.y) * (1.15f - uv.y) + 0.05f * fold));
        },
        material);
    for (const float side : {-1.0f, 1.0f}) {  // the two tails
        add_surface(
            mesh, {14, 10}, false,
            [side](vec2 uv) {
                const float width = 0.10f + 0.30f * uv.y;
                const float length = 0.75f + 0.35f * (side > 0.0f ? uv.x : 1.0f - uv.x);
                return vec3(side * 1.27f + width * (uv.x - 0.5f), 0.02f - length * uv.y,
                            0.07f + 0.05f * (0.4f + uv.y) * std::sin(2.0f * pi * 2.5f * uv.x + 0.5f));
            },
            material);
    }
    return mesh;
}

Mesh banner_mesh(std::uint32_t material, std::uint32_t seed) {
    // Where the cloth goes, seen from the side: up behind the rail, over it, out past the cornice, straight down.
    constexpr std::array<vec2, 6> path = {vec2(-0.19f, -0.45f), vec2(-0.18f, 0.02f), vec2(0.18f, 0.02f),
                                          vec2(0.34f, -0.55f),  vec2(0.54f, -1.05f), vec2(0.55f, -2.55f)};
    Mesh mesh;
    const float phase = 6.0f * random_unit(1, seed, 0);
    const auto point = [=](vec2 uv) {
        const float at = uv.y * 5.0f;
        const auto i = static_cast<std::size_t>(std::min(at, 4.0f));
        const vec2 on_path = glm::mix(path[i], path[i + 1], at - static_cast<float>(i));
        const float along = 2.0f * uv.x - 1.0f, free = eased(at - 3.5f);
        const float fold = 0.055f * free * std::sin(2.0f * pi * 2.2f * uv.x + phase + 0.6f * uv.y);
        const float tip = i == 4 ? 0.42f * (1.0f - std::abs(along)) * (at - 4.0f) : 0.0f;
        return vec3((0.72f - 0.03f * free) * along, on_path.y - tip, on_path.x + fold + 0.02f * free);
    };
    add_surface(mesh, {22, 40}, false, point, material);
    // A border down both sides, a little in front.
    for (const float side : {-1.0f, 1.0f}) {
        add_surface(
            mesh, {2, 24}, false,
            [=](vec2 uv) {
                const vec2 on_banner(0.5f + side * (0.36f + 0.06f * uv.x * side), 0.45f + 0.54f * uv.y);
                return point(on_banner) + vec3(0.0f, 0.0f, 0.012f);
            },
            saffron);
    }
    return mesh;
}

Mesh vase_mesh(std::uint32_t material) {
    Mesh mesh;
    constexpr std::array<vec2, 20> profile = {
        vec2(0.19f, 0.0f),   vec2(0.21f, 0.03f),  vec2(0.19f, 0.06f),  vec2(0.16f, 0.10f),  vec2(0.20f, 0.16f),
        vec2(0.27f, 0.24f),  vec2(0.33f, 0.34f),  vec2(0.365f, 0.45f), vec2(0.36f, 0.56f),  vec2(0.32f, 0.66f),
        vec2(0.27f, 0.73f),  vec2(0.245f, 0.78f), vec2(0.25f, 0.82f),  vec2(0.30f, 0.86f),  vec2(0.33f, 0.885f),
        vec2(0.33f, 0.905f), vec2(0.30f, 0.905f), vec2(0.255f, 0.86f), vec2(0.225f, 0.82f), vec2(0.225f, 0.79f)};
    add_revolution(mesh, profile, 22, material);
    constexpr std::array<vec2, 2> earth = {vec2(0.235f, 0.80f), vec2(0.0f, 0.82f)};
    add_revolution(mesh, earth, 20, soil);
    for (const float side : {-1.0f, 1.0f}) {  // two handles
        std::vector<TubeRing> rings;
        for (int i = 0; i <= 12; ++i) {
            const float angle = pi * (-0.42f + 0.86f * static_cast<float>(i) / 12.0f);
            rings.push_back(
                {{side * (0.27f + 0.17f * std::cos(angle)), 0.68f + 0.15f * std::sin(angle), 0.0f}, 0.028f});
        }
        add_tube(mesh, rings, 7, material);
    }
    return mesh;
}

Mesh bush_mesh(int leaves, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    constexpr int stems = 16;
    for (int k = 0; k < stems; ++k) {
        const float azimuth = 2.0f * pi * (static_cast<float>(k) + draws.unit()) / stems;
        const float lean = draws.between(0.1f, 0.75f), length = draws.between(0.65f, 1.0f);
        const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth));
        const auto along = [&](float t) {
            return 0.10f * outward + length * (t * vec3(0.0f, 1.0f - 0.3f * lean * t, 0.0f) + lean * t * t * outward);
        };
        std::vector<TubeRing> rings;
        for (int i = 0; i <= 5; ++i) {
            const float t = static_cast<float>(i) / 5.0f;
            rings.push_back({along(t), 0.014f * (1.05f - t)});
        }
        add_tube(mesh, rings, 5, twig);
        for (int i = k; i < leaves; i += stems) {
            const float t = std::sqrt(draws.between(0.05f, 1.0f));
            const vec3 off = 0.20f * std::cbrt(draws.unit()) * sphere_direction(draws.unit(), draws.unit());
            const vec3 base = along(t) + off;
            const vec3 direction =
                near_direction(glm::normalize(off + 0.10f * outward + vec3(0.0f, 0.03f, 0.0f)), 0.5f, draws);
            const float length_m = draws.between(0.10f, 0.17f);
            const auto tone = static_cast<std::uint32_t>(leaf_dark + std::min(draws.below(4), 2u));
            add_leaf(mesh, base, direction, across(direction, draws.between(-0.6f, 0.6f)), length_m, 0.55f * length_m,
                     tone);
        }
    }
    return mesh;
}

Mesh agave_mesh(int blades, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    for (int k = 0; k < blades; ++k) {
        // Golden-angle spiral: inner blades stand, outer ones arch over.
        const float rank = static_cast<float>(k) / static_cast<float>(blades);
        const float azimuth = 2.39996f * static_cast<float>(k) + draws.between(-0.15f, 0.15f);
        const float length = draws.between(0.75f, 1.0f) * (1.0f - 0.25f * rank);
        const float rise_deg = 82.0f - 45.0f * rank, bend_deg = draws.between(55.0f, 85.0f) * (0.35f + 0.65f * rank);
        const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth)), side(-outward.z, 0.0f, outward.x);
        constexpr int steps = 9;
        std::vector<vec3> spine = {0.03f * outward};
        for (int i = 0; i < steps; ++i) {
            const float t = (static_cast<float>(i) + 0.5f) / steps;
            const float angle = glm::radians(rise_deg - bend_deg * t * t * 1.6f);
            spine.push_back(spine.back() +
                            length / steps * (std::cos(angle) * outward + vec3(0.0f, std::sin(angle), 0.0f)));
        }
        add_surface(
            mesh, {2, steps}, false,
            [&](vec2 uv) {
                const auto i = static_cast<std::size_t>(std::lround(uv.y * steps));
                const float width = 0.055f * std::pow(1.0f - uv.y, 0.6f) * (0.75f + 0.8f * uv.y) + 0.001f;
                const float fold = std::abs(uv.x - 0.5f);
                return spine[i] + 2.0f * width * (uv.x - 0.5f) * side + vec3(0.0f, 0.8f * width * fold, 0.0f);
            },
            blade_green);
    }
    return mesh;
}

Mesh fountain_mesh() {
    Mesh mesh;
    // Octagonal basin.
    constexpr std::array<vec2, 9> basin = {vec2(1.62f, 0.0f),  vec2(1.62f, 0.10f), vec2(1.50f, 0.14f),
                                           vec2(1.46f, 0.44f), vec2(1.54f, 0.50f), vec2(1.54f, 0.57f),
                                           vec2(1.32f, 0.57f), vec2(1.30f, 0.50f), vec2(1.28f, 0.10f)};
    add_revolution(mesh, basin, 8, limestone_light);
    constexpr std::array<vec2, 2> pool = {vec2(1.30f, 0.42f), vec2(0.0f, 0.42f)};
    add_revolution(mesh, pool, 8, water);
    constexpr std::array<vec2, 22> bowl = {
        vec2(0.34f, 0.30f), vec2(0.34f, 0.50f), vec2(0.26f, 0.56f), vec2(0.17f, 0.68f), vec2(0.14f, 0.85f),
        vec2(0.16f, 1.00f), vec2(0.22f, 1.06f), vec2(0.16f, 1.10f), vec2(0.24f, 1.16f), vec2(0.45f, 1.24f),
        vec2(0.62f, 1.34f), vec2(0.72f, 1.46f), vec2(0.74f, 1.50f), vec2(0.70f, 1.50f), vec2(0.58f, 1.38f),
        vec2(0.40f, 1.32f), vec2(0.12f, 1.32f), vec2(0.09f, 1.55f), vec2(0.14f, 1.64f), vec2(0.15f, 1.72f),
        vec2(0.10f, 1.84f), vec2(0.0f, 1.92f)};
    add_revolution(mesh, bowl, 40, marble);
    constexpr std::array<vec2, 2> upper_pool = {vec2(0.68f, 1.47f), vec2(0.09f, 1.47f)};
    add_revolution(mesh, upper_pool, 40, water);
    return mesh;
}

Mesh lantern_mesh() {
    Mesh mesh;
    const std::array<TubeRing, 2> chain = {TubeRing{{0.0f, 0.0f, 0.0f}, 0.012f},
                                           TubeRing{{0.0f, -0.75f, 0.0f}, 0.012f}};
    add_tube(mesh, chain, 5, bronze);
    constexpr std::array<vec2, 4> cap = {vec2(0.15f, -0.90f), vec2(0.15f, -0.88f), vec2(0.05f, -0.78f),
                                         vec2(0.0f, -0.74f)};
    add_revolution(mesh, cap, 6, bronze);
    constexpr std::array<vec2, 3> glass = {vec2(0.0f, -1.16f), vec2(0.085f, -1.14f), vec2(0.125f, -0.89f)};
    add_revolution(mesh, glass, 6, lantern_glass);
    return mesh;
}

Mesh bench_mesh() {
    Mesh mesh;
    add_box(mesh, {{-0.80f, 0.42f, -0.22f}, {0.80f, 0.49f, 0.22f}}, wood);
    for (const float side : {-1.0f, 1.0f}) {
        add_box(mesh, {{side * 0.6f - 0.09f, 0.0f, -0.18f}, {side * 0.6f + 0.09f, 0.42f, 0.18f}}, limestone_light);
        add_box(mesh, {{side * 0.6f - 0.12f, 0.0f, -0.20f}, {side * 0.6f + 0.12f, 0.08f, 0.20f}}, limestone_dark);
    }
    return mesh;
}

}  // namespace sightlines::atrium
