// Ground floors, roofs and the materials of the built-in street.
#include <algorithm>
#include <array>
#include <cmath>

#include "techniques/scene/builtin_shapes.h"
#include "techniques/scene/builtin_street.h"

namespace sightlines::street {
namespace {

/// Striped cloth from the wall downwards and out, a scalloped edge, and the arms that hold it.
void add_awning(Mesh& mesh, float from, float to, float y, std::uint32_t canvas) {
    constexpr float out = 1.5f, drop = 0.75f, stripe = 0.22f, valance = 0.2f;
    const int stripes = std::max(static_cast<int>((to - from) / stripe), 2);
    const float step = (to - from) / static_cast<float>(stripes);
    for (int i = 0; i < stripes; ++i) {
        const float x = from + step * static_cast<float>(i);
        const std::uint32_t material = i % 2 == 0 ? canvas : canvas_cream;
        add_surface(
            mesh, {2, 8}, false,
            [&](vec2 uv) {
                const float sag = 0.09f * uv.y * (1.0f - uv.y);
                return vec3(x + uv.x * step, y - drop * (1.0f - uv.y) - sag, out * (1.0f - uv.y) + 0.02f);
            },
            material);
        add_surface(
            mesh, {6, 1}, false,
            [&](vec2 uv) {
                const float scallop = valance * (0.6f + 0.4f * std::sqrt(std::max(4.0f * uv.x * (1.0f - uv.x), 0.0f)));
                return vec3(x + uv.x * step, y - drop - scallop * (1.0f - uv.y), out + 0.02f);
            },
            material);
    }
    for (const float x : {from + 0.06f, to - 0.06f}) {
        add_rod(mesh, {x, y - 1.15f, 0.02f}, {x, y - drop - 0.03f, out}, 0.018f, 6, iron);
        add_rod(mesh, {x, y - 0.05f, 0.02f}, {x, y - drop - 0.03f, out}, 0.014f, 6, iron);
    }
    add_rod(mesh, {from, y - drop - 0.02f, out}, {to, y - drop - 0.02f, out}, 0.02f, 6, iron);
}

/// A pilaster with base, panel and capital.
void add_pilaster(Mesh& mesh, float x, float top, std::uint32_t material) {
    constexpr float half = 0.2f;
    add_box(mesh, {{x - half - 0.04f, 0.0f, 0.0f}, {x + half + 0.04f, 0.5f, 0.2f}}, trim_dark);
    add_box(mesh, {{x - half, 0.5f, 0.0f}, {x + half, top - 0.3f, 0.14f}}, material);
    add_box(mesh, {{x - half + 0.07f, 0.7f, 0.14f}, {x + half - 0.07f, top - 0.5f, 0.165f}}, material);
    for (int i = 0; i < 3; ++i) {
        const float grow = 0.035f * static_cast<float>(i + 1), y = top - 0.3f + 0.1f * static_cast<float>(i);
        add_box(mesh, {{x - half - grow, y, 0.0f}, {x + half + grow, y + 0.1f, 0.14f + grow}}, trim);
    }
}

/// Bars over a shop's pane, and goods behind it.
void add_display(Mesh& mesh, const Opening& opening, Draws& draws) {
    const vec2 size = opening.open_high - opening.open_low;
    const int columns = std::max(static_cast<int>(size.x / 0.7f), 1);
    for (int i = 0; i <= columns; ++i) {
        const float x = opening.open_low.x + size.x * static_cast<float>(i) / static_cast<float>(columns);
        add_box(mesh,
                {{x - 0.03f, opening.open_low.y, -opening.depth_m},
                 {x + 0.03f, opening.open_high.y, -opening.depth_m + 0.07f}},
                timber);
    }
    for (const float share : {0.0f, 0.72f, 1.0f}) {
        const float y = opening.open_low.y + share * size.y;
        add_box(mesh,
                {{opening.open_low.x, y - 0.03f, -opening.depth_m},
                 {opening.open_high.x, y + 0.03f, -opening.depth_m + 0.07f}},
                timber);
    }
    // Bottles and jars along the sill.
    const std::array<vec2, 7> jar = {vec2(0.0f, 0.0f),   vec2(0.055f, 0.0f), vec2(0.06f, 0.12f), vec2(0.05f, 0.17f),
                                     vec2(0.02f, 0.21f), vec2(0.02f, 0.28f), vec2(0.0f, 0.28f)};
    for (float x = opening.open_low.x + 0.12f; x < opening.open_high.x - 0.1f; x += draws.between(0.15f, 0.3f)) {
        Mesh thing;
        add_revolution(thing, jar, 12, draws.unit() < 0.5f ? bottle : brass);
        append(mesh, thing, placed({x, opening.open_low.y + 0.03f, -0.09f}, 0.0f, draws.between(0.7f, 1.0f)));
    }
}

void add_gate(Mesh& mesh, vec2 low, vec2 high, const HouseShape& shape) {
    const float middle = 0.5f * (low.x + high.x);
    Opening opening{low, high, {middle - 0.75f, low.y}, {middle + 0.75f, high.y - 0.8f}, 0.3f, shape.wall, timber};
    add_opening(mesh, opening);
    Mesh panel;
    add_tile(panel, {{0.0f, 0.0f, 0.0f}, {0.64f, 0.03f, 0.5f}}, 0.02f, timber);
    for (int row = 0; row < 5; ++row)
        for (const float side : {-0.7f, 0.06f}) {
            const float y = low.y + 0.15f + 0.6f * static_cast<float>(row);
            append(
                mesh, panel,
                framed({1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, {0.0f, -1.0f, 0.0f}, {middle + side, y + 0.5f, -0.3f}));
        }
    Mesh knob;
    add_ball(knob, {0.0f, 0.0f, 0.0f}, vec3(0.045f), 12, brass);
    append(mesh, knob, placed({middle - 0.12f, low.y + 1.1f, -0.24f}));
}

void add_roof(Mesh& mesh, const HouseShape& shape, float y, Draws& draws) {
    constexpr float rise = 2.7f, run = 1.25f, tile = 0.2f, shown = 0.15f;
    const float half = 0.5f * shape.width_m;
    const vec3 upwards = glm::normalize(vec3(0.0f, rise, -run));
    const vec3 out = glm::cross(vec3(1.0f, 0.0f, 0.0f), upwards);
    const float length = std::hypot(rise, run);
    add_quad(mesh, {-half, y, 0.0f}, {shape.width_m, 0.0f, 0.0f}, {0.0f, rise, -run}, slate_dark);
    add_quad(mesh, {-half, y + rise, -run}, {shape.width_m, 0.0f, 0.0f}, {0.0f, 0.25f, -(shape.depth_m - run)}, zinc);
    Mesh slate_tile;
    add_tile(slate_tile, {{0.0f, 0.0f, 0.0f}, {tile - 0.006f, 0.022f, 0.26f}}, 0.006f, slate);
    std::array<Mesh, 3> tones = {slate_tile, slate_tile, slate_tile};
    for (std::uint32_t k = 1; k < 3; ++k) std::ranges::fill(tones[k].materials, slate + k);
    for (int row = 0; static_cast<float>(row) * shown < length - 0.15f; ++row) {
        const float shift = row % 2 == 0 ? 0.0f : 0.5f * tile;
        for (float x = -half + shift; x < half - tile; x += tile) {
            const vec3 at = vec3(x, y, 0.0f) + (shown * static_cast<float>(row) + 0.24f) * upwards +
                            (0.012f + draws.between(0.0f, 0.006f)) * out;
            // Tilted a little, so that each lies over the row below.
            const vec3 down = glm::normalize(-upwards + 0.06f * out);
            append(mesh, tones[draws.below(3)],
                   framed({1.0f, 0.0f, 0.0f}, glm::cross(down, vec3(1.0f, 0.0f, 0.0f)), down, at));
        }
    }
}

void add_dormer(Mesh& mesh, vec3 foot) {
    constexpr float half = 0.62f, high = 1.55f, deep = 0.95f;
    Mesh dormer;
    const Opening opening{{-half, 0.0f}, {half, high}, {-0.42f, 0.18f}, {0.42f, 1.35f}, 0.14f, trim, glass};
    add_opening(dormer, opening);
    for (const float x : {-0.42f, -0.03f, 0.36f})
        add_box(dormer, {{x, 0.18f, -0.14f}, {x + 0.06f, 1.35f, -0.09f}}, window_frame);
    for (const float side : {-1.0f, 1.0f})
        add_box(dormer, {{side * half - 0.04f, 0.0f, -deep}, {side * half + 0.04f, high, -0.001f}}, zinc);
    const std::array<vec3, 3> gable = {vec3(-0.8f, high, 0.05f), vec3(0.8f, high, 0.05f),
                                       vec3(0.0f, high + 0.5f, 0.05f)};
    add_polygon(dormer, gable, trim);
    const vec3 back(0.0f, 0.0f, -deep - 0.2f);
    add_quad(dormer, gable[1], back, gable[2] - gable[1], zinc);
    add_quad(dormer, gable[2], back, gable[0] - gable[2], zinc);
    append(mesh, dormer, placed(foot));
}

void add_chimney(Mesh& mesh, vec3 foot, Draws& draws) {
    const float high = draws.between(1.6f, 2.4f);
    add_box(mesh, {foot + vec3(-0.3f, 0.0f, -0.9f), foot + vec3(0.3f, high, 0.9f)}, chimney);
    add_box(mesh, {foot + vec3(-0.36f, high, -0.96f), foot + vec3(0.36f, high + 0.14f, 0.96f)}, trim_dark);
    const std::array<vec2, 6> profile = {vec2(0.15f, 0.0f),  vec2(0.12f, 0.1f), vec2(0.1f, 0.5f),
                                         vec2(0.13f, 0.55f), vec2(0.1f, 0.6f),  vec2(0.07f, 0.6f)};
    for (int i = 0; i < 4; ++i) {
        Mesh cap;
        add_revolution(cap, profile, 14, pot);
        append(mesh, cap,
               placed(foot + vec3(0.0f, high + 0.14f, -0.66f + 0.44f * static_cast<float>(i)), 0.0f,
                      draws.between(0.8f, 1.2f)));
    }
}

/// Those before first_wall, in the order of MaterialIndex.
std::vector<Material> named_materials() {
    return {
        diffuse("cobble", {0.25f, 0.24f, 0.23f}, 0.7f),
        diffuse("warm cobble", {0.29f, 0.255f, 0.22f}, 0.7f),
        diffuse("dark cobble", {0.18f, 0.18f, 0.185f}, 0.6f),
        diffuse("joint", {0.12f, 0.11f, 0.10f}),
        diffuse("slab", {0.40f, 0.385f, 0.36f}),
        diffuse("warm slab", {0.44f, 0.405f, 0.36f}),
        diffuse("dark slab", {0.34f, 0.335f, 0.325f}),
        diffuse("kerb", {0.38f, 0.37f, 0.36f}),
        diffuse("trim", {0.66f, 0.61f, 0.52f}),
        diffuse("dark trim", {0.52f, 0.47f, 0.39f}),
        diffuse("slate", {0.15f, 0.16f, 0.18f}, 0.5f),
        diffuse("blue slate", {0.17f, 0.19f, 0.23f}, 0.5f),
        diffuse("dark slate", {0.11f, 0.115f, 0.13f}, 0.5f),
        diffuse("zinc", {0.40f, 0.43f, 0.46f}, 0.4f),
        diffuse("glass", {0.05f, 0.07f, 0.085f}, 0.06f),
        diffuse("lit glass", {0.62f, 0.42f, 0.18f}, 0.1f),
        diffuse("curtain", {0.66f, 0.63f, 0.57f}),
        diffuse("window frame", {0.70f, 0.68f, 0.62f}, 0.6f),
        diffuse("iron", {0.035f, 0.037f, 0.04f}, 0.4f),
        diffuse("brass", {0.72f, 0.50f, 0.18f}, 0.25f),
        diffuse("chimney", {0.46f, 0.27f, 0.19f}),
        diffuse("clay", {0.55f, 0.26f, 0.15f}),
        diffuse("red canvas", {0.52f, 0.05f, 0.045f}),
        diffuse("green canvas", {0.05f, 0.21f, 0.12f}),
        diffuse("cream canvas", {0.76f, 0.71f, 0.58f}),
        diffuse("timber", {0.13f, 0.075f, 0.045f}, 0.5f),
        diffuse("cane", {0.55f, 0.38f, 0.18f}, 0.7f),
        diffuse("marble", {0.78f, 0.76f, 0.73f}, 0.2f),
        diffuse("bottle", {0.03f, 0.10f, 0.045f}, 0.08f),
        diffuse("wine", {0.22f, 0.015f, 0.03f}, 0.08f),
        diffuse("porcelain", {0.84f, 0.83f, 0.80f}, 0.2f),
        diffuse("bulb", {0.92f, 0.82f, 0.56f}, 0.3f),
        diffuse("lantern", {0.80f, 0.74f, 0.58f}, 0.2f),
        diffuse("tyre", {0.03f, 0.03f, 0.03f}),
        diffuse("red paint", {0.55f, 0.05f, 0.04f}, 0.3f),
        diffuse("blue paint", {0.06f, 0.16f, 0.38f}, 0.3f),
        diffuse("cream paint", {0.76f, 0.70f, 0.55f}, 0.3f),
        diffuse("water", {0.06f, 0.16f, 0.19f}, 0.05f),
        diffuse("bark", {0.26f, 0.22f, 0.16f}),
        diffuse("dark leaf", {0.055f, 0.155f, 0.035f}),
        diffuse("leaf", {0.09f, 0.22f, 0.04f}),
        diffuse("light leaf", {0.15f, 0.30f, 0.06f}),
        diffuse("dark ivy", {0.035f, 0.115f, 0.03f}),
        diffuse("ivy", {0.06f, 0.17f, 0.04f}),
        diffuse("light ivy", {0.11f, 0.25f, 0.06f}),
        diffuse("red petal", {0.66f, 0.04f, 0.05f}),
        diffuse("pink petal", {0.76f, 0.25f, 0.36f}),
        diffuse("white petal", {0.86f, 0.85f, 0.80f}),
    };
}

}  // namespace

std::vector<Material> materials() {
    std::vector<Material> all = named_materials();
    all[iron].metallic = all[brass].metallic = all[zinc].metallic = 1.0f;
    constexpr std::array<vec3, wall_tones> walls = {
        vec3(0.66f, 0.59f, 0.46f), vec3(0.60f, 0.50f, 0.36f), vec3(0.70f, 0.64f, 0.54f), vec3(0.56f, 0.53f, 0.47f),
        vec3(0.64f, 0.48f, 0.34f), vec3(0.58f, 0.57f, 0.55f), vec3(0.68f, 0.55f, 0.43f), vec3(0.52f, 0.40f, 0.30f)};
    for (const vec3 wall : walls) all.push_back(diffuse("wall " + std::to_string(all.size() - first_wall + 1), wall));
    constexpr std::array<vec3, shutter_tones> shutters = {vec3(0.08f, 0.22f, 0.17f), vec3(0.16f, 0.28f, 0.38f),
                                                          vec3(0.55f, 0.53f, 0.47f), vec3(0.28f, 0.09f, 0.06f),
                                                          vec3(0.20f, 0.26f, 0.20f)};
    for (const vec3 paint : shutters)
        all.push_back(diffuse("shutter " + std::to_string(all.size() - first_shutter + 1), paint, 0.5f));
    for (std::uint32_t i = 0; i < all.size(); ++i)
        all[i].double_sided =
            (i >= canvas_red && i <= canvas_cream) || i == curtain || (i >= leaf_dark && i <= petal_white);
    return all;
}

void add_shop(Mesh& mesh, vec2 low, vec2 high, const HouseShape& shape, Draws& draws) {
    const float width = high.x - low.x;
    const int bays = std::max(static_cast<int>(std::lround(width / 3.4f)), 1);
    const float bay = width / static_cast<float>(bays);
    const int gate = bays > 1 ? static_cast<int>(draws.below(static_cast<std::uint32_t>(bays))) : -1;
    for (int i = 0; i < bays; ++i) {
        const vec2 from(low.x + bay * static_cast<float>(i), low.y), to(from.x + bay, high.y);
        if (i == gate) {
            add_gate(mesh, from, to, shape);
            continue;
        }
        const Opening opening{from,          to,   from + vec2(0.32f, 0.62f), to - vec2(0.32f, 1.05f), 0.22f,
                              shape.shutter, glass};
        add_opening(mesh, opening);
        add_display(mesh, opening, draws);
        add_box(mesh, {{from.x + 0.25f, to.y - 0.95f, 0.0f}, {to.x - 0.25f, to.y - 0.35f, 0.1f}}, shape.shutter);
        add_box(mesh, {{from.x + 0.6f, to.y - 0.75f, 0.1f}, {to.x - 0.6f, to.y - 0.55f, 0.125f}}, brass);
        if (draws.unit() < 0.7f) add_awning(mesh, from.x + 0.3f, to.x - 0.3f, to.y - 1.0f, shape.canvas);
    }
    for (int i = 0; i <= bays; ++i)
        add_pilaster(mesh, std::clamp(low.x + bay * static_cast<float>(i), low.x + 0.25f, high.x - 0.25f),
                     high.y - 0.16f, shape.wall);
}

Mesh house_mesh(const HouseShape& shape, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const float half = 0.5f * shape.width_m, deep = shape.depth_m;
    const float top = ground_floor_height + floor_height * static_cast<float>(shape.upper_floors);
    append(mesh, front_mesh(shape, shape.width_m, seed + 1), placed({-half, 0.0f, 0.0f}));
    const auto side = [&](bool open, vec3 corner, float turn_deg, std::uint32_t key) {
        if (open)
            append(mesh, front_mesh(shape, deep, key), placed(corner, turn_deg));
        else
            add_quad(mesh, corner, deep * vec3(placed({}, turn_deg)[0]), {0.0f, top, 0.0f}, shape.wall);
    };
    side(shape.right_front, {half, 0.0f, 0.0f}, 90.0f, seed + 2);
    side(shape.left_front, {-half, 0.0f, -deep}, 270.0f, seed + 3);
    add_quad(mesh, {half, 0.0f, -deep}, {-2.0f * half, 0.0f, 0.0f}, {0.0f, top + 2.95f, 0.0f}, shape.wall);
    add_roof(mesh, shape, top, draws);
    // The gables beside the roof.
    for (const float x : {-half, half}) {
        const std::array<vec3, 5> gable = {vec3(x, top, -deep), vec3(x, top, 0.0f), vec3(x, top + 2.7f, -1.25f),
                                           vec3(x, top + 2.8f, -0.5f * deep), vec3(x, top + 2.95f, -deep)};
        std::vector<vec3> corners(gable.begin(), gable.end());
        if (x > 0.0f) std::ranges::reverse(corners);
        add_outline(mesh, corners, shape.wall);
    }
    const int dormers = std::max(static_cast<int>(shape.width_m / 2.75f), 1);
    for (int i = 0; i < dormers; ++i) {
        const float x = -half + shape.width_m * (static_cast<float>(i) + 0.5f) / static_cast<float>(dormers);
        add_dormer(mesh, {x, top + 0.35f, -0.02f});
    }
    add_chimney(mesh, {-half + 0.5f, top + 2.6f, -0.5f * deep}, draws);
    if (draws.unit() < 0.6f) add_chimney(mesh, {half - 0.5f, top + 2.6f, -0.6f * deep}, draws);
    return mesh;
}

}  // namespace sightlines::street
