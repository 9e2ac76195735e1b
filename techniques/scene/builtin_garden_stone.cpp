#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_garden.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::garden {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// One of three tones, in patches of about `patch_m` with a ragged edge.
std::uint32_t toned(std::uint32_t first, vec2 place, float patch_m, std::uint32_t seed) {
    const float tone = 0.8f * smooth_noise(place / patch_m, seed) + 0.2f * smooth_noise(place * 1.9f, seed + 1);
    return first + (tone < 0.42f ? 0u : tone < 0.60f ? 1u : 2u);
}

}  // namespace

std::vector<Material> materials() {
    std::vector<Material> all = {
        diffuse("gravel", {0.36f, 0.30f, 0.225f}),
        diffuse("light gravel", {0.38f, 0.32f, 0.24f}),
        diffuse("dark gravel", {0.34f, 0.285f, 0.21f}),
        diffuse("lawn", {0.13f, 0.24f, 0.045f}),
        diffuse("dark lawn", {0.12f, 0.225f, 0.042f}),
        diffuse("light lawn", {0.14f, 0.25f, 0.047f}),
        diffuse("soil", {0.05f, 0.034f, 0.022f}),
        diffuse("kerb", {0.46f, 0.42f, 0.36f}),
        diffuse("limestone", {0.56f, 0.49f, 0.38f}),
        diffuse("dark limestone", {0.48f, 0.42f, 0.33f}),
        diffuse("stucco", {0.55f, 0.38f, 0.21f}),
        diffuse("stucco trim", {0.72f, 0.68f, 0.58f}),
        diffuse("window", {0.06f, 0.08f, 0.10f}, 0.2f),
        diffuse("slate", {0.17f, 0.18f, 0.21f}),
        diffuse("timber", {0.24f, 0.15f, 0.085f}),
        diffuse("water", {0.07f, 0.20f, 0.24f}, 0.1f),
        diffuse("spray", {0.80f, 0.86f, 0.90f}),
        diffuse("terracotta", {0.50f, 0.22f, 0.12f}),
        diffuse("hedge core", {0.025f, 0.06f, 0.018f}),
        diffuse("box leaf, dark", {0.05f, 0.14f, 0.03f}),
        diffuse("box leaf", {0.075f, 0.19f, 0.035f}),
        diffuse("box leaf, light", {0.12f, 0.26f, 0.05f}),
        diffuse("yew leaf, dark", {0.035f, 0.11f, 0.045f}),
        diffuse("yew leaf", {0.05f, 0.145f, 0.05f}),
        diffuse("yew leaf, light", {0.075f, 0.19f, 0.06f}),
        diffuse("vine leaf, dark", {0.08f, 0.20f, 0.035f}),
        diffuse("vine leaf", {0.14f, 0.29f, 0.05f}),
        diffuse("vine leaf, light", {0.23f, 0.37f, 0.07f}),
        diffuse("blade, dark", {0.11f, 0.22f, 0.035f}),
        diffuse("blade", {0.15f, 0.28f, 0.045f}),
        diffuse("blade, light", {0.21f, 0.34f, 0.06f}),
        diffuse("stem", {0.10f, 0.21f, 0.05f}),
        diffuse("deep red petal", {0.42f, 0.02f, 0.03f}),
        diffuse("red petal", {0.68f, 0.05f, 0.05f}),
        diffuse("pink petal", {0.78f, 0.24f, 0.32f}),
        diffuse("gold petal", {0.80f, 0.42f, 0.03f}),
        diffuse("yellow petal", {0.86f, 0.66f, 0.05f}),
        diffuse("cream petal", {0.86f, 0.78f, 0.45f}),
        diffuse("violet petal", {0.19f, 0.05f, 0.36f}),
        diffuse("blue petal", {0.16f, 0.15f, 0.60f}),
        diffuse("lilac petal", {0.50f, 0.36f, 0.70f}),
        diffuse("white petal", {0.86f, 0.86f, 0.83f}),
        diffuse("ivory petal", {0.84f, 0.80f, 0.68f}),
        diffuse("blush petal", {0.85f, 0.66f, 0.64f}),
    };
    // Leaves, blades and petals are sheets, as is spray; all else bounds something solid.
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i].double_sided = i > hedge_core || i == spray;
    return all;
}

bool on_lawn(vec2 place) {
    const vec2 away = glm::abs(place);
    // Strips between the beds and the hedges round about, and along the colonnade.
    const bool side = away.x > 19.6f && away.x < 22.4f && away.y > 2.6f && place.y > -8.8f && place.y < 15.2f;
    const bool south = place.y > 12.9f && place.y < 15.2f && away.x > 2.6f && away.x < 22.4f;
    return side || south;
}

Mesh ground_mesh() {
    Mesh mesh;
    constexpr int across = 144, along = 102;
    add_surface(
        mesh, {along, across}, false,
        [](vec2 uv) {
            const vec2 place((2.0f * uv.y - 1.0f) * half_x, (2.0f * uv.x - 1.0f) * half_z);
            return vec3(place.x, 0.025f * (smooth_noise(place * 0.6f, 3) - 0.5f), place.y);
        },
        gravel);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const uvec3 corners = mesh.triangles[i];
        const vec3 middle = (mesh.positions[corners.x] + mesh.positions[corners.y] + mesh.positions[corners.z]) / 3.0f;
        const vec2 place(middle.x, middle.z);
        mesh.materials[i] = on_lawn(place) ? toned(lawn, place, 1.7f, 7) : toned(gravel, place, 2.6f, 5);
    }
    // The plaza's paving: rings of stones about the fountain.
    for (int ring = 0; ring < 6; ++ring) {
        const float inner = 2.75f + 0.41f * static_cast<float>(ring), outer = inner + 0.39f;
        const int stones = 30 + 5 * ring;
        for (int k = 0; k < stones; ++k) {
            const float turn = (static_cast<float>(k) + 0.5f * static_cast<float>(ring % 2)) * 2.0f * pi;
            const float from = turn / static_cast<float>(stones);
            const float to = from + 2.0f * pi / static_cast<float>(stones) - 0.012f / inner;
            const auto at = [](float radius, float angle) {
                return vec2(radius * std::cos(angle), -radius * std::sin(angle));
            };
            const std::array<vec2, 4> outline = {at(inner, from), at(outer, from), at(outer, to), at(inner, to)};
            const std::uint32_t stone =
                random_unit(11, static_cast<std::uint32_t>(ring), static_cast<std::uint32_t>(k)) < 0.3f ? limestone_dark
                                                                                                        : kerb;
            add_prism(mesh, outline, -0.05f, 0.045f, stone, stone);
        }
    }
    return mesh;
}

Mesh column_mesh() {
    Mesh mesh;
    add_box(mesh, {{-0.27f, 0.0f, -0.27f}, {0.27f, 0.14f, 0.27f}}, limestone);
    constexpr std::array<vec2, 22> profile = {
        vec2(0.25f, 0.14f),  vec2(0.26f, 0.18f),  vec2(0.25f, 0.22f),  vec2(0.21f, 0.24f), vec2(0.22f, 0.28f),
        vec2(0.20f, 0.30f),  vec2(0.185f, 0.34f), vec2(0.19f, 0.90f),  vec2(0.187f, 1.4f), vec2(0.18f, 1.9f),
        vec2(0.17f, 2.4f),   vec2(0.16f, 2.80f),  vec2(0.157f, 2.90f), vec2(0.18f, 2.92f), vec2(0.18f, 2.95f),
        vec2(0.157f, 2.97f), vec2(0.157f, 3.02f), vec2(0.19f, 3.08f),  vec2(0.24f, 3.14f), vec2(0.25f, 3.16f),
        vec2(0.25f, 3.18f),  vec2(0.0f, 3.18f)};
    add_revolution(mesh, profile, 26, limestone);
    add_box(mesh, {{-0.27f, 3.18f, -0.27f}, {0.27f, column_height, 0.27f}}, limestone);
    return mesh;
}

Mesh pergola_mesh() {
    Mesh mesh;
    const float end = 0.5f * walk * static_cast<float>(columns_each_row - 1) + 0.5f;
    for (const float z : {front_row_z, back_row_z})
        add_box(mesh, {{-end, column_height, z - 0.13f}, {end, column_height + 0.26f, z + 0.13f}}, timber);
    const int rafters = 4 * (columns_each_row - 1) + 1;
    for (int i = 0; i < rafters; ++i) {
        const float x = -end + 0.5f + 0.25f * walk * static_cast<float>(i);
        const std::array<vec2, 6> shape = {vec2(-0.55f, 0.07f), vec2(-0.40f, 0.0f), vec2(3.20f, 0.0f),
                                           vec2(3.35f, 0.07f),  vec2(3.35f, 0.18f), vec2(-0.55f, 0.18f)};
        std::vector<vec3> left, right;
        for (const vec2 p : shape) {
            left.push_back({x - 0.05f, column_height + 0.262f + p.y, back_row_z + p.x});
            right.push_back({x + 0.05f, column_height + 0.262f + p.y, back_row_z + p.x});
        }
        for (std::size_t k = 0; k < shape.size(); ++k) {
            const std::size_t next = (k + 1) % shape.size();
            add_polygon(mesh, std::array<vec3, 4>{left[next], left[k], right[k], right[next]}, timber);
        }
        add_polygon(mesh, left, timber);
        std::reverse(right.begin(), right.end());
        add_polygon(mesh, right, timber);
    }
    for (int k = 0; k < 5; ++k) {  // laths along the walk
        const float z = back_row_z - 0.2f + 0.8f * static_cast<float>(k);
        add_box(mesh, {{-end, column_height + 0.444f, z - 0.03f}, {end, column_height + 0.49f, z + 0.03f}}, timber);
    }
    return mesh;
}

Mesh palace_bay_mesh() {
    Mesh mesh;
    constexpr float half = 0.5f * walk, top = 8.4f;
    // The wall round two windows, one above the other.
    constexpr float jamb = 0.62f;
    const std::array<vec2, 2> windows = {vec2(0.0f, 2.9f), vec2(4.6f, 6.9f)};
    const auto wall = [&](float x0, float y0, float x1, float y1) {
        add_quad(mesh, {x0, y0, 0.0f}, {x1 - x0, 0.0f, 0.0f}, {0.0f, y1 - y0, 0.0f}, stucco);
    };
    wall(-half, 0.0f, -jamb, top);
    wall(jamb, 0.0f, half, top);
    wall(-jamb, windows[0].y, jamb, windows[1].x);
    wall(-jamb, windows[1].y, jamb, top);
    for (const vec2 window : windows) {
        const float low = window.x, high = window.y, depth = -0.28f;
        add_quad(mesh, {-jamb, low, depth}, {2.0f * jamb, 0.0f, 0.0f}, {0.0f, high - low, 0.0f}, window_dark);
        add_quad(mesh, {-jamb, low, depth}, {0.0f, high - low, 0.0f}, {0.0f, 0.0f, -depth}, stucco_trim);
        add_quad(mesh, {jamb, low, depth}, {0.0f, 0.0f, -depth}, {0.0f, high - low, 0.0f}, stucco_trim);
        add_quad(mesh, {-jamb, low, depth}, {0.0f, 0.0f, -depth}, {2.0f * jamb, 0.0f, 0.0f}, stucco_trim);
        add_quad(mesh, {-jamb, high, depth}, {2.0f * jamb, 0.0f, 0.0f}, {0.0f, 0.0f, -depth}, stucco_trim);
        for (int k = 1; k < 4; ++k) {  // glazing bars
            const float y = glm::mix(low, high, static_cast<float>(k) / 4.0f);
            add_box(mesh, {{-jamb, y - 0.025f, depth}, {jamb, y + 0.025f, depth + 0.05f}}, stucco_trim);
        }
        add_box(mesh, {{-0.03f, low, depth}, {0.03f, high, depth + 0.06f}}, stucco_trim);
        // Frame, sill and a small pediment.
        for (const float side : {-1.0f, 1.0f})
            add_box(mesh, {{side * 0.70f - 0.09f, low, 0.0f}, {side * 0.70f + 0.09f, high + 0.16f, 0.06f}},
                    stucco_trim);
        add_box(mesh, {{-0.86f, high + 0.16f, 0.0f}, {0.86f, high + 0.32f, 0.14f}}, stucco_trim);
        if (low > 1.0f) add_box(mesh, {{-0.86f, low - 0.14f, 0.0f}, {0.86f, low, 0.16f}}, stucco_trim);
    }
    add_box(mesh, {{-half, 3.75f, 0.0f}, {half, 3.98f, 0.12f}}, stucco_trim);
    const std::array<vec2, 7> cornice = {vec2(0.0f, 0.0f),   vec2(0.10f, 0.0f),  vec2(0.16f, 0.14f), vec2(0.36f, 0.20f),
                                         vec2(0.40f, 0.36f), vec2(0.40f, 0.44f), vec2(0.0f, 0.44f)};
    const std::array<vec3, 2> along = {vec3(half, top - 0.44f, 0.0f), vec3(-half, top - 0.44f, 0.0f)};
    add_sweep(mesh, along, {0.0f, 1.0f, 0.0f}, cornice, false, stucco_trim);
    // A pilaster on the bay's left border, and the roof's slope.
    add_box(mesh, {{-half - 0.22f, 0.0f, 0.0f}, {-half + 0.22f, top - 0.44f, 0.15f}}, stucco_trim);
    add_quad(mesh, {-half, top, 0.40f}, {walk, 0.0f, 0.0f}, {0.0f, 2.1f, -1.4f}, {2, 5},
             [](ivec2) { return static_cast<std::uint32_t>(roof_slate); });
    return mesh;
}

Mesh fountain_mesh() {
    Mesh mesh;
    constexpr std::array<vec2, 11> basin = {vec2(2.70f, 0.0f),  vec2(2.70f, 0.12f), vec2(2.58f, 0.16f),
                                            vec2(2.54f, 0.46f), vec2(2.64f, 0.52f), vec2(2.66f, 0.58f),
                                            vec2(2.62f, 0.62f), vec2(2.34f, 0.62f), vec2(2.30f, 0.56f),
                                            vec2(2.28f, 0.20f), vec2(2.28f, 0.10f)};
    add_revolution(mesh, basin, 64, limestone);
    constexpr std::array<vec2, 2> pool = {vec2(2.30f, 0.46f), vec2(0.0f, 0.46f)};
    add_revolution(mesh, pool, 64, water);
    constexpr std::array<vec2, 31> bowls = {
        vec2(0.62f, 0.40f), vec2(0.62f, 0.62f), vec2(0.50f, 0.66f), vec2(0.36f, 0.82f), vec2(0.28f, 1.05f),
        vec2(0.26f, 1.28f), vec2(0.36f, 1.34f), vec2(0.30f, 1.40f), vec2(0.46f, 1.48f), vec2(0.80f, 1.56f),
        vec2(1.10f, 1.68f), vec2(1.24f, 1.80f), vec2(1.26f, 1.85f), vec2(1.20f, 1.85f), vec2(1.00f, 1.72f),
        vec2(0.70f, 1.66f), vec2(0.24f, 1.66f), vec2(0.20f, 1.80f), vec2(0.17f, 2.10f), vec2(0.18f, 2.36f),
        vec2(0.24f, 2.42f), vec2(0.20f, 2.48f), vec2(0.36f, 2.54f), vec2(0.58f, 2.66f), vec2(0.64f, 2.76f),
        vec2(0.60f, 2.76f), vec2(0.48f, 2.66f), vec2(0.12f, 2.64f), vec2(0.14f, 2.80f), vec2(0.09f, 2.98f),
        vec2(0.0f, 3.06f)};
    add_revolution(mesh, bowls, 48, limestone);
    constexpr std::array<vec2, 2> upper = {vec2(1.17f, 1.81f), vec2(0.20f, 1.81f)};
    add_revolution(mesh, upper, 48, water);
    constexpr std::array<vec2, 2> top = {vec2(0.57f, 2.73f), vec2(0.13f, 2.73f)};
    add_revolution(mesh, top, 32, water);
    // Water falls from both rims in thin threads.
    for (int k = 0; k < 56; ++k) {
        const bool high = k < 20;
        const float angle = 2.0f * pi * static_cast<float>(k) / (high ? 20.0f : 36.0f) + 0.3f;
        const float rim = high ? 0.62f : 1.25f, from = high ? 2.77f : 1.86f, to = high ? 1.82f : 0.47f;
        std::vector<TubeRing> thread;
        for (int i = 0; i <= 8; ++i) {
            const float t = static_cast<float>(i) / 8.0f;
            const float radius = rim + 0.30f * t;
            thread.push_back({{radius * std::cos(angle), from - (from - to) * t * t, radius * std::sin(angle)},
                              0.016f - 0.008f * t});
        }
        add_tube(mesh, thread, 4, spray);
    }
    return mesh;
}

Mesh urn_mesh() {
    Mesh mesh;
    add_box(mesh, {{-0.36f, 0.0f, -0.36f}, {0.36f, 0.16f, 0.36f}}, limestone_dark);
    add_box(mesh, {{-0.28f, 0.16f, -0.28f}, {0.28f, 0.86f, 0.28f}}, limestone);
    add_box(mesh, {{-0.34f, 0.86f, -0.34f}, {0.34f, 0.98f, 0.34f}}, limestone_dark);
    constexpr std::array<vec2, 16> profile = {
        vec2(0.20f, 0.98f), vec2(0.21f, 1.02f), vec2(0.14f, 1.06f), vec2(0.09f, 1.14f),
        vec2(0.12f, 1.20f), vec2(0.22f, 1.26f), vec2(0.32f, 1.36f), vec2(0.37f, 1.48f),
        vec2(0.38f, 1.58f), vec2(0.35f, 1.66f), vec2(0.37f, 1.72f), vec2(0.44f, 1.77f),
        vec2(0.44f, 1.81f), vec2(0.38f, 1.81f), vec2(0.33f, 1.74f), vec2(0.33f, 1.68f)};
    add_revolution(mesh, profile, 28, terracotta);
    constexpr std::array<vec2, 2> earth = {vec2(0.34f, 1.72f), vec2(0.0f, 1.74f)};
    add_revolution(mesh, earth, 20, soil);
    return mesh;
}

Mesh bench_mesh() {
    Mesh mesh;
    add_box(mesh, {{-0.95f, 0.42f, -0.25f}, {0.95f, 0.50f, 0.25f}}, limestone);
    for (const float side : {-1.0f, 1.0f}) {
        add_box(mesh, {{side * 0.68f - 0.10f, 0.0f, -0.20f}, {side * 0.68f + 0.10f, 0.42f, 0.20f}}, limestone_dark);
        add_box(mesh, {{side * 0.68f - 0.14f, 0.0f, -0.23f}, {side * 0.68f + 0.14f, 0.07f, 0.23f}}, limestone);
    }
    return mesh;
}

}  // namespace sightlines::garden
