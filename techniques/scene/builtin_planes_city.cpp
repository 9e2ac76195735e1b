#include <algorithm>
#include <array>
#include <cmath>

#include "techniques/scene/builtin_planes.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::planes {
namespace {

/// One outer wall: `corner` low on its left as one looks at it, `along` to the right, `out` towards the street.
struct Front {
    vec3 corner, along, out;
    float width;
};

constexpr vec3 up(0.0f, 1.0f, 0.0f);

/// A rectangle on a front: x to the right, y up, `depth` in front of the wall's plane.
void add_panel(Mesh& mesh, const Front& front, vec2 low, vec2 high, float depth, std::uint32_t material) {
    add_quad(mesh, front.corner + low.x * front.along + low.y * up + depth * front.out, (high.x - low.x) * front.along,
             (high.y - low.y) * up, material);
}

/// A box that stands out from a front, without its back.
void add_bulge(Mesh& mesh, const Front& front, vec2 low, vec2 high, float from, float to, std::uint32_t material) {
    add_panel(mesh, front, low, high, to, material);
    const vec3 base = front.corner + low.x * front.along + low.y * up + from * front.out;
    const vec3 x = (high.x - low.x) * front.along, y = (high.y - low.y) * up, z = (to - from) * front.out;
    add_quad(mesh, base, x, z, material);
    add_quad(mesh, base + y, z, x, material);
    add_quad(mesh, base, z, y, material);
    add_quad(mesh, base + x, y, z, material);
}

/// What lies round an opening in a cell of the wall, its reveals and the pane at their end.
void add_opening(Mesh& mesh, const Front& front, vec2 low, vec2 high, vec2 open_low, vec2 open_high, float depth,
                 std::uint32_t wall, std::uint32_t pane) {
    if (open_low.y > low.y) add_panel(mesh, front, low, {high.x, open_low.y}, 0.0f, wall);
    if (high.y > open_high.y) add_panel(mesh, front, {low.x, open_high.y}, high, 0.0f, wall);
    if (open_low.x > low.x) add_panel(mesh, front, {low.x, open_low.y}, {open_low.x, open_high.y}, 0.0f, wall);
    if (high.x > open_high.x) add_panel(mesh, front, {open_high.x, open_low.y}, {high.x, open_high.y}, 0.0f, wall);
    add_panel(mesh, front, open_low, open_high, -depth, pane);
    const vec3 base = front.corner + open_low.x * front.along + open_low.y * up - depth * front.out;
    const vec3 x = (open_high.x - open_low.x) * front.along, y = (open_high.y - open_low.y) * up, z = depth * front.out;
    add_quad(mesh, base, z, x, wall);
    add_quad(mesh, base + y, x, z, wall);
    add_quad(mesh, base, y, z, wall);
    add_quad(mesh, base + x, z, y, wall);
}

std::uint32_t any_pane(Draws& draws) {
    const float pick = draws.unit();
    return pick < 0.55f ? glass_dark : pick < 0.85f ? glass_blue : glass_pale;
}

void add_cell(Mesh& mesh, const Front& front, vec2 low, vec2 high, const HouseShape& shape, int column, Draws& draws) {
    const vec2 size = high - low;
    const std::uint32_t pane = any_pane(draws);
    const auto inside = [&](float x0, float y0, float x1, float y1) {
        add_opening(mesh, front, low, high, low + vec2(x0, y0) * size, low + vec2(x1, y1) * size,
                    shape.style == 2 ? 0.06f : 0.22f, shape.wall, pane);
    };
    if (shape.style == 0) {
        inside(0.22f, 0.26f, 0.78f, 0.84f);
        add_bulge(mesh, front, low + vec2(0.18f, 0.22f) * size, low + vec2(0.82f, 0.26f) * size, 0.0f, 0.14f,
                  trim_pale);
        add_bulge(mesh, front, low + vec2(0.485f, 0.26f) * size, low + vec2(0.515f, 0.84f) * size, -0.22f, -0.15f,
                  trim_pale);
    } else if (shape.style == 1) {
        inside(0.0f, 0.34f, 1.0f, 0.88f);
        add_bulge(mesh, front, low + vec2(-0.02f, 0.34f) * size, low + vec2(0.02f, 0.88f) * size, -0.22f, 0.02f,
                  trim_dark);
        add_bulge(mesh, front, low + vec2(0.49f, 0.34f) * size, low + vec2(0.51f, 0.88f) * size, -0.22f, -0.12f,
                  trim_dark);
    } else if (shape.style == 2) {
        inside(0.04f, 0.14f, 0.96f, 0.97f);
        add_bulge(mesh, front, low + vec2(-0.035f, 0.0f) * size, low + vec2(0.035f, 1.0f) * size, 0.0f, 0.32f,
                  trim_pale);
    } else {
        const bool balcony = column % 3 == 1;
        inside(balcony ? 0.14f : 0.26f, balcony ? 0.04f : 0.28f, balcony ? 0.86f : 0.74f, 0.82f);
        if (!balcony) return;
        add_bulge(mesh, front, low + vec2(0.02f, -0.02f) * size, low + vec2(0.98f, 0.03f) * size, 0.0f, 1.05f,
                  trim_pale);
        for (const float side : {0.02f, 0.95f})
            add_bulge(mesh, front, low + vec2(side, 0.03f) * size, low + vec2(side + 0.03f, 0.36f) * size, 0.0f, 1.05f,
                      shape.wall);
        add_bulge(mesh, front, low + vec2(0.02f, 0.03f) * size, low + vec2(0.98f, 0.34f) * size, 0.99f, 1.05f,
                  draws.unit() < 0.4f ? glass_pale : shape.wall);
    }
}

/// Shop windows under an awning, with a door now and then.
void add_shop(Mesh& mesh, const Front& front, vec2 low, vec2 high, std::uint32_t wall, std::uint32_t awning,
              Draws& draws) {
    const vec2 size = high - low;
    const bool door = draws.unit() < 0.25f;
    add_opening(mesh, front, low, high, low + vec2(door ? 0.25f : 0.08f, door ? 0.0f : 0.14f) * size,
                low + vec2(door ? 0.75f : 0.92f, 0.76f) * size, 0.3f, wall, glass_dark);
    if (door || draws.unit() < 0.3f) return;
    const vec3 base = front.corner + (low.x + 0.05f * size.x) * front.along + (low.y + 0.66f * size.y) * up;
    add_quad(mesh, base + 1.2f * front.out, 0.9f * size.x * front.along, 0.7f * up - 1.2f * front.out, awning);
}

void add_front(Mesh& mesh, const Front& front, int first_floor, int floors, const HouseShape& shape,
               std::uint32_t awning, Draws& draws) {
    const int columns = std::max(static_cast<int>(std::lround(front.width / (shape.style == 2 ? 1.9f : 2.5f))), 2);
    const float cell = front.width / static_cast<float>(columns);
    for (int floor = 0; floor < floors; ++floor) {
        for (int column = 0; column < columns; ++column) {
            const vec2 low(cell * static_cast<float>(column), floor_height * static_cast<float>(floor));
            const vec2 high = low + vec2(cell, floor_height);
            if (first_floor + floor == 0)
                add_shop(mesh, front, low, high, shape.wall, awning, draws);
            else
                add_cell(mesh, front, low, high, shape, column, draws);
        }
    }
    const float top = floor_height * static_cast<float>(floors);
    if (shape.style != 2) {
        if (first_floor == 0)
            add_bulge(mesh, front, {0.0f, floor_height - 0.18f}, {front.width, floor_height + 0.16f}, 0.0f, 0.22f,
                      trim_pale);
        add_bulge(mesh, front, {0.0f, top - 0.35f}, {front.width, top}, 0.0f, 0.3f, trim_pale);
    }
}

/// Parapet, machines, a stair head, sometimes a water tank.
void add_roof(Mesh& mesh, vec2 half, float y, const HouseShape& shape, bool top, Draws& draws) {
    const std::uint32_t tone = roof_grey + draws.below(3);
    add_quad(mesh, {-half.x, y, half.y}, {2.0f * half.x, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f * half.y}, tone);
    constexpr float thick = 0.3f, high = 0.9f;
    for (const float side : {-1.0f, 1.0f}) {
        const float x = side * (half.x - 0.5f * thick), z = side * (half.y - 0.5f * thick);
        add_box(mesh, {{x - 0.5f * thick, y, -half.y}, {x + 0.5f * thick, y + high, half.y}}, shape.wall);
        add_box(mesh, {{-half.x + thick, y, z - 0.5f * thick}, {half.x - thick, y + high, z + 0.5f * thick}},
                shape.wall);
    }
    if (!top) return;
    const vec2 reach = half - 2.4f;
    const auto place = [&] { return vec2(draws.between(-1.0f, 1.0f), draws.between(-1.0f, 1.0f)) * reach; };
    const vec2 stair = place();
    add_box(mesh, {{stair.x - 1.6f, y, stair.y - 1.2f}, {stair.x + 1.6f, y + 2.8f, stair.y + 1.2f}}, shape.wall);
    const std::uint32_t machines = 2 + draws.below(4);
    for (std::uint32_t i = 0; i < machines; ++i) {
        const vec2 at = place();
        const float size = draws.between(0.6f, 1.2f), tall = draws.between(0.8f, 1.5f);
        add_box(mesh, {{at.x - size, y + 0.2f, at.y - 0.7f * size}, {at.x + size, y + 0.2f + tall, at.y + 0.7f * size}},
                metal);
        const std::array<vec2, 3> fan = {vec2(0.45f * size, 0.0f), vec2(0.45f * size, 0.18f), vec2(0.0f, 0.20f)};
        Mesh cap;
        add_revolution(cap, fan, 10, metal_dark);
        append(mesh, cap, placed({at.x, y + 0.2f + tall, at.y}));
        const float duct = draws.between(1.5f, 4.0f);
        add_box(mesh, {{at.x, y + 0.25f, at.y - 0.2f}, {std::min(at.x + duct, half.x - 0.5f), y + 0.6f, at.y + 0.2f}},
                metal);
    }
    if (shape.style == 2) {
        add_rod(mesh, {0.0f, y, 0.0f}, {0.0f, y + 9.0f, 0.0f}, 0.12f, 6, metal_dark);
    } else if (draws.unit() < 0.55f) {
        const vec2 at = place();
        Mesh tank;
        const std::array<vec2, 4> profile = {vec2(0.0f, 2.0f), vec2(1.5f, 2.0f), vec2(1.4f, 4.8f), vec2(0.0f, 5.9f)};
        add_revolution(tank, profile, 18, tank_wood);
        for (const float x : {-1.0f, 1.0f})
            for (const float z : {-1.0f, 1.0f}) add_rod(tank, {x, 0.0f, z}, {x, 2.0f, z}, 0.09f, 5, metal_dark);
        append(mesh, tank, placed({at.x, y, at.y}));
    }
}

void add_tier(Mesh& mesh, vec2 half, int first_floor, int floors, const HouseShape& shape, bool top,
              std::uint32_t awning, Draws& draws) {
    const float y = floor_height * static_cast<float>(first_floor);
    const std::array<Front, 4> fronts = {
        Front{{-half.x, y, half.y}, {1, 0, 0}, {0, 0, 1}, 2.0f * half.x},
        Front{{half.x, y, half.y}, {0, 0, -1}, {1, 0, 0}, 2.0f * half.y},
        Front{{half.x, y, -half.y}, {-1, 0, 0}, {0, 0, -1}, 2.0f * half.x},
        Front{{-half.x, y, -half.y}, {0, 0, 1}, {-1, 0, 0}, 2.0f * half.y},
    };
    for (const Front& front : fronts) add_front(mesh, front, first_floor, floors, shape, awning, draws);
    add_roof(mesh, half, y + floor_height * static_cast<float>(floors), shape, top, draws);
}

}  // namespace

std::vector<Material> materials() {
    std::vector<Material> all = {
        diffuse("asphalt", {0.085f, 0.085f, 0.09f}),
        diffuse("worn asphalt", {0.105f, 0.10f, 0.10f}),
        diffuse("pavement", {0.36f, 0.35f, 0.33f}),
        diffuse("road marking", {0.70f, 0.69f, 0.64f}),
        diffuse("lawn", {0.13f, 0.23f, 0.06f}),
        diffuse("dark lawn", {0.11f, 0.20f, 0.05f}),
        diffuse("grey roof", {0.24f, 0.235f, 0.23f}),
        diffuse("dark roof", {0.16f, 0.155f, 0.155f}),
        diffuse("pale roof", {0.34f, 0.31f, 0.27f}),
        diffuse("metal", {0.46f, 0.47f, 0.49f}, 0.5f),
        diffuse("dark metal", {0.13f, 0.13f, 0.14f}, 0.5f),
        diffuse("tank wood", {0.30f, 0.19f, 0.11f}),
        diffuse("dark glass", {0.035f, 0.05f, 0.065f}, 0.1f),
        diffuse("blue glass", {0.07f, 0.13f, 0.18f}, 0.1f),
        diffuse("pale glass", {0.20f, 0.27f, 0.31f}, 0.1f),
        diffuse("pale trim", {0.56f, 0.52f, 0.45f}),
        diffuse("dark trim", {0.10f, 0.10f, 0.11f}),
        diffuse("red awning", {0.50f, 0.06f, 0.05f}),
        diffuse("green awning", {0.05f, 0.26f, 0.12f}),
        diffuse("blue awning", {0.06f, 0.14f, 0.36f}),
        diffuse("white paint", {0.84f, 0.84f, 0.82f}, 0.4f),
        diffuse("red paint", {0.66f, 0.05f, 0.04f}, 0.4f),
        diffuse("grey paint", {0.36f, 0.37f, 0.39f}, 0.4f),
        diffuse("black paint", {0.03f, 0.03f, 0.035f}, 0.4f),
        diffuse("white car", {0.76f, 0.76f, 0.74f}, 0.3f),
        diffuse("black car", {0.035f, 0.035f, 0.04f}, 0.3f),
        diffuse("silver car", {0.42f, 0.43f, 0.45f}, 0.3f),
        diffuse("red car", {0.50f, 0.04f, 0.035f}, 0.3f),
        diffuse("blue car", {0.05f, 0.11f, 0.34f}, 0.3f),
        diffuse("yellow car", {0.80f, 0.52f, 0.04f}, 0.3f),
        diffuse("bark", {0.16f, 0.11f, 0.075f}),
        diffuse("dark leaf", {0.06f, 0.16f, 0.035f}),
        diffuse("leaf", {0.10f, 0.22f, 0.045f}),
        diffuse("light leaf", {0.16f, 0.29f, 0.06f}),
    };
    constexpr std::array<vec3, wall_tones> walls = {
        vec3(0.58f, 0.51f, 0.40f), vec3(0.66f, 0.61f, 0.52f), vec3(0.40f, 0.17f, 0.11f), vec3(0.47f, 0.24f, 0.16f),
        vec3(0.31f, 0.29f, 0.27f), vec3(0.50f, 0.49f, 0.48f), vec3(0.62f, 0.44f, 0.27f), vec3(0.28f, 0.33f, 0.38f),
        vec3(0.70f, 0.69f, 0.66f), vec3(0.36f, 0.25f, 0.18f), vec3(0.55f, 0.35f, 0.26f), vec3(0.44f, 0.46f, 0.40f)};
    for (const vec3 wall : walls) all.push_back(diffuse("wall " + std::to_string(all.size() - first_wall + 1), wall));
    for (std::uint32_t i = 0; i < all.size(); ++i)
        all[i].double_sided = (i >= leaf_dark && i <= leaf_light) || (i >= awning_red && i <= awning_blue);
    return all;
}

Mesh house_mesh(const HouseShape& shape, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const std::uint32_t awning = awning_red + draws.below(3);
    const vec2 half = 0.5f * shape.size_m;
    if (shape.floors > 9 && shape.style != 2) {
        const int lower = shape.floors * 2 / 3;
        add_tier(mesh, half, 0, lower, shape, false, awning, draws);
        add_tier(mesh, half - 2.0f, lower, shape.floors - lower, shape, true, awning, draws);
    } else {
        add_tier(mesh, half, 0, shape.floors, shape, true, awning, draws);
    }
    return mesh;
}

Mesh car_mesh(std::uint32_t paint) {
    Mesh mesh;
    // The body's outline from the side, pulled across; x forwards.
    constexpr std::array<vec2, 12> side = {vec2(-2.1f, 0.35f), vec2(2.1f, 0.35f),  vec2(2.15f, 0.70f),
                                           vec2(1.95f, 0.86f), vec2(1.0f, 0.95f),  vec2(0.45f, 1.38f),
                                           vec2(-0.2f, 1.45f), vec2(-1.2f, 1.40f), vec2(-1.75f, 1.0f),
                                           vec2(-2.1f, 0.94f), vec2(-2.2f, 0.75f), vec2(-2.15f, 0.4f)};
    constexpr float half = 0.85f;
    for (std::size_t i = 0; i < side.size(); ++i) {
        const vec2 a = side[i], b = side[(i + 1) % side.size()];
        const bool pane = i == 4 || i == 7;
        const std::array<vec3, 4> strip = {vec3(a.x, a.y, half), vec3(a.x, a.y, -half), vec3(b.x, b.y, -half),
                                           vec3(b.x, b.y, half)};
        add_polygon(mesh, strip, pane ? static_cast<std::uint32_t>(glass_dark) : paint);
    }
    for (const float z : {-1.0f, 1.0f}) {
        std::vector<vec3> flank, pane;
        for (const vec2 p : side) flank.push_back({p.x, p.y, z * half});
        for (const vec2 p : {vec2(0.9f, 0.97f), vec2(0.42f, 1.33f), vec2(-1.15f, 1.34f), vec2(-1.6f, 1.0f)})
            pane.push_back({p.x, p.y, z * (half + 0.01f)});
        if (z < 0.0f) std::reverse(flank.begin(), flank.end());
        if (z < 0.0f) std::reverse(pane.begin(), pane.end());
        add_outline(mesh, flank, paint);
        add_polygon(mesh, pane, glass_dark);
        for (const float x : {-1.3f, 1.35f})
            add_rod(mesh, {x, 0.34f, z * (half - 0.2f)}, {x, 0.34f, z * (half + 0.04f)}, 0.34f, 12, paint_black);
    }
    return mesh;
}

Mesh lamp_mesh() {
    Mesh mesh;
    add_rod(mesh, {0.0f, 0.0f, 0.0f}, {0.0f, 5.6f, 0.0f}, 0.07f, 6, metal_dark);
    add_rod(mesh, {0.0f, 5.5f, 0.0f}, {1.5f, 5.8f, 0.0f}, 0.05f, 5, metal_dark);
    add_box(mesh, {{1.1f, 5.68f, -0.14f}, {1.8f, 5.80f, 0.14f}}, metal);
    return mesh;
}

}  // namespace sightlines::planes
