#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_atrium.h"

namespace sightlines::atrium {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

void add_box(Mesh& mesh, vec3 lowest, vec3 highest, std::uint32_t material) {
    sightlines::add_box(mesh, Box3{lowest, highest}, material);
}

/// A quarter round from `from` to `to`, bulging outwards (or hollow), as profile points.
void add_moulding(std::vector<vec2>& profile, vec2 to, float bulge, int steps) {
    const vec2 from = profile.back(), along = to - from;
    const vec2 outward(along.y, -along.x);
    for (int i = 1; i <= steps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps);
        profile.push_back(from + t * along + bulge * std::sin(pi * t) * outward);
    }
}

/// One stone of an arch's ring: between radii and angles, standing out from `low_z` to `high_z` on both sides.
void add_voussoir(Mesh& mesh, vec2 radii, vec2 angles, vec2 depths, bool front_only, std::uint32_t material) {
    constexpr int steps = 3;
    for (int k = 0; k < steps; ++k) {
        const auto at = [&](int step, float radius, float z) {
            const float angle = angles.x + (angles.y - angles.x) * static_cast<float>(step) / steps;
            return vec3(radius * std::cos(angle), radius * std::sin(angle), z);
        };
        const auto quad = [&](vec3 a, vec3 b, vec3 c, vec3 d) { add_polygon(mesh, std::array{a, b, c, d}, material); };
        const float back = depths.x, front = depths.y;
        quad(at(k, radii.x, front), at(k, radii.y, front), at(k + 1, radii.y, front), at(k + 1, radii.x, front));
        quad(at(k, radii.y, front), at(k, radii.y, back), at(k + 1, radii.y, back), at(k + 1, radii.y, front));
        quad(at(k, radii.x, back), at(k, radii.x, front), at(k + 1, radii.x, front), at(k + 1, radii.x, back));
        if (!front_only)
            quad(at(k, radii.y, back), at(k, radii.x, back), at(k + 1, radii.x, back), at(k + 1, radii.y, back));
    }
}

/// Courses of dressed stone over a wall face; each block its own tone.
void add_ashlar(Mesh& mesh, vec3 corner, vec3 edge_u, vec3 edge_v, std::uint32_t seed) {
    const ivec2 blocks(std::lround(glm::length(edge_u) / 1.2f), std::lround(glm::length(edge_v) / 0.5f));
    add_quad(mesh, corner, edge_u, edge_v, blocks, [seed](ivec2 block) {
        const float tone = random_unit(seed, static_cast<std::uint32_t>(block.x), static_cast<std::uint32_t>(block.y));
        return static_cast<std::uint32_t>(tone < 0.5f ? plaster : tone < 0.8f ? plaster_warm : plaster_pale);
    });
}

/// A frame of four boxes around the court: from `inner` (half sizes at the court) to `outer`, between two heights.
void add_frame(Mesh& mesh, vec2 inner, vec2 outer, float low, float high, std::uint32_t material) {
    for (const float side : {-1.0f, 1.0f}) {
        const vec2 z = side > 0.0f ? vec2(inner.y, outer.y) : vec2(-outer.y, -inner.y);
        add_box(mesh, {-outer.x, low, z.x}, {outer.x, high, z.y}, material);
        const vec2 x = side > 0.0f ? vec2(inner.x, outer.x) : vec2(-outer.x, -inner.x);
        add_box(mesh, {x.x, low, -inner.y}, {x.y, high, inner.y}, material);
    }
}

}  // namespace

Mesh column_mesh() {
    Mesh mesh;
    add_box(mesh, {-0.42f, 0.0f, -0.42f}, {0.42f, 0.16f, 0.42f}, limestone_dark);
    std::vector<vec2> base = {{0.40f, 0.16f}};
    add_moulding(base, {0.38f, 0.28f}, 0.35f, 4);
    base.push_back({0.34f, 0.30f});
    add_moulding(base, {0.33f, 0.38f}, -0.20f, 3);
    add_moulding(base, {0.32f, 0.45f}, 0.40f, 4);
    base.push_back({0.28f, 0.48f});
    add_revolution(mesh, base, 24, limestone_light);
    std::vector<vec2> shaft;
    for (int i = 0; i <= 5; ++i) {  // the slight swelling of a classical shaft
        const float t = static_cast<float>(i) / 5.0f;
        shaft.push_back({0.275f - 0.045f * t * t, 0.48f + 2.32f * t});
    }
    add_revolution(mesh, shaft, 24, limestone);
    std::vector<vec2> neck = {{0.23f, 2.80f}, {0.26f, 2.80f}};
    add_moulding(neck, {0.26f, 2.87f}, 0.5f, 3);
    neck.push_back({0.235f, 2.87f});
    add_revolution(mesh, neck, 24, limestone_light);
    // The bell of the capital, its rim drawn out to eight leaves in two rows.
    add_surface(
        mesh, {40, 8}, true,
        [](vec2 uv) {
            const float angle = -2.0f * pi * uv.x, t = uv.y;
            const float row = t < 0.5f ? 2.0f * t : 2.0f * t - 1.0f;
            const float leaf = 0.5f + 0.5f * std::cos(8.0f * angle + (t < 0.5f ? 0.0f : pi));
            const float radius = 0.235f + 0.12f * t * t + 0.055f * leaf * row * row;
            return vec3(radius * std::cos(angle), 2.87f + 0.45f * t, radius * std::sin(angle));
        },
        limestone_light);
    add_box(mesh, {-0.40f, 3.30f, -0.40f}, {0.40f, 3.38f, 0.40f}, limestone_light);
    add_box(mesh, {-0.44f, 3.38f, -0.44f}, {0.44f, column_height, 0.44f}, limestone_dark);
    return mesh;
}

Mesh pier_mesh() {
    Mesh mesh;
    const auto course = [&](float half, float low, float high, std::uint32_t material) {
        add_box(mesh, {-half, low, -half}, {half, high, half}, material);
    };
    course(0.46f, 0.0f, 0.25f, limestone_dark);
    course(0.42f, 0.25f, 0.40f, limestone_light);
    for (int i = 0; i < 7; ++i) {
        const float low = 0.40f + 0.40f * static_cast<float>(i);
        course(0.37f, low, low + 0.40f, i % 2 == 0 ? limestone : limestone_light);
    }
    course(0.41f, 3.20f, 3.34f, limestone_light);
    course(0.46f, 3.34f, column_height, limestone_dark);
    course(0.34f, column_height, arcade_top + 0.01f, limestone);  // where the walls of two sides meet
    return mesh;
}

Mesh arch_mesh() {
    constexpr float half_depth = 0.28f, proud = 0.05f, ring = 0.34f;
    constexpr float height = arcade_top - column_height;
    constexpr int stones = 17;
    Mesh mesh;
    for (int i = 0; i < stones; ++i) {
        const float step = pi / stones, first = step * static_cast<float>(i);
        add_voussoir(mesh, {arch_radius, arch_radius + ring}, {first, first + step},
                     {-half_depth - proud, half_depth + proud}, false, i % 2 == 0 ? limestone_light : brick_red);
    }
    // The spandrels: from the ring's middle out to the panel's border, both faces.
    std::vector<float> angles;
    for (int i = 0; i <= 36; ++i) angles.push_back(pi * static_cast<float>(i) / 36.0f);
    const float corner = std::atan2(height, 0.5f * bay);
    angles.insert(angles.end(), {corner, pi - corner});
    std::sort(angles.begin(), angles.end());
    const auto border = [&](float angle) {
        const float c = std::cos(angle), s = std::sin(angle);
        const float reach = std::min(0.5f * bay / std::max(std::abs(c), 1e-6f), height / std::max(s, 1e-6f));
        return vec2(reach * c, reach * s);
    };
    const float inner = arch_radius + 0.5f * ring;
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
        const vec2 a = inner * vec2(std::cos(angles[i]), std::sin(angles[i])), b = border(angles[i]);
        const vec2 d = inner * vec2(std::cos(angles[i + 1]), std::sin(angles[i + 1])), c = border(angles[i + 1]);
        add_polygon(mesh,
                    std::array{vec3(a, half_depth), vec3(b, half_depth), vec3(c, half_depth), vec3(d, half_depth)},
                    limestone);
        add_polygon(mesh,
                    std::array{vec3(d, -half_depth), vec3(c, -half_depth), vec3(b, -half_depth), vec3(a, -half_depth)},
                    limestone);
    }
    return mesh;
}

Mesh blind_arch_mesh(std::uint32_t panel_material) {
    constexpr float radius = 0.95f, ring = 0.24f, spring = 2.6f, proud = 0.10f;
    constexpr int stones = 13;
    Mesh mesh;
    Mesh arch;
    for (int i = 0; i < stones; ++i) {
        const float step = pi / stones, first = step * static_cast<float>(i);
        add_voussoir(arch, {radius, radius + ring}, {first, first + step}, {0.0f, proud}, true,
                     i % 2 == 0 ? limestone_light : limestone_dark);
    }
    constexpr int panel_steps = 26;
    for (int i = 0; i < panel_steps; ++i) {
        const float a = pi * static_cast<float>(i) / panel_steps, b = pi * static_cast<float>(i + 1) / panel_steps;
        add_polygon(arch,
                    std::array{vec3(0.0f, 0.0f, 0.02f), vec3(radius * std::cos(a), radius * std::sin(a), 0.02f),
                               vec3(radius * std::cos(b), radius * std::sin(b), 0.02f)},
                    panel_material);
    }
    append(mesh, arch, placed({0.0f, spring, 0.0f}));
    add_quad(mesh, {-radius, 0.0f, 0.02f}, {2.0f * radius, 0.0f, 0.0f}, {0.0f, spring, 0.0f}, panel_material);
    for (const float side : {-1.0f, 1.0f}) {
        const float x = side * (radius + 0.5f * ring);
        add_box(mesh, {x - 0.5f * ring, 0.0f, 0.0f}, {x + 0.5f * ring, spring - 0.12f, proud}, limestone_light);
        add_box(mesh, {x - 0.6f * ring, spring - 0.12f, 0.0f}, {x + 0.6f * ring, spring, proud + 0.03f},
                limestone_dark);
    }
    return mesh;
}

Mesh balustrade_mesh() {
    constexpr float half = 0.5f * bay - 0.37f;
    constexpr int count = 7;
    Mesh mesh;
    add_box(mesh, {-half, 0.0f, -0.14f}, {half, 0.12f, 0.14f}, limestone_dark);
    add_box(mesh, {-half, 0.84f, -0.15f}, {half, 0.98f, 0.15f}, limestone_light);
    std::vector<vec2> profile = {{0.085f, 0.12f}, {0.085f, 0.17f}, {0.045f, 0.20f}};
    add_moulding(profile, {0.04f, 0.58f}, 0.17f, 5);
    add_moulding(profile, {0.07f, 0.80f}, -0.05f, 1);
    profile.push_back({0.085f, 0.84f});
    Mesh baluster;
    add_revolution(baluster, profile, 8, marble);
    for (int i = 0; i < count; ++i) {
        const float x = half * (2.0f * (static_cast<float>(i) + 0.5f) / count - 1.0f);
        append(mesh, baluster, placed({x, 0.0f, 0.0f}));
    }
    return mesh;
}

Mesh floor_mesh() {
    Mesh mesh;
    constexpr float edge_x = court_x - 0.55f, edge_z = court_z - 0.55f;
    // Bedding under everything, then the court's paving: 40 x 14 bevelled tiles with a border of marble.
    constexpr float bedding = court_floor - 0.02f;
    add_quad(mesh, {-edge_x, bedding, -edge_z}, {0.0f, 0.0f, 2.0f * edge_z}, {2.0f * edge_x, 0.0f, 0.0f},
             limestone_dark);
    const ivec2 tiles(40, 14);
    const vec2 size(2.0f * edge_x / static_cast<float>(tiles.x), 2.0f * edge_z / static_cast<float>(tiles.y));
    for (int j = 0; j < tiles.y; ++j) {
        for (int i = 0; i < tiles.x; ++i) {
            const bool border = i == 1 || i == tiles.x - 2 || j == 1 || j == tiles.y - 2;
            const std::uint32_t tone =
                random_u32(17, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)) % 3u;
            const vec3 low(-edge_x + static_cast<float>(i) * size.x, bedding, -edge_z + static_cast<float>(j) * size.y);
            add_tile(
                mesh,
                {low + vec3(0.008f, 0.0f, 0.008f), {low.x + size.x - 0.008f, court_floor, low.z + size.y - 0.008f}},
                0.015f, border ? static_cast<std::uint32_t>(marble) : tile_a + tone);
        }
    }
    // The arcades' floors, a step above the court and on the upper slab, in a chequer of two stones.
    const auto chequer = [](ivec2 cell) {
        return static_cast<std::uint32_t>((cell.x + cell.y) % 2 == 0 ? limestone_light : tile_b);
    };
    const auto arcade = [&](float height, vec2 inner) {
        const vec2 outer(wall_x + wall_thickness, wall_z + wall_thickness), depth = outer - inner;
        for (const float side : {-1.0f, 1.0f}) {
            const float z = side > 0.0f ? inner.y : -outer.y, x = side > 0.0f ? inner.x : -outer.x;
            add_quad(mesh, {-outer.x, height, z}, {0.0f, 0.0f, depth.y}, {2.0f * outer.x, 0.0f, 0.0f}, {8, 55},
                     chequer);
            add_quad(mesh, {x, height, -inner.y}, {0.0f, 0.0f, 2.0f * inner.y}, {depth.x, 0.0f, 0.0f}, {13, 8},
                     chequer);
        }
    };
    arcade(0.0f, {edge_x, edge_z});
    arcade(upper_floor + 0.01f, {court_x + 0.2f, court_z + 0.2f});
    const vec3 riser(0.0f, -bedding, 0.0f);
    for (const float side : {-1.0f, 1.0f}) {
        add_quad(mesh, {side * edge_x, bedding, side * edge_z}, {-2.0f * side * edge_x, 0.0f, 0.0f}, riser,
                 limestone_light);
        add_quad(mesh, {side * edge_x, bedding, -side * edge_z}, {0.0f, 0.0f, 2.0f * side * edge_z}, riser,
                 limestone_light);
    }
    return mesh;
}

Mesh walls_mesh() {
    Mesh mesh;
    constexpr float ox = wall_x + wall_thickness, oz = wall_z + wall_thickness;
    // Inner faces, seen from the galleries, and outer faces, each up to just under the sloping roof.
    constexpr float top = roof_top - 0.3f, outer_top = roof_top - 0.08f;
    for (const float side : {-1.0f, 1.0f}) {
        const auto seed = static_cast<std::uint32_t>(side + 2.0f);
        add_ashlar(mesh, {side * wall_x, 0.0f, side * wall_z}, {-2.0f * side * wall_x, 0.0f, 0.0f}, {0.0f, top, 0.0f},
                   seed);
        add_ashlar(mesh, {side * wall_x, 0.0f, -side * wall_z}, {0.0f, 0.0f, 2.0f * side * wall_z}, {0.0f, top, 0.0f},
                   seed + 4);
        add_ashlar(mesh, {-side * ox, 0.0f, side * oz}, {2.0f * side * ox, 0.0f, 0.0f}, {0.0f, outer_top, 0.0f},
                   seed + 8);
        add_ashlar(mesh, {side * ox, 0.0f, side * oz}, {0.0f, 0.0f, -2.0f * side * oz}, {0.0f, outer_top, 0.0f},
                   seed + 12);
    }
    for (const float floor : {0.0f, upper_floor})  // skirting
        add_frame(mesh, {wall_x - 0.06f, wall_z - 0.06f}, {wall_x + 0.1f, wall_z + 0.1f}, floor, floor + 0.3f,
                  limestone_dark);
    return mesh;
}

Mesh slabs_mesh() {
    Mesh mesh;
    const vec2 wall(wall_x + 0.1f, wall_z + 0.1f);
    const auto around = [](float offset) { return vec2(court_x + offset, court_z + offset); };
    add_frame(mesh, around(-0.30f), wall, arcade_top, upper_floor, limestone_light);
    add_frame(mesh, around(-0.30f), wall, upper_top, upper_top + 0.2f, wood);
    // Cornices towards the court: three steps each.
    add_frame(mesh, around(-0.38f), around(-0.20f), arcade_top - 0.10f, upper_floor - 0.22f, limestone_dark);
    add_frame(mesh, around(-0.46f), around(-0.20f), upper_floor - 0.22f, upper_floor - 0.02f, limestone_light);
    add_frame(mesh, around(-0.40f), around(-0.20f), upper_top - 0.10f, upper_top + 0.12f, limestone_dark);
    add_frame(mesh, around(-0.50f), around(-0.20f), upper_top + 0.12f, upper_top + 0.26f, limestone_light);
    return mesh;
}

Mesh beams_mesh() {
    Mesh mesh;
    for (const float top : {arcade_top, upper_top}) {
        const float low = top - 0.26f;
        for (const float side : {-1.0f, 1.0f}) {
            for (int i = 0; i <= 2 * bays_x; ++i) {
                const float x = -court_x + 0.5f * bay * static_cast<float>(i);
                const vec2 z =
                    side > 0.0f ? vec2(court_z + 0.25f, wall_z + 0.1f) : vec2(-wall_z - 0.1f, -court_z - 0.25f);
                add_box(mesh, {x - 0.1f, low, z.x}, {x + 0.1f, top + 0.05f, z.y}, wood_dark);
            }
            for (int i = 0; i <= 2 * bays_z; ++i) {
                const float z = -court_z + 0.5f * bay * static_cast<float>(i);
                const vec2 x =
                    side > 0.0f ? vec2(court_x + 0.25f, wall_x + 0.1f) : vec2(-wall_x - 0.1f, -court_x - 0.25f);
                add_box(mesh, {x.x, low, z - 0.1f}, {x.y, top + 0.05f, z + 0.1f}, wood_dark);
            }
        }
    }
    return mesh;
}

Mesh roof_mesh() {
    // Four slopes with rows of rounded tiles, mitred at the corners: down towards the court.
    Mesh mesh;
    const vec2 inner(court_x - 0.75f, court_z - 0.75f), outer(wall_x + 0.75f, wall_z + 0.75f);
    const auto slope = [&](float inner_half, float outer_half, float inner_out, float outer_out, float turn_deg) {
        Mesh one;
        const int rows = static_cast<int>(std::lround(2.0f * outer_half / 0.34f));
        add_surface(
            one, {rows * 4, 2}, false,
            [=](vec2 uv) {
                const float x = (2.0f * uv.x - 1.0f) * (inner_half + (outer_half - inner_half) * uv.y);
                const float wave = 0.05f * std::abs(std::sin(pi * uv.x * static_cast<float>(rows)));
                return vec3(x, eaves + (roof_top - eaves) * uv.y + wave, -(inner_out + (outer_out - inner_out) * uv.y));
            },
            roof_tile);
        append(mesh, one, placed(vec3(0.0f), turn_deg));
    };
    slope(inner.x, outer.x, inner.y, outer.y, 0.0f);
    slope(inner.x, outer.x, inner.y, outer.y, 180.0f);
    slope(inner.y, outer.y, inner.x, outer.x, 90.0f);
    slope(inner.y, outer.y, inner.x, outer.x, 270.0f);
    return mesh;
}

}  // namespace sightlines::atrium
