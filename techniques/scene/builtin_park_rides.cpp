#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_blob.h"
#include "techniques/scene/builtin_park.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::park {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

float turn_of(int i, int count) { return 2.0f * pi * static_cast<float>(i) / static_cast<float>(count); }

/// A hoop of square section about z at `z`.
void add_hoop(Mesh& mesh, float radius, float z, float size, int segments, std::uint32_t material) {
    std::vector<vec3> path;
    for (int i = 0; i < segments; ++i) {
        const float angle = -turn_of(i, segments);
        path.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    const float h = 0.5f * size;
    add_sweep(mesh, path, {0, 0, 1}, std::array<vec2, 4>{vec2(-h, -h), vec2(h, -h), vec2(h, h), vec2(-h, h)}, true,
              material);
}

/// A cone of canvas about y in stripes, its hem scalloped.
void add_canopy(Mesh& mesh, float radius, float low, float high, int stripes, std::uint32_t first,
                std::uint32_t second) {
    constexpr int steps = 8;
    for (int k = 0; k < stripes; ++k) {
        const float from = turn_of(k, stripes), width = turn_of(1, stripes);
        add_surface(
            mesh, {4, steps}, false,
            [&](vec2 uv) {
                const float angle = -(from + uv.x * width), r = radius * (1.0f - 0.985f * uv.y);
                const float sag = 0.10f * radius * std::sin(pi * uv.y) * 0.5f;
                return vec3(r * std::cos(angle), low + (high - low) * uv.y - sag, r * std::sin(angle));
            },
            k % 2 == 0 ? first : second);
        add_surface(
            mesh, {6, 2}, false,
            [&](vec2 uv) {
                const float angle = -(from + uv.x * width), hem = 0.25f + 0.22f * std::sin(pi * uv.x);
                return vec3((radius + 0.01f) * std::cos(angle), low - hem * (1.0f - uv.y),
                            (radius + 0.01f) * std::sin(angle));
            },
            k % 2 == 0 ? second : first);
    }
}

}  // namespace

void add_bulb(LitMesh& lit, vec3 place, vec3 out, std::uint32_t bulb) {
    add_octahedron(lit.mesh, place + 0.05f * out, 0.055f, bulb);
    lit.lamps.push_back({place + 0.22f * out, bulb});
}

LitMesh wheel_mesh() {
    LitMesh wheel;
    Mesh& mesh = wheel.mesh;
    for (const float z : {-1.15f, 1.15f}) {
        add_hoop(mesh, wheel_radius, z, 0.20f, 96, steel_white);
        add_hoop(mesh, wheel_radius - 1.5f, z, 0.14f, 96, steel_white);
        add_hoop(mesh, 4.0f, z, 0.12f, 48, steel_blue);
        for (int k = 0; k < gondolas; ++k) {
            const float angle = turn_of(k, gondolas), next = turn_of(k + 1, gondolas);
            const vec3 out(std::cos(angle), std::sin(angle), 0), on(std::cos(next), std::sin(next), 0), side(0, 0, z);
            add_rod(mesh, 0.7f * out + side, wheel_radius * out + side, 0.055f, 6, steel_white);
            add_rod(mesh, wheel_radius * out + side, (wheel_radius - 1.5f) * on + side, 0.035f, 5, steel_blue);
            add_rod(mesh, (wheel_radius - 1.5f) * out + side, wheel_radius * on + side, 0.035f, 5, steel_blue);
            const vec3 outward(0, 0, z > 0.0f ? 1.0f : -1.0f);
            for (int i = 0; i < 20; ++i)
                add_bulb(wheel, (1.6f + 0.55f * static_cast<float>(i)) * out + side + 0.06f * outward, outward,
                         k % 3 == 0   ? bulb_red
                         : k % 3 == 1 ? bulb_warm
                                      : bulb_blue);
            for (int i = 0; i < 10; ++i) {
                const float at = angle + (next - angle) * (static_cast<float>(i) + 0.5f) / 10.0f;
                add_bulb(wheel, vec3(wheel_radius * std::cos(at), wheel_radius * std::sin(at), z) + 0.10f * outward,
                         outward, i % 2 == 0 ? bulb_warm : bulb_violet);
            }
        }
    }
    for (int k = 0; k < gondolas; ++k) {
        const float angle = turn_of(k, gondolas);
        const vec3 out(std::cos(angle), std::sin(angle), 0);
        add_rod(mesh, wheel_radius * out - vec3(0, 0, 1.2f), wheel_radius * out + vec3(0, 0, 1.2f), 0.06f, 6,
                steel_dark);
    }
    add_rod(mesh, {0, 0, -1.7f}, {0, 0, 1.7f}, 0.75f, 24, gold);
    return wheel;
}

Mesh wheel_stand_mesh() {
    Mesh mesh;
    for (const float z : {-1.75f, 1.75f}) {
        for (const float x : {-5.5f, 5.5f}) add_beam(mesh, {x, 0, 1.5f * z}, {0, wheel_hub, z}, 0.5f, 0.5f, steel_blue);
        for (const float y : {4.0f, 8.0f}) {
            const float x = 5.5f * (1.0f - y / wheel_hub), deep = z * (1.5f - 0.5f * y / wheel_hub);
            add_beam(mesh, {-x, y, deep}, {x, y, deep}, 0.25f, 0.25f, steel_white);
        }
    }
    add_rod(mesh, {0, wheel_hub, -2.3f}, {0, wheel_hub, 2.3f}, 0.32f, 18, steel_dark);
    add_box(mesh, {{-4.0f, 0, -2.2f}, {4.0f, 0.5f, 4.6f}}, timber);
    for (const float x : {-3.9f, 3.9f})
        for (float z = -1.8f; z < 4.6f; z += 0.8f) add_rod(mesh, {x, 0.5f, z}, {x, 1.5f, z}, 0.03f, 6, steel_white);
    for (const float x : {-3.9f, 3.9f}) add_rod(mesh, {x, 1.5f, -1.9f}, {x, 1.5f, 4.5f}, 0.04f, 6, steel_white);
    return mesh;
}

LitMesh gondola_mesh(std::uint32_t canvas) {
    LitMesh gondola;
    Mesh& mesh = gondola.mesh;
    constexpr std::array<vec2, 8> tub = {vec2(0.0f, -2.35f),  vec2(0.62f, -2.33f), vec2(0.80f, -2.20f),
                                         vec2(0.88f, -1.75f), vec2(0.92f, -1.70f), vec2(0.86f, -1.68f),
                                         vec2(0.78f, -2.10f), vec2(0.0f, -2.12f)};
    add_revolution(mesh, tub, 20, canvas);
    constexpr std::array<vec2, 7> band = {vec2(0.872f, -1.98f), vec2(0.91f, -1.96f), vec2(0.925f, -1.86f),
                                          vec2(0.90f, -1.84f),  vec2(0.88f, -1.84f), vec2(0.872f, -1.9f),
                                          vec2(0.87f, -1.97f)};
    add_revolution(mesh, band, 20, gold);
    add_canopy(mesh, 1.0f, -0.55f, -0.05f, 10, canvas, canvas_white);
    for (int k = 0; k < 4; ++k) {
        const float angle = turn_of(k, 4) + 0.4f;
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        add_rod(mesh, 0.84f * out + vec3(0, -1.72f, 0), 0.84f * out + vec3(0, -0.50f, 0), 0.025f, 6, steel_white);
    }
    for (int k = 0; k < 8; ++k) {
        const float angle = turn_of(k, 8);
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        add_bulb(gondola, 1.03f * out + vec3(0, -0.62f, 0), out, k % 2 == 0 ? bulb_warm : bulb_green);
    }
    return gondola;
}

LitMesh carousel_mesh() {
    LitMesh carousel;
    Mesh& mesh = carousel.mesh;
    const float r = carousel_radius;
    const std::array<vec2, 6> platform = {vec2(r, 0.12f), vec2(r + 0.08f, 0.2f), vec2(r + 0.08f, 0.42f),
                                          vec2(r, 0.48f), vec2(1.2f, 0.48f),     vec2(1.2f, 0.3f)};
    add_revolution(mesh, platform, 64, timber);
    constexpr std::array<vec2, 14> pillar = {
        vec2(1.35f, 0.48f), vec2(1.35f, 0.8f), vec2(1.15f, 0.9f), vec2(1.05f, 1.2f), vec2(1.05f, 2.8f),
        vec2(1.2f, 2.95f),  vec2(1.3f, 3.2f),  vec2(1.1f, 3.3f),  vec2(1.1f, 3.9f),  vec2(1.6f, 4.2f),
        vec2(1.9f, 4.35f),  vec2(1.9f, 4.45f), vec2(0.2f, 4.5f),  vec2(0.0f, 4.5f)};
    add_revolution(mesh, pillar, 16, gold);
    add_canopy(mesh, r + 0.35f, 4.25f, 7.2f, 24, canvas_red, canvas_white);
    for (int k = 0; k < 24; ++k) {
        const float angle = turn_of(k, 24);
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        add_rod(mesh, 1.1f * out + vec3(0, 4.0f, 0), (r + 0.3f) * out + vec3(0, 4.15f, 0), 0.04f, 5, gold);
        if (k % 3 == 0)
            add_rod(mesh, (r - 0.1f) * out + vec3(0, 0.48f, 0), (r - 0.1f) * out + vec3(0, 4.2f, 0), 0.05f, 8, gold);
        for (int i = 0; i < 10; ++i)
            add_bulb(carousel, (1.8f + 0.44f * static_cast<float>(i)) * out + vec3(0, 3.93f, 0), {0, -1, 0},
                     i % 2 == 0 ? bulb_warm : bulb_white);
        for (int i = 0; i < 8; ++i) {
            const float at = angle + turn_of(1, 24) * static_cast<float>(i) / 8.0f;
            const vec3 rim(std::cos(at), 0, std::sin(at));
            add_bulb(carousel, (r + 0.40f) * rim + vec3(0, 4.30f, 0), rim, i % 2 == 0 ? bulb_warm : bulb_red);
        }
        // Mirrors and shields on the pillar.
        add_octahedron(mesh, 1.1f * out + vec3(0, 2.0f, 0), 0.18f, canvas_blue);
    }
    add_ball(mesh, {0, 7.35f, 0}, vec3(0.28f), 18, gold);
    return carousel;
}

Mesh horse_mesh(std::uint32_t coat) {
    std::vector<RoundCone> cones = {{{-0.42f, 1.30f, 0}, {0.34f, 1.32f, 0}, 0.225f, 0.215f, 0},
                                    {{0.36f, 1.36f, 0}, {0.66f, 1.78f, 0}, 0.19f, 0.115f, 0},
                                    {{0.68f, 1.86f, 0}, {0.98f, 1.66f, 0}, 0.105f, 0.062f, 0},
                                    {{0.62f, 1.96f, -0.05f}, {0.60f, 2.04f, -0.06f}, 0.036f, 0.03f, 0},
                                    {{0.62f, 1.96f, 0.05f}, {0.60f, 2.04f, 0.06f}, 0.036f, 0.03f, 0},
                                    {{-0.55f, 1.42f, 0}, {-0.85f, 1.30f, 0}, 0.07f, 0.08f, 0},
                                    {{-0.85f, 1.30f, 0}, {-0.98f, 0.92f, 0}, 0.08f, 0.05f, 0}};
    for (const float z : {-0.12f, 0.12f}) {
        const float lead = z > 0.0f ? 0.10f : -0.06f;
        const vec3 shoulder(0.36f, 1.18f, z), knee(0.68f + lead, 0.96f + 0.5f * lead, z),
            hoof(0.56f + 1.6f * lead, 0.66f, z);
        const vec3 hip(-0.42f, 1.20f, z), hock(-0.66f - lead, 0.86f, z), rear(-0.92f - 1.2f * lead, 0.62f, z);
        cones.push_back({shoulder, knee, 0.11f, 0.065f, 0});
        cones.push_back({knee, hoof, 0.066f, 0.052f, 0});
        cones.push_back({hip, hock, 0.14f, 0.065f, 0});
        cones.push_back({hock, rear, 0.066f, 0.052f, 0});
    }
    Mesh mesh = blob_mesh(cones, 0.05f, 0.052f, [coat](vec3 p) -> std::uint32_t {
        if (p.x > -0.22f && p.x < 0.20f && p.y > 1.36f) return saddle_red;
        if (p.x > -0.26f && p.x < 0.24f && p.y > 1.24f) return gold;
        const bool mane = p.x > 0.28f && p.x < 0.66f && p.y > 1.52f + 0.95f * (p.x - 0.36f) + 0.10f;
        if (mane || p.x < -0.64f || p.y < 0.72f) return coat == horse_black ? horse_white : horse_black;
        return coat;
    });
    add_rod(mesh, {0, 0.1f, 0}, {0, 3.3f, 0}, 0.028f, 8, gold);
    return mesh;
}

Mesh swing_mast_mesh() {
    Mesh mesh;
    constexpr std::array<vec2, 10> profile = {
        vec2(2.6f, 0),     vec2(2.6f, 0.35f), vec2(2.4f, 0.45f), vec2(1.0f, 0.5f),  vec2(0.9f, 1.6f),
        vec2(0.62f, 2.0f), vec2(0.5f, 5.5f),  vec2(0.58f, 5.8f), vec2(0.45f, 6.0f), vec2(0.4f, swing_height - 0.4f)};
    add_revolution(mesh, profile, 24, steel_blue);
    for (int k = 0; k < 12; ++k) {
        const float angle = turn_of(k, 12);
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        add_beam(mesh, 0.62f * out + vec3(0, 1.9f, 0), 0.54f * out + vec3(0, 5.6f, 0), 0.06f, 0.06f, gold);
    }
    return mesh;
}

LitMesh swing_crown_mesh() {
    LitMesh crown;
    Mesh& mesh = crown.mesh;
    const float r = swing_crown;
    const std::array<vec2, 8> ring = {vec2(0.35f, -0.4f),   vec2(0.8f, -0.5f),      vec2(r - 0.3f, -0.15f),
                                      vec2(r, -0.05f),      vec2(r + 0.05f, 0.25f), vec2(r, 0.55f),
                                      vec2(r - 0.2f, 0.6f), vec2(0.0f, 0.6f)};
    add_revolution(mesh, ring, 48, canvas_white);
    add_canopy(mesh, r + 0.02f, 0.62f, 2.4f, 24, canvas_blue, canvas_yellow);
    for (int k = 0; k < 24; ++k) {
        const float angle = turn_of(k, 24);
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        for (int i = 0; i < 8; ++i)
            add_bulb(crown,
                     (1.0f + 0.44f * static_cast<float>(i)) * out + vec3(0, -0.50f + 0.045f * static_cast<float>(i), 0),
                     {0, -1, 0}, i % 2 == 0 ? bulb_violet : bulb_warm);
        for (int i = 0; i < 5; ++i) {
            const float at = angle + turn_of(1, 24) * static_cast<float>(i) / 5.0f;
            const vec3 rim(std::cos(at), 0, std::sin(at));
            add_bulb(crown, (r + 0.04f) * rim + vec3(0, 0.25f, 0), rim, i % 2 == 0 ? bulb_green : bulb_warm);
        }
    }
    add_ball(mesh, {0, 2.5f, 0}, vec3(0.25f), 16, gold);
    return crown;
}

Mesh swing_seat_mesh(std::uint32_t paint) {
    Mesh mesh;
    for (const float x : {-0.25f, 0.25f})
        for (const float z : {-0.18f, 0.20f})
            add_rod(mesh, {0.4f * x, 0, 0}, {x, -4.1f + (z > 0.0f ? 0.35f : 0.0f), z}, 0.012f, 4, steel_dark);
    add_cushion(mesh, {{-0.27f, -4.55f, -0.24f}, {0.27f, -4.45f, 0.22f}}, 0.04f, 3, paint);
    add_cushion(mesh, {{-0.27f, -4.50f, 0.16f}, {0.27f, -3.75f, 0.24f}}, 0.035f, 3, paint);
    for (const float x : {-0.25f, 0.25f}) add_rod(mesh, {x, -4.2f, -0.22f}, {x, -4.2f, 0.20f}, 0.02f, 6, steel_white);
    // Somebody rides: trunk, head and legs.
    const std::array<RoundCone, 4> rider = {RoundCone{{0, -4.36f, 0.04f}, {0, -3.95f, 0.08f}, 0.14f, 0.13f, 0},
                                            RoundCone{{0, -3.68f, 0.06f}, {0, -3.66f, 0.06f}, 0.10f, 0.10f, 0},
                                            RoundCone{{-0.09f, -4.36f, 0}, {-0.09f, -4.36f, -0.36f}, 0.075f, 0.06f, 0},
                                            RoundCone{{0.09f, -4.36f, 0}, {0.09f, -4.36f, -0.36f}, 0.075f, 0.06f, 0}};
    const Mesh body = blob_mesh(rider, 0.06f, 0.06f, [paint](vec3 p) -> std::uint32_t {
        return p.y > -3.80f   ? horse_brown
               : p.y > -4.30f ? (paint == canvas_red ? canvas_green : canvas_white)
                              : train_black;
    });
    append(mesh, body, mat4(1.0f));
    return mesh;
}

LitMesh engine_mesh() {
    LitMesh engine;
    Mesh& mesh = engine.mesh;
    add_box(mesh, {{-1.6f, 0.38f, -0.62f}, {1.6f, 0.62f, 0.62f}}, train_black);
    Mesh boiler;
    constexpr std::array<vec2, 12> profile = {vec2(0.0f, -0.55f), vec2(0.52f, -0.55f), vec2(0.52f, 0.2f),
                                              vec2(0.55f, 0.22f), vec2(0.55f, 0.28f),  vec2(0.52f, 0.30f),
                                              vec2(0.52f, 1.05f), vec2(0.56f, 1.07f),  vec2(0.56f, 1.38f),
                                              vec2(0.48f, 1.46f), vec2(0.2f, 1.52f),   vec2(0.0f, 1.53f)};
    add_revolution(boiler, profile, 28, train_red);
    append(mesh, boiler, framed({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 1.14f, 0}));
    Mesh funnel;
    constexpr std::array<vec2, 9> stack = {vec2(0.16f, 0),     vec2(0.13f, 0.1f),  vec2(0.13f, 0.45f),
                                           vec2(0.20f, 0.6f),  vec2(0.27f, 0.78f), vec2(0.27f, 0.84f),
                                           vec2(0.20f, 0.86f), vec2(0.12f, 0.7f),  vec2(0.0f, 0.7f)};
    add_revolution(funnel, stack, 20, train_black);
    append(mesh, funnel, placed({1.1f, 1.58f, 0}));
    constexpr std::array<vec2, 5> dome = {vec2(0.22f, 0), vec2(0.22f, 0.15f), vec2(0.18f, 0.26f), vec2(0.08f, 0.34f),
                                          vec2(0.0f, 0.35f)};
    Mesh cap;
    add_revolution(cap, dome, 18, gold);
    append(mesh, cap, placed({0.45f, 1.62f, 0}));
    // The cab.
    add_box(mesh, {{-1.6f, 0.62f, -0.62f}, {-1.52f, 1.35f, 0.62f}}, train_red);
    for (const float z : {-0.62f, 0.56f}) {
        add_box(mesh, {{-1.52f, 0.62f, z}, {-0.55f, 1.25f, z + 0.06f}}, train_red);
        for (const float x : {-1.56f, -0.60f})
            add_rod(mesh, {x, 1.25f, z + 0.03f}, {x, 2.15f, z + 0.03f}, 0.03f, 6, gold);
    }
    add_cushion(mesh, {{-1.8f, 2.15f, -0.78f}, {-0.4f, 2.25f, 0.78f}}, 0.04f, 3, train_black);
    for (const float z : {-0.66f, 0.66f})
        for (const float x : {-1.1f, -0.2f, 0.7f}) {
            add_rod(mesh, {x, 0.36f, z - 0.05f}, {x, 0.36f, z + 0.05f}, 0.34f, 20, train_black);
            add_rod(mesh, {x, 0.36f, z - 0.06f}, {x, 0.36f, z + 0.06f}, 0.10f, 10, gold);
        }
    for (int i = 0; i < 12; ++i) {
        const float z = i % 2 == 0 ? -0.82f : 0.82f, x = -1.7f + 0.25f * static_cast<float>(i / 2);
        add_bulb(engine, {x, 2.14f, z}, {0, 0, z > 0.0f ? 1.0f : -1.0f}, bulb_warm);
    }
    add_bulb(engine, {1.56f, 1.35f, 0}, {1, 0, 0}, bulb_white);
    return engine;
}

LitMesh wagon_mesh(std::uint32_t paint) {
    LitMesh wagon;
    Mesh& mesh = wagon.mesh;
    add_box(mesh, {{-1.4f, 0.36f, -0.6f}, {1.4f, 0.46f, 0.6f}}, train_black);
    for (const float z : {-0.62f, 0.56f}) add_box(mesh, {{-1.4f, 0.46f, z}, {1.4f, 0.95f, z + 0.06f}}, paint);
    for (const float x : {-1.4f, 1.34f}) add_box(mesh, {{x, 0.46f, -0.56f}, {x + 0.06f, 1.15f, 0.56f}}, paint);
    for (const float x : {-1.0f, 0.0f, 1.0f}) {
        add_cushion(mesh, {{x - 0.22f, 0.46f, -0.54f}, {x + 0.22f, 0.72f, 0.54f}}, 0.05f, 3, timber_dark);
        add_cushion(mesh, {{x - 0.28f, 0.6f, -0.54f}, {x - 0.18f, 1.15f, 0.54f}}, 0.04f, 3, timber_dark);
    }
    for (const float z : {-0.59f, 0.59f}) {
        for (const float x : {-1.36f, -0.45f, 0.45f, 1.36f})
            add_rod(mesh, {x, 0.95f, z}, {x, 2.0f, z}, 0.025f, 6, gold);
        for (const float x : {-0.9f, 0.9f})
            add_rod(mesh, {x, 0.26f, 1.1f * z - 0.04f}, {x, 0.26f, 1.1f * z + 0.04f}, 0.26f, 18, train_black);
    }
    for (int k = 0; k < 8; ++k) {  // a striped awning
        const float x = -1.5f + 0.375f * static_cast<float>(k);
        add_surface(
            mesh, {1, 10}, false,
            [x](vec2 uv) { return vec3(x + 0.375f * uv.x, 2.0f + 0.24f * std::sin(pi * uv.y), 0.75f - 1.5f * uv.y); },
            k % 2 == 0 ? paint : canvas_white);
    }
    for (int i = 0; i < 14; ++i) {
        const float z = i % 2 == 0 ? -0.76f : 0.76f, x = -1.35f + 0.45f * static_cast<float>(i / 2);
        add_bulb(wagon, {x, 1.98f, z}, {0, 0, z > 0.0f ? 1.0f : -1.0f}, i % 4 < 2 ? bulb_warm : bulb_green);
    }
    return wagon;
}

}  // namespace sightlines::park
