#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_cathedral.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::cathedral {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr vec3 up(0.0f, 1.0f, 0.0f);

/// Rolls and hollows of a rib or an arch's edge, about `size` across.
std::vector<vec2> moulding(float size) {
    std::vector<vec2> profile;
    for (int i = 0; i < 8; ++i) {
        const float angle = 2.0f * pi * static_cast<float>(i) / 8.0f;
        const float radius = 0.5f * size * (i % 2 == 0 ? 1.0f : 0.82f);
        profile.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return profile;
}

/// Up one side of an opening, over its arch and down the other, in the plane z.
std::vector<vec3> outline_of(const OpeningShape& shape, float grow, float z, int steps) {
    std::vector<vec3> path;
    const bool jambs = shape.spring > shape.sill + 1e-3f;
    if (jambs) path.push_back({-shape.half_span - grow, shape.sill, z});
    for (int i = 0; i <= 2 * steps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps) - 1.0f;
        // Closer together where the arch is steep.
        const float x = (shape.half_span + grow) * std::sin(0.5f * pi * t);
        path.push_back({x, shape.spring + pointed(x, shape.half_span + grow, shape.rise + grow), z});
    }
    if (jambs) path.push_back({shape.half_span + grow, shape.sill, z});
    return path;
}

void add_shaft(Mesh& mesh, vec2 place, float low, float high, float radius, int segments, std::uint32_t material) {
    Mesh shaft;
    const float r = radius, top = high - 0.55f;
    const std::array<vec2, 19> profile = {
        vec2(1.5f * r, low),          vec2(1.5f * r, low + 0.10f),  vec2(1.32f * r, low + 0.16f),
        vec2(1.38f * r, low + 0.22f), vec2(1.1f * r, low + 0.28f),  vec2(1.16f * r, low + 0.33f),
        vec2(r, low + 0.38f),         vec2(r, top - 0.12f),         vec2(1.18f * r, top - 0.08f),
        vec2(1.18f * r, top - 0.02f), vec2(r, top + 0.02f),         vec2(1.06f * r, top + 0.12f),
        vec2(1.25f * r, top + 0.26f), vec2(1.55f * r, top + 0.38f), vec2(1.62f * r, top + 0.42f),
        vec2(1.62f * r, top + 0.46f), vec2(1.75f * r, top + 0.48f), vec2(1.75f * r, top + 0.55f),
        vec2(0.0f, top + 0.55f)};
    add_revolution(shaft, profile, segments, material);
    append(mesh, shaft, placed({place.x, 0.0f, place.y}));
}

/// The half of a vault's profile, 1 at the middle and 0 at the springing.
float vault_profile(float t) { return pointed(t, 1.0f, 1.25f) / 1.25f; }

void add_rib(Mesh& mesh, const std::vector<vec3>& path, vec3 binormal, float size) {
    add_sweep(mesh, path, binormal, moulding(size), false, stone_light);
}

constexpr float rose_middle = 14.6f, rose_radius = 3.6f;  // of the west front

/// The wall round the rose, from its circle out to the rectangle above the door, and the panes in the circle.
void add_rose(Mesh& mesh) {
    const auto frame_at = [&](float angle) {
        const vec2 out(std::cos(angle), std::sin(angle));
        const float to_side = std::abs(out.x) > 1e-4f ? nave_half / std::abs(out.x) : 1e9f;
        const float to_top = std::abs(out.y) > 1e-4f
                                 ? (out.y > 0.0f ? 22.0f - rose_middle : rose_middle - 9.0f) / std::abs(out.y)
                                 : 1e9f;
        return std::min(to_side, to_top) * out;
    };
    constexpr int around = 96;
    for (int i = 0; i < around; ++i) {
        const float a = 2.0f * pi * static_cast<float>(i) / around, b = 2.0f * pi * static_cast<float>(i + 1) / around;
        const vec2 p = rose_radius * vec2(std::cos(a), std::sin(a)), q = rose_radius * vec2(std::cos(b), std::sin(b));
        const vec2 far_p = frame_at(a), far_q = frame_at(b);
        const auto at = [&](vec2 place, float z) { return vec3(place.x, rose_middle + place.y, z); };
        add_polygon(mesh, std::array<vec3, 4>{at(p, 0.6f), at(far_p, 0.6f), at(far_q, 0.6f), at(q, 0.6f)}, stone);
        add_polygon(mesh, std::array<vec3, 4>{at(p, -0.4f), at(p, 0.6f), at(q, 0.6f), at(q, -0.4f)}, stone_light);
        // Panes: rings of glass between the spokes.
        for (int ring = 0; ring < 10; ++ring) {
            const float r0 = 0.35f + 0.325f * static_cast<float>(ring), r1 = r0 + 0.30f;
            const auto pane = [&](float r, float angle) {
                return vec3(r * std::cos(angle), rose_middle + r * std::sin(angle), 0.0f);
            };
            const float gap = 0.006f;
            const std::uint32_t petal = static_cast<std::uint32_t>(i / 8 + ring / 3);
            const std::uint32_t colour = ring % 3 == 2 ? 4 + petal % 2
                                         : (petal + static_cast<std::uint32_t>(ring)) % 2 == 0
                                             ? 2 + static_cast<std::uint32_t>(i % 2)
                                             : static_cast<std::uint32_t>(ring % 2);
            add_polygon(mesh,
                        std::array<vec3, 4>{pane(r0, a + gap), pane(r1, a + gap), pane(r1, b - gap), pane(r0, b - gap)},
                        glass_red + colour);
        }
    }
}

void add_rose_tracery(Mesh& mesh) {
    const auto ring_of = [&](vec2 at, float r, float size) {
        std::vector<vec3> path;
        for (int i = 0; i < 40; ++i) {
            const float angle = -2.0f * pi * static_cast<float>(i) / 40.0f;
            path.push_back({at.x + r * std::cos(angle), rose_middle + at.y + r * std::sin(angle), 0.15f});
        }
        add_sweep(mesh, path, {0, 0, 1}, moulding(size), true, stone_light);
    };
    for (const float r : {0.42f, 2.1f, 3.55f}) ring_of(vec2(0.0f), r, 0.20f);
    for (int k = 0; k < 12; ++k) {
        const float angle = 2.0f * pi * static_cast<float>(k) / 12.0f, between = angle + pi / 12.0f;
        const vec3 out(std::cos(angle), std::sin(angle), 0.0f);
        add_rod(mesh, vec3(0, rose_middle, 0.15f) + 0.42f * out, vec3(0, rose_middle, 0.15f) + 3.5f * out, 0.075f, 8,
                stone_light);
        ring_of(2.82f * vec2(std::cos(between), std::sin(between)), 0.62f, 0.12f);
    }
}

}  // namespace

float pointed(float x, float half_span, float rise) {
    const float radius = (half_span * half_span + rise * rise) / (2.0f * half_span);
    const float out = std::abs(x) + radius - half_span;
    return std::sqrt(std::max(radius * radius - out * out, 0.0f));
}

Mesh pier_mesh() {
    Mesh mesh;
    const std::array<vec2, 8> foot = {vec2(0.95f, 0.38f),  vec2(0.38f, 0.95f),   vec2(-0.38f, 0.95f),
                                      vec2(-0.95f, 0.38f), vec2(-0.95f, -0.38f), vec2(-0.38f, -0.95f),
                                      vec2(0.38f, -0.95f), vec2(0.95f, -0.38f)};
    std::vector<vec2> outline;
    for (const vec2 corner : foot) outline.push_back({corner.x, -corner.y});
    add_prism(mesh, outline, 0.0f, 0.42f, stone_dark, stone);
    add_shaft(mesh, vec2(0.0f), 0.42f, pier_height, 0.52f, 26, stone);
    for (int k = 0; k < 8; ++k) {
        const float angle = 0.25f * pi * static_cast<float>(k), radius = k % 2 == 0 ? 0.16f : 0.11f;
        add_shaft(mesh, 0.60f * vec2(std::cos(angle), std::sin(angle)), 0.42f, pier_height, radius, 11,
                  k % 2 == 0 ? stone_light : stone_warm);
    }
    return mesh;
}

Mesh vault_mesh(float half_x, float half_z, float rise) {
    Mesh mesh;
    constexpr int cells = 18;
    const auto ceiling = [=](float s, float t) {
        return vec3(half_x * s, rise * vault_profile(std::min(std::abs(s), std::abs(t))), half_z * t);
    };
    add_surface(
        mesh, {cells, cells}, false, [&](vec2 uv) { return ceiling(2.0f * uv.x - 1.0f, 2.0f * uv.y - 1.0f); }, vault);
    const auto rib = [&](auto along, vec3 binormal, float size) {
        std::vector<vec3> path;
        for (int i = 0; i <= 24; ++i) path.push_back(along(static_cast<float>(i) / 12.0f - 1.0f) - 0.06f * up);
        add_rib(mesh, path, binormal, size);
    };
    for (const float side : {-1.0f, 1.0f})
        rib([&](float t) { return ceiling(side * t, t); }, glm::normalize(vec3(half_z, 0.0f, -side * half_x)), 0.30f);
    rib([&](float t) { return vec3(-half_x, rise * vault_profile(std::abs(t)), half_z * t); }, {1, 0, 0}, 0.42f);
    add_ball(mesh, {0.0f, rise - 0.15f, 0.0f}, {0.34f, 0.24f, 0.34f}, 24, stone_light);
    return mesh;
}

void add_wall_with_opening(Mesh& mesh, const OpeningShape& shape, std::uint32_t material) {
    constexpr int slices = 16;
    const float half = 0.5f * shape.thickness;
    const auto strip = [&](float x0, float x1, vec2 low, vec2 high) {
        for (const float z : {half, -half}) {
            std::array<vec3, 4> corners = {vec3(x0, low.x, z), vec3(x1, low.y, z), vec3(x1, high.y, z),
                                           vec3(x0, high.x, z)};
            if (z < 0.0f) std::reverse(corners.begin(), corners.end());
            add_polygon(mesh, corners, material);
        }
    };
    strip(-shape.half_wall, -shape.half_span, vec2(0.0f), vec2(shape.wall_height));
    strip(shape.half_span, shape.half_wall, vec2(0.0f), vec2(shape.wall_height));
    if (shape.sill > 0.0f) strip(-shape.half_span, shape.half_span, vec2(0.0f), vec2(shape.sill));
    const std::vector<vec3> path = outline_of(shape, 0.0f, 0.0f, slices / 2);
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
        if (path[i + 1].x > path[i].x + 1e-4f)
            strip(path[i].x, path[i + 1].x, {path[i].y, path[i + 1].y}, vec2(shape.wall_height));
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        if (glm::distance(path[i], path[i + 1]) < 1e-4f) continue;
        const vec3 deep(0.0f, 0.0f, half);
        add_polygon(mesh, std::array<vec3, 4>{path[i] + deep, path[i] - deep, path[i + 1] - deep, path[i + 1] + deep},
                    stone_light);
    }
    if (shape.sill > 0.0f)
        add_quad(mesh, {-shape.half_span, shape.sill, half}, {2.0f * shape.half_span, 0, 0}, {0, 0, -shape.thickness},
                 stone_light);
}

void add_mouldings(Mesh& mesh, const OpeningShape& shape, float z, std::uint32_t material, int orders) {
    for (int order = 0; order < orders; ++order) {
        const float grow = 0.02f + 0.14f * static_cast<float>(order);
        const std::vector<vec3> path = outline_of(shape, grow, z - 0.03f * static_cast<float>(order), 9);
        add_sweep(mesh, path, {0, 0, 1}, moulding(order == 1 ? 0.14f : 0.19f), false, material);
    }
}

void add_window(Mesh& mesh, const OpeningShape& shape, int lancets, std::uint32_t seed) {
    const float top = shape.spring + shape.rise;
    constexpr float pane = 0.25f, depth = -0.10f;
    const int columns = static_cast<int>(std::ceil(2.0f * shape.half_span / pane));
    const float width = 2.0f * shape.half_span / static_cast<float>(columns);
    for (int i = 0; i < columns; ++i) {
        for (float y = shape.sill; y < top; y += pane) {
            const float x0 = -shape.half_span + width * static_cast<float>(i);
            const float inner = std::min(std::abs(x0), std::abs(x0 + width));
            if (y > shape.spring && y > shape.spring + pointed(inner, shape.half_span, shape.rise)) continue;
            // Lozenges of colour in a field of blue, a border of red: medieval habits.
            const vec2 at(x0 + 0.5f * width, y - shape.sill);
            const vec2 cell =
                glm::abs(glm::fract(at / vec2(2.0f * shape.half_span / static_cast<float>(lancets), 1.6f)) - 0.5f);
            const float ring = cell.x + cell.y;
            const std::uint32_t draw =
                random_u32(seed, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(y / pane));
            std::uint32_t colour = ring < 0.22f   ? 4 + draw % 2
                                   : ring < 0.36f ? draw % 2
                                   : ring < 0.46f ? 6 + draw % 2
                                                  : 2 + draw % 2;
            if (i == 0 || i == columns - 1) colour = draw % 3 == 0 ? 4 : 0;
            add_quad(mesh, {x0 + 0.012f, y + 0.012f, depth}, {width - 0.024f, 0, 0}, {0, pane - 0.024f, 0},
                     glass_red + colour);
        }
    }
    add_quad(mesh, {-shape.half_span, shape.sill, depth - 0.03f}, {2.0f * shape.half_span, 0, 0},
             {0, top - shape.sill, 0}, lead);
    // Mullions, small pointed arches at their heads and a ring above.
    const float lancet = shape.half_span / static_cast<float>(lancets), head = shape.spring - 0.1f;
    for (int k = 1; k < lancets; ++k) {
        const float x = -shape.half_span + 2.0f * lancet * static_cast<float>(k);
        add_rod(mesh, {x, shape.sill, 0.0f}, {x, head, 0.0f}, 0.075f, 10, stone_light);
    }
    for (int k = 0; k < lancets; ++k) {
        const float x = -shape.half_span + lancet * (2.0f * static_cast<float>(k) + 1.0f);
        OpeningShape small{0, 0, lancet, head - 0.1f, head, 1.15f * lancet, 0};
        std::vector<vec3> path = outline_of(small, 0.0f, 0.0f, 6);
        for (vec3& point : path) point.x += x;
        add_sweep(mesh, path, {0, 0, 1}, moulding(0.13f), false, stone_light);
    }
    const float radius = 0.42f * shape.half_span, middle = shape.spring + 0.50f * shape.rise;
    for (int petal = 0; petal < 5; ++petal) {
        std::vector<vec3> ring;
        const float small = petal == 0 ? radius : 0.42f * radius, angle = 0.5f * pi * static_cast<float>(petal);
        const vec2 at = petal == 0 ? vec2(0.0f) : 0.55f * radius * vec2(std::cos(angle), std::sin(angle));
        for (int i = 0; i < 11; ++i) {
            const float turn = -2.0f * pi * static_cast<float>(i) / 11.0f;
            ring.push_back({at.x + small * std::cos(turn), middle + at.y + small * std::sin(turn), 0.0f});
        }
        add_sweep(mesh, ring, {0, 0, 1}, moulding(petal == 0 ? 0.13f : 0.07f), true, stone_light);
    }
}

Mesh arcade_bay_mesh() {
    Mesh mesh;
    const OpeningShape arch{0.5f * bay, gallery_floor - pier_height, 2.35f, 0.0f, 0.0f, 3.7f, 1.0f};
    add_wall_with_opening(mesh, arch, stone);
    for (const float side : {-1.0f, 1.0f}) {
        Mesh edge;
        add_mouldings(edge, arch, 0.44f, stone_warm);
        append(mesh, edge, placed(vec3(0.0f), side > 0.0f ? 0.0f : 180.0f));
    }
    return mesh;
}

Mesh upper_bay_mesh(std::uint32_t seed) {
    Mesh mesh;
    // A string course, a gallery of four small arches on colonnettes, another course.
    const float half = 0.5f * bay;
    const std::array<vec2, 5> course = {vec2(0, -0.14f), vec2(0.16f, -0.05f), vec2(0.20f, 0.05f), vec2(0.12f, 0.12f),
                                        vec2(0, 0.14f)};
    for (const float y : {gallery_floor + 0.15f, gallery_floor + 3.1f}) {
        const std::array<vec3, 2> along = {vec3(-half, y, 0.5f), vec3(half, y, 0.5f)};
        add_sweep(mesh, along, up, course, false, stone_light);
    }
    for (int k = 0; k < 4; ++k) {
        const float x = -2.1f + 1.4f * static_cast<float>(k);
        Mesh small;
        const OpeningShape arch{0.7f, 2.6f, 0.52f, 0.0f, 1.35f, 0.85f, 0.35f};
        add_wall_with_opening(small, arch, stone);
        add_mouldings(small, arch, 0.16f, stone_warm, 1);
        append(mesh, small, placed({x, gallery_floor + 0.30f, 0.32f}));
        for (const float side : {-0.6f, 0.6f})
            add_shaft(mesh, {x + side, 0.52f}, gallery_floor + 0.30f, gallery_floor + 1.72f, 0.065f, 6, stone_light);
    }
    add_box(mesh, {{-half, gallery_floor + 0.2f, -0.5f}, {-2.8f, gallery_floor + 3.0f, 0.45f}}, stone);
    add_box(mesh, {{2.8f, gallery_floor + 0.2f, -0.5f}, {half, gallery_floor + 3.0f, 0.45f}}, stone);
    add_quad(mesh, {-2.8f, gallery_floor + 0.2f, -0.45f}, {5.6f, 0, 0}, {0, 2.8f, 0}, stone_dark);
    add_quad(mesh, {-half, gallery_floor, 0.5f}, {bay, 0, 0}, {0, 0.35f, 0}, stone);
    // The clerestory.
    const float low = gallery_floor + 3.0f;
    Mesh clear;
    const OpeningShape window{half, 21.4f - low, 1.75f, 0.6f, 3.0f, 2.5f, 0.9f};
    add_wall_with_opening(clear, window, stone);
    add_mouldings(clear, window, 0.42f, stone_light);
    add_window(clear, window, 2, seed);
    append(mesh, clear, placed({0.0f, low, 0.0f}));
    // The shaft that carries the vault's ribs, on the bay's left border.
    for (const float x : {-0.22f, 0.0f, 0.22f})
        add_shaft(mesh, {-half + x, 0.55f + 0.10f * (0.22f - std::abs(x))}, pier_height, vault_spring, 0.12f, 8,
                  stone_light);
    return mesh;
}

Mesh aisle_bay_mesh(std::uint32_t seed) {
    Mesh mesh;
    const OpeningShape window{0.5f * bay, 10.8f, 1.35f, 2.6f, 6.0f, 2.2f, 1.0f};
    add_wall_with_opening(mesh, window, stone);
    add_mouldings(mesh, window, 0.47f, stone_light);
    add_window(mesh, window, 2, seed);
    add_box(mesh, {{-0.5f * bay, 0.0f, 0.5f}, {0.5f * bay, 0.5f, 0.85f}}, stone_dark);
    add_shaft(mesh, {-0.5f * bay, 0.55f}, 0.5f, aisle_spring, 0.17f, 14, stone_light);
    for (const float x : {-0.26f, 0.26f})
        add_shaft(mesh, {-0.5f * bay + x, 0.52f}, 0.5f, aisle_spring, 0.10f, 12, stone_warm);
    return mesh;
}

Mesh west_front_mesh() {
    Mesh mesh;
    // Towards +z in its own frame: the wall behind the nave with a door and a rose.
    const OpeningShape door{nave_half, 9.0f, 1.6f, 0.0f, 3.0f, 2.6f, 1.2f};
    add_wall_with_opening(mesh, door, stone);
    add_mouldings(mesh, door, 0.56f, stone_light);
    for (int plank = 0; plank < 12; ++plank) {
        const float x = -1.6f + 3.2f / 12.0f * static_cast<float>(plank);
        add_box(mesh, {{x + 0.01f, 0.0f, -0.2f}, {x + 3.2f / 12.0f - 0.01f, 5.7f, -0.1f}}, door_wood);
    }
    for (const float y : {0.8f, 2.4f}) add_box(mesh, {{-1.5f, y, -0.1f}, {1.5f, y + 0.12f, -0.06f}}, iron);
    add_rose(mesh);
    add_rose_tracery(mesh);
    add_quad(mesh, {-nave_half, 9.0f, -0.38f}, {2 * nave_half, 0, 0}, {0, 13.0f, 0}, lead);
    return mesh;
}

Mesh apse_mesh() {
    Mesh mesh;
    constexpr int sides = 5;
    const float facet_half = nave_half * std::tan(0.5f * pi / sides) + 0.02f;
    for (int k = 0; k < sides; ++k) {
        Mesh side;
        const OpeningShape window{facet_half, 21.6f, 1.0f, 3.4f, 11.5f, 1.9f, 0.9f};
        add_wall_with_opening(side, window, stone);
        add_mouldings(side, window, 0.42f, stone_light);
        add_window(side, window, 2, 870 + static_cast<std::uint32_t>(k));
        add_shaft(side, {-facet_half, 0.42f}, 0.3f, vault_spring, 0.16f, 14, stone_light);
        const float turn = -90.0f + (static_cast<float>(k) - 2.0f) * 180.0f / sides;
        append(mesh, side, placed({nave_end, 0, 0}, turn) * placed({0, 0, -nave_half - 0.45f}));
    }
    // Half a dome of webs, with ribs between.
    add_surface(
        mesh, {40, 16}, false,
        [](vec2 uv) {
            const float angle = pi * (0.5f - uv.x), out = uv.y * (nave_half + 0.1f);
            return vec3(nave_end + out * std::cos(angle), vault_spring + vault_rise * vault_profile(uv.y),
                        out * std::sin(angle));
        },
        vault);
    for (int k = 0; k <= sides; ++k) {
        const float angle = pi * (static_cast<float>(k) / sides - 0.5f);
        std::vector<vec3> path;
        for (int i = 0; i <= 16; ++i) {
            const float out = static_cast<float>(i) / 16.0f;
            path.push_back({nave_end + out * nave_half * std::cos(angle),
                            vault_spring + vault_rise * vault_profile(out) - 0.06f, out * nave_half * std::sin(angle)});
        }
        add_rib(mesh, path, {-std::sin(angle), 0.0f, std::cos(angle)}, 0.30f);
    }
    return mesh;
}

Mesh floor_mesh() {
    Mesh mesh;
    const float east = nave_end + nave_half + 0.5f;
    add_quad(mesh, {-nave_end - 0.7f, -0.03f, aisle_wall}, {east + nave_end + 0.7f, 0, 0}, {0, 0, -2 * aisle_wall},
             stone_dark);
    constexpr float tile = 0.75f;
    int row = 0;
    for (float z = -aisle_wall; z < aisle_wall - 0.1f; z += tile, ++row) {
        int column = 0;
        for (float x = -nave_end - 0.7f; x < east - 0.1f; x += tile, ++column) {
            const bool aisle = std::abs(z + 0.5f * tile) > nave_half - 0.8f, middle = std::abs(z + 0.5f * tile) < 1.4f;
            const bool odd = (row + column) % 2 != 0;
            const std::uint32_t tone = middle  ? (odd ? floor_red : floor_pale)
                                       : aisle ? (odd ? stone_dark : stone)
                                               : (odd ? floor_dark : floor_pale);
            add_tile(mesh, {{x + 0.004f, -0.03f, z + 0.004f}, {x + tile - 0.004f, 0.0f, z + tile - 0.004f}}, 0.008f,
                     tone);
        }
    }
    for (int step = 0; step < 3; ++step) {  // up to the altar
        const float x = nave_end - 4.5f + 0.45f * static_cast<float>(step), y = 0.16f * static_cast<float>(step + 1);
        add_box(mesh, {{x, 0.0f, -nave_half + 1.2f}, {east - 0.4f, y, nave_half - 1.2f}}, stone_light);
    }
    return mesh;
}

}  // namespace sightlines::cathedral
