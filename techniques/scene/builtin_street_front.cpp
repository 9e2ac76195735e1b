// The fronts of the houses in the built-in street.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_shapes.h"
#include "techniques/scene/builtin_street.h"

namespace sightlines::street {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// A wrought-iron railing at z = `out_m` from `from` to `to` (x): rails, bars, and between every second pair a scroll.
void add_railing(Mesh& mesh, float from, float to, float y, float out_m) {
    constexpr float height = 0.92f, spacing = 0.12f;
    for (const float rail : {0.06f, 0.80f, height})
        add_beam(mesh, {from, y + rail, out_m}, {to, y + rail, out_m}, 0.035f, rail < height ? 0.02f : 0.04f, iron);
    const int bars = std::max(static_cast<int>(std::lround((to - from) / spacing)), 2);
    const float step = (to - from) / static_cast<float>(bars);
    for (int i = 0; i <= bars; ++i) {
        const float x = from + step * static_cast<float>(i);
        add_rod(mesh, {x, y + 0.06f, out_m}, {x, y + height, out_m}, 0.009f, 5, iron);
        if (i == bars || i % 2 == 1) continue;
        std::vector<TubeRing> scroll;
        for (int k = 0; k <= 13; ++k) {
            const float t = static_cast<float>(k) / 13.0f, angle = 3.0f * pi * t;
            const float radius = 0.75f * step * (0.4f + 0.6f * t);
            scroll.push_back(
                {{x + step + radius * std::cos(angle), y + 0.36f + 0.12f * t + radius * std::sin(angle), out_m},
                 0.008f});
        }
        add_tube(mesh, scroll, 4, iron);
    }
    for (const float x : {from, to})
        add_beam(mesh, {x, y + height - 0.02f, 0.0f}, {x, y + height - 0.02f, out_m}, 0.035f, 0.04f, iron);
}

/// A leaf of a shutter, folded back flat against the wall.
void add_shutter(Mesh& mesh, vec2 low, vec2 high, std::uint32_t material) {
    constexpr float rim = 0.055f, back = 0.03f, front = 0.065f;
    add_box(mesh, {{low.x, low.y, back}, {low.x + rim, high.y, front}}, material);
    add_box(mesh, {{high.x - rim, low.y, back}, {high.x, high.y, front}}, material);
    const float middle = 0.5f * (low.y + high.y);
    for (const float y : {low.y, middle - 0.5f * rim, high.y - rim})
        add_box(mesh, {{low.x + rim, y, back}, {high.x - rim, y + rim, front}}, material);
    constexpr float pitch = 0.062f;
    const vec3 tilted = glm::normalize(vec3(0.0f, 1.0f, 1.1f));
    for (float y = low.y + rim + 0.5f * pitch; y < high.y - rim; y += pitch) {
        if (std::abs(y - middle) < 0.5f * (rim + pitch)) continue;
        const float z = 0.5f * (back + front);
        add_beam(mesh, {low.x + rim, y, z}, {high.x - rim, y, z}, 0.008f, 0.055f, material, tilted);
    }
}

/// Leaves and flowers over a box on the sill.
void add_flower_box(Mesh& mesh, float from, float to, float y, Draws& draws) {
    const Box3 box{{from, y, 0.05f}, {to, y + 0.2f, 0.27f}};
    add_box(mesh, box, pot);
    const Box3 leaves{{from, y + 0.16f, 0.06f}, {to, y + 0.34f, 0.32f}};
    const auto spot = [&](Draws& d) { return spot_on_box(leaves, d); };
    add_leaf_cover(mesh, {170, 0.09f, 0.6f, 0.06f, 0.8f, leaf_dark, 3}, draws, spot);
    add_leaf_cover(mesh, {70, 0.055f, 0.95f, 0.11f, 0.9f, petal_red + draws.below(3), 1}, draws, spot);
}

/// Two casements with bars, behind the reveal.
void add_casements(Mesh& mesh, vec2 low, vec2 high, float z) {
    constexpr float bar = 0.05f;
    const float middle = 0.5f * (low.x + high.x);
    const auto add_bar = [&](float x0, float y0, float x1, float y1) {
        add_box(mesh, {{x0, y0, z}, {x1, y1, z + 0.05f}}, window_frame);
    };
    add_bar(low.x, low.y, low.x + bar, high.y);
    add_bar(high.x - bar, low.y, high.x, high.y);
    add_bar(middle - bar, low.y, middle + bar, high.y);
    add_bar(low.x, low.y, high.x, low.y + 2.0f * bar);
    add_bar(low.x, high.y - bar, high.x, high.y);
    for (const float share : {0.36f, 0.68f}) {
        const float y = low.y + share * (high.y - low.y);
        add_bar(low.x, y, high.x, y + 0.6f * bar);
    }
    // Curtains drawn aside.
    for (const float side : {0.0f, 1.0f}) {
        const float edge = side == 0.0f ? low.x + bar : high.x - bar, inwards = side == 0.0f ? 1.0f : -1.0f;
        add_surface(
            mesh, {14, 1}, false,
            [&](vec2 uv) {
                const float across = 0.32f * (high.x - low.x) * uv.x;
                const float fold = 0.02f * std::sin(40.0f * across);
                return vec3(edge + inwards * across, low.y + uv.y * (high.y - low.y), z - 0.05f + fold);
            },
            curtain);
    }
}

/// How the windows of one floor look.
struct FloorStyle {
    bool long_balcony = false, hood = false;
    float open_from_m = 0.45f;  ///< above the floor
};

void add_window(Mesh& mesh, vec2 low, vec2 high, const HouseShape& shape, const FloorStyle& style, Draws& draws) {
    Opening opening;
    opening.low = low;
    opening.high = high;
    const float middle = 0.5f * (low.x + high.x), half = 0.56f;
    const float sill = low.y + (style.long_balcony ? 0.08f : style.open_from_m), top = high.y - 0.55f;
    opening.open_low = {middle - half, sill};
    opening.open_high = {middle + half, top};
    opening.wall = shape.wall;
    opening.pane = draws.unit() < 0.12f ? glass_lit : glass;
    add_opening(mesh, opening);
    add_casements(mesh, opening.open_low, opening.open_high, -0.24f);
    // The surround: two jambs, a lintel with its keystone, a sill.
    constexpr float wide = 0.14f, out = 0.05f;
    for (const float x : {middle - half - wide, middle + half})
        add_box(mesh, {{x, sill, 0.0f}, {x + wide, top, out}}, trim);
    add_box(mesh, {{middle - half - wide, top, 0.0f}, {middle + half + wide, top + 0.18f, out + 0.02f}}, trim);
    add_box(mesh, {{middle - 0.1f, top - 0.03f, 0.0f}, {middle + 0.1f, top + 0.24f, out + 0.06f}}, trim);
    if (style.hood) {
        const std::array<vec3, 2> path = {vec3(middle - half - 0.3f, top + 0.24f, 0.0f),
                                          vec3(middle + half + 0.3f, top + 0.24f, 0.0f)};
        const std::array<vec2, 5> profile = {vec2(0.0f, 0.0f), vec2(0.08f, 0.0f), vec2(0.2f, 0.07f), vec2(0.2f, 0.12f),
                                             vec2(0.0f, 0.16f)};
        add_sweep(mesh, path, {0.0f, 1.0f, 0.0f}, profile, false, trim);
    }
    if (draws.unit() < 0.85f) {
        const float leaf = 0.52f;
        add_shutter(mesh, {middle - half - wide - leaf, sill}, {middle - half - wide, top}, shape.shutter);
        add_shutter(mesh, {middle + half + wide, sill}, {middle + half + wide + leaf, top}, shape.shutter);
    }
    if (style.long_balcony) return;
    add_box(mesh, {{middle - half - wide, sill - 0.1f, 0.0f}, {middle + half + wide, sill, 0.3f}}, trim);
    const bool flowers = draws.unit() < 0.5f;
    if (flowers) add_flower_box(mesh, middle - half, middle + half, sill, draws);
    add_railing(mesh, middle - half - 0.08f, middle + half + 0.08f, sill - 0.02f, flowers ? 0.33f : 0.2f);
}

/// A slab on consoles along the whole front, with its railing.
void add_long_balcony(Mesh& mesh, float width, float y) {
    constexpr float out = 0.85f;
    const std::array<vec3, 2> path = {vec3(0.1f, y, 0.0f), vec3(width - 0.1f, y, 0.0f)};
    const std::array<vec2, 6> profile = {vec2(0.0f, -0.16f), vec2(out - 0.14f, -0.16f), vec2(out - 0.05f, -0.09f),
                                         vec2(out, -0.07f),  vec2(out, 0.0f),           vec2(0.0f, 0.0f)};
    add_sweep(mesh, path, {0.0f, 1.0f, 0.0f}, profile, false, trim);
    add_railing(mesh, 0.16f, width - 0.16f, y, out - 0.08f);
    const int consoles = std::max(static_cast<int>(width / 1.3f), 2);
    for (int i = 0; i <= consoles; ++i) {
        const float x = 0.3f + (width - 0.6f) * static_cast<float>(i) / static_cast<float>(consoles);
        const std::array<vec3, 2> across = {vec3(x - 0.07f, y, 0.0f), vec3(x + 0.07f, y, 0.0f)};
        const std::array<vec2, 10> curl = {
            vec2(0.0f, -0.62f), vec2(0.08f, -0.62f), vec2(0.15f, -0.55f), vec2(0.18f, -0.4f),  vec2(0.26f, -0.31f),
            vec2(0.4f, -0.29f), vec2(0.54f, -0.32f), vec2(0.64f, -0.26f), vec2(0.65f, -0.16f), vec2(0.0f, -0.16f)};
        add_sweep(mesh, across, {0.0f, 1.0f, 0.0f}, curl, false, trim_dark);
    }
}

/// The cornice under the roof, on small brackets.
void add_cornice(Mesh& mesh, float width, float y) {
    const std::array<vec3, 2> path = {vec3(0.0f, y, 0.0f), vec3(width, y, 0.0f)};
    const std::array<vec2, 8> profile = {vec2(0.0f, -0.5f),  vec2(0.07f, -0.5f), vec2(0.07f, -0.32f),
                                         vec2(0.3f, -0.22f), vec2(0.42f, -0.1f), vec2(0.5f, -0.08f),
                                         vec2(0.5f, 0.0f),   vec2(0.0f, 0.0f)};
    add_sweep(mesh, path, {0.0f, 1.0f, 0.0f}, profile, false, trim);
    for (float x = 0.16f; x < width - 0.16f; x += 0.34f)
        add_box(mesh, {{x, y - 0.44f, 0.05f}, {x + 0.13f, y - 0.2f, 0.3f}}, trim_dark);
}

void add_band(Mesh& mesh, float width, float y) {
    const std::array<vec3, 2> path = {vec3(0.0f, y, 0.0f), vec3(width, y, 0.0f)};
    const std::array<vec2, 5> profile = {vec2(0.0f, -0.14f), vec2(0.09f, -0.1f), vec2(0.16f, 0.0f), vec2(0.16f, 0.06f),
                                         vec2(0.0f, 0.1f)};
    add_sweep(mesh, path, {0.0f, 1.0f, 0.0f}, profile, false, trim);
}

/// Ivy: leaves thickest low down and on one side.
void add_ivy(Mesh& mesh, float width, float height, Draws& draws) {
    const auto spot = [&](Draws& d) {
        for (;;) {
            const vec2 place(d.unit() * width, ground_floor_height + d.unit() * (height - ground_floor_height));
            const float thick = smooth_noise(0.45f * place, 31) + 0.5f * (1.0f - place.x / width) -
                                0.35f * (place.y - ground_floor_height) / height;
            if (thick > 0.62f) return SurfaceSpot{{place, 0.06f}, {0.0f, 0.0f, 1.0f}};
        }
    };
    add_leaf_cover(mesh, {26000, 0.13f, 0.9f, 0.14f, 0.6f, ivy_dark, 3}, draws, spot);
}

}  // namespace

void add_panel(Mesh& mesh, vec2 low, vec2 high, float z, std::uint32_t material) {
    add_quad(mesh, {low, z}, {high.x - low.x, 0.0f, 0.0f}, {0.0f, high.y - low.y, 0.0f}, material);
}

void add_opening(Mesh& mesh, const Opening& o) {
    if (o.open_low.y > o.low.y) add_panel(mesh, o.low, {o.high.x, o.open_low.y}, 0.0f, o.wall);
    add_panel(mesh, {o.low.x, o.open_high.y}, o.high, 0.0f, o.wall);
    add_panel(mesh, {o.low.x, o.open_low.y}, {o.open_low.x, o.open_high.y}, 0.0f, o.wall);
    add_panel(mesh, {o.open_high.x, o.open_low.y}, {o.high.x, o.open_high.y}, 0.0f, o.wall);
    add_panel(mesh, o.open_low, o.open_high, -o.depth_m, o.pane);
    const vec3 base(o.open_low, -o.depth_m);
    const vec3 x(o.open_high.x - o.open_low.x, 0.0f, 0.0f), y(0.0f, o.open_high.y - o.open_low.y, 0.0f);
    const vec3 z(0.0f, 0.0f, o.depth_m);
    add_quad(mesh, base, z, x, o.wall);
    add_quad(mesh, base + y, x, z, o.wall);
    add_quad(mesh, base, y, z, o.wall);
    add_quad(mesh, base + x, z, y, o.wall);
}

Mesh front_mesh(const HouseShape& shape, float width_m, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    add_shop(mesh, {0.0f, 0.0f}, {width_m, ground_floor_height}, shape, draws);
    add_band(mesh, width_m, ground_floor_height);
    const int columns = std::max(static_cast<int>(std::lround(width_m / 2.75f)), 1);
    const float cell = width_m / static_cast<float>(columns);
    const bool noble = draws.unit() < 0.6f;
    for (int floor = 0; floor < shape.upper_floors; ++floor) {
        const float y = ground_floor_height + floor_height * static_cast<float>(floor);
        FloorStyle style;
        style.long_balcony = noble && (floor == 1 || floor == shape.upper_floors - 1);
        style.hood = floor == 0 || style.long_balcony;
        for (int column = 0; column < columns; ++column) {
            const float x = cell * static_cast<float>(column);
            add_window(mesh, {x, y}, {x + cell, y + floor_height}, shape, style, draws);
        }
        if (style.long_balcony)
            add_long_balcony(mesh, width_m, y + 0.06f);
        else if (floor > 0)
            add_band(mesh, width_m, y);
    }
    const float top = ground_floor_height + floor_height * static_cast<float>(shape.upper_floors);
    add_cornice(mesh, width_m, top);
    if (shape.ivy) add_ivy(mesh, width_m, top, draws);
    // A rain pipe at the party wall.
    add_rod(mesh, {0.12f, 0.15f, 0.09f}, {0.12f, top - 0.4f, 0.09f}, 0.055f, 10, zinc);
    for (float y = 1.2f; y < top - 0.5f; y += 2.1f) add_box(mesh, {{0.04f, y, 0.0f}, {0.2f, y + 0.05f, 0.16f}}, zinc);
    return mesh;
}

}  // namespace sightlines::street
