#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_planes.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::planes {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float half_span = 0.5f * plane_span;

/// Radius of the fuselage over its length, nose at 1.
float hull_radius(float t) {
    const float nose = std::sqrt(std::max(1.0f - std::pow(std::max((t - 0.80f) / 0.20f, 0.0f), 2.0f), 0.0f));
    const float tail = std::pow(std::min(t / 0.42f, 1.0f), 0.8f);
    return 1.28f * nose * tail;
}

void add_hull(Mesh& mesh) {
    add_surface(
        mesh, {40, 60}, true,
        [](vec2 uv) {
            const float angle = -2.0f * pi * uv.x, radius = hull_radius(uv.y);
            const float rise = 0.75f * std::pow(1.0f - std::min(uv.y / 0.42f, 1.0f), 1.4f);
            return vec3(-10.2f + 19.8f * uv.y, rise + 1.08f * radius * std::sin(angle), radius * std::cos(angle));
        },
        paint_white);
    // A cheat line, cabin windows and the cockpit's panes by their place on the hull.
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const uvec3 corners = mesh.triangles[i];
        const vec3 middle = (mesh.positions[corners.x] + mesh.positions[corners.y] + mesh.positions[corners.z]) / 3.0f;
        if (middle.x > 7.0f && middle.x < 8.4f && middle.y > 0.35f && middle.y < 1.15f)
            mesh.materials[i] = glass_dark;
        else if (middle.y < -0.16f && middle.y > -0.62f && middle.x > -9.0f)
            mesh.materials[i] = paint_red;
        else if (middle.y < -0.62f)
            mesh.materials[i] = paint_grey;
    }
    for (int k = 0; k < 9; ++k)
        for (const float side : {-1.0f, 1.0f}) {
            const float x = -3.6f + 1.05f * static_cast<float>(k);
            const float z = side * 1.225f;
            add_box(
                mesh,
                {{x - 0.22f, 0.22f, std::min(z, z + 0.06f * side)}, {x + 0.22f, 0.68f, std::max(z, z + 0.06f * side)}},
                glass_dark);
        }
}

/// Half the chord, where its middle lies, and the height over the span, 0 at the root.
struct WingSection {
    float half_chord, middle_x, height;
};

void add_wing(Mesh& mesh, float reach, float thickness, const std::function<WingSection(float)>& section,
              std::uint32_t material) {
    constexpr int spans = 40;
    add_surface(
        mesh, {24, spans}, true,
        [&](vec2 uv) {
            const float along = 2.0f * uv.y - 1.0f, out = std::abs(along);
            const WingSection at = section(out);
            const float closing =
                uv.y <= 0.0f || uv.y >= 1.0f ? 0.0f : std::sqrt(std::max(1.0f - std::pow(out, 14.0f), 0.0f));
            const float angle = 2.0f * pi * uv.x;
            // A blunt leading edge towards +x, a sharp trailing one.
            const float shape = std::sin(angle) * (0.62f + 0.38f * std::cos(angle));
            return vec3(at.middle_x + closing * at.half_chord * std::cos(angle),
                        at.height + closing * thickness * at.half_chord * shape, reach * along);
        },
        material);
}

void add_fin(Mesh& mesh) {
    add_surface(
        mesh, {20, 14}, true,
        [](vec2 uv) {
            const float angle = -2.0f * pi * uv.x;
            const float closing = uv.y >= 1.0f ? 0.0f : std::sqrt(1.0f - std::pow(uv.y, 8.0f));
            const float half_chord = closing * (1.75f - 0.95f * uv.y);
            return vec3(-8.4f - 1.0f * uv.y + half_chord * std::cos(angle), 0.75f + 3.7f * uv.y,
                        0.11f * half_chord * std::sin(angle));
        },
        paint_red);
}

void add_engine(Mesh& mesh, float z) {
    Mesh nacelle;
    constexpr std::array<vec2, 10> profile = {
        vec2(0.0f, 0.0f),  vec2(0.28f, 0.5f),  vec2(0.55f, 1.4f),  vec2(0.78f, 2.6f), vec2(0.86f, 3.4f),
        vec2(0.86f, 4.3f), vec2(0.76f, 4.62f), vec2(0.60f, 4.66f), vec2(0.58f, 4.4f), vec2(0.0f, 4.38f)};
    add_revolution(nacelle, profile, 28, paint_grey);
    constexpr std::array<vec2, 4> spinner = {vec2(0.24f, 4.40f), vec2(0.24f, 4.75f), vec2(0.16f, 5.0f),
                                             vec2(0.0f, 5.12f)};
    add_revolution(nacelle, spinner, 16, paint_red);
    for (int k = 0; k < 3; ++k) {
        const float angle = 2.0f * pi * static_cast<float>(k) / 3.0f + z;
        const vec3 out(std::cos(angle), 0.0f, std::sin(angle)), side(-out.z, 0.0f, out.x);
        add_beam(nacelle, 0.2f * out + vec3(0.0f, 4.8f, 0.0f), 1.75f * out + vec3(0.0f, 4.8f, 0.0f), 0.05f, 0.26f,
                 paint_black, glm::normalize(side + vec3(0.0f, 0.6f, 0.0f)));
    }
    // Its axis along +x.
    append(mesh, nacelle, framed({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1.2f, -0.42f, z}));
}

}  // namespace

Mesh plane_mesh() {
    Mesh mesh;
    add_hull(mesh);
    add_wing(
        mesh, half_span, 0.15f,
        [](float out) {
            const float half_chord = 2.15f - 1.25f * std::pow(out, 1.15f);
            return WingSection{half_chord, 1.3f - 1.0f * out, -0.72f + 0.085f * half_span * out};
        },
        paint_white);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {  // red wing tips
        const vec3 corner = mesh.positions[mesh.triangles[i].x];
        if (std::abs(corner.z) > 0.84f * half_span) mesh.materials[i] = paint_red;
    }
    add_wing(
        mesh, 4.6f, 0.13f,
        [](float out) {
            return WingSection{1.25f - 0.6f * out, -8.9f - 0.4f * out, 0.72f + 0.1f * out};
        },
        paint_white);
    add_fin(mesh);
    for (const float side : {-1.0f, 1.0f}) add_engine(mesh, side * 4.7f);
    return mesh;
}

}  // namespace sightlines::planes
