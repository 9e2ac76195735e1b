#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_garden.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines::garden {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr vec3 up(0.0f, 1.0f, 0.0f);

}  // namespace

Mesh hedge_mesh(const HedgeShape& shape, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const float half = 0.5f * shape.length_m, side = 0.5f * shape.width_m;
    // The core is a little within, so that the leaves round off its edges.
    const float inset = 0.3f * shape.leaf_m;
    add_box(mesh, {{-half + inset, 0.0f, -side + inset}, {half - inset, shape.height_m - inset, side - inset}},
            hedge_core);
    const Box3 clipped{{-half, 0.03f, -side}, {half, shape.height_m, side}};
    const float area = shape.length_m * shape.width_m + 2.0f * shape.height_m * (shape.length_m + shape.width_m);
    LeafCover cover;
    cover.count = static_cast<std::uint32_t>(area * static_cast<float>(shape.leaves_per_m2));
    cover.length_m = shape.leaf_m;
    cover.lift_m = 0.4f * shape.leaf_m;
    cover.first = shape.first_tone;
    add_leaf_cover(mesh, cover, draws, [&](Draws& d) {
        SurfaceSpot spot = spot_on_box(clipped, d);
        spot.point -= inset * spot.normal;
        return spot;
    });
    return mesh;
}

Mesh cone_topiary_mesh(float radius_m, float height_m, std::uint32_t leaves, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const std::array<vec2, 3> core = {vec2(0.9f * radius_m, 0.02f), vec2(0.88f * radius_m, 0.06f),
                                      vec2(0.0f, 0.96f * height_m)};
    add_revolution(mesh, core, 20, hedge_core);
    LeafCover cover;
    cover.count = leaves;
    cover.length_m = 0.085f;
    cover.lift_m = 0.03f;
    cover.first = yew_dark;
    add_leaf_cover(mesh, cover, draws, [=](Draws& d) { return spot_on_cone(vec3(0.0f), radius_m, height_m, d); });
    return mesh;
}

Mesh ball_topiary_mesh(float radius_m, std::uint32_t leaves, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const vec3 middle(0.0f, 0.95f * radius_m, 0.0f), radii(radius_m, 0.95f * radius_m, radius_m);
    add_ball(mesh, middle, 0.93f * radii, 20, hedge_core);
    LeafCover cover;
    cover.count = leaves;
    cover.length_m = 0.085f;
    cover.lift_m = 0.03f;
    cover.first = box_dark;
    add_leaf_cover(mesh, cover, draws, [=](Draws& d) { return spot_on_ball(middle, 0.97f * radii, d); });
    return mesh;
}

Mesh cypress_mesh(std::uint32_t leaves, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const float height = 7.4f;
    const auto radius_at = [](float t) {
        return 0.95f * std::pow(std::max(1.0f - t, 0.0f), 0.75f) * std::min(1.0f, 0.55f + 3.0f * t);
    };
    std::vector<vec2> core = {vec2(0.14f, 0.0f), vec2(0.14f, 0.5f)};
    for (int i = 0; i <= 10; ++i) {
        const float t = static_cast<float>(i) / 10.0f;
        core.push_back({0.80f * radius_at(t) + (i == 10 ? 0.0f : 0.01f), 0.5f + t * (height - 0.7f)});
    }
    add_revolution(mesh, core, 12, hedge_core);
    LeafCover cover;
    cover.count = leaves;
    cover.length_m = 0.24f;
    cover.width_share = 0.34f;
    cover.lift_m = 0.10f;
    cover.steepness = 0.5f;
    cover.first = yew_dark;
    add_leaf_cover(mesh, cover, draws, [&](Draws& d) {
        const float t = 1.0f - std::sqrt(d.unit()), azimuth = 2.0f * pi * d.unit();
        const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth));
        const float bulge = 0.86f + 0.16f * smooth_noise({3.0f * azimuth, 9.0f * t}, seed);
        return SurfaceSpot{bulge * radius_at(t) * outward + (0.45f + t * (height - 0.5f)) * up,
                           glm::normalize(outward + 0.35f * up)};
    });
    return mesh;
}

Mesh flower_mesh(std::uint32_t first_tone, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const float height = draws.between(0.22f, 0.38f), lean = draws.between(0.0f, 0.25f);
    const vec3 top(lean * height, height, 0.0f);
    const vec3 along = glm::normalize(top);
    add_leaf(mesh, vec3(0.0f), along, {0.0f, 0.0f, 1.0f}, height, 0.018f, stem);
    for (int k = 0; k < 3; ++k) {
        const float azimuth = 2.1f * static_cast<float>(k) + draws.between(0.0f, 1.5f);
        const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth));
        const vec3 direction = glm::normalize(outward + draws.between(0.5f, 1.2f) * up);
        add_leaf(mesh, 0.1f * height * static_cast<float>(k) * up, direction, {-outward.z, 0.0f, outward.x},
                 draws.between(0.14f, 0.22f), 0.055f, box_mid + static_cast<std::uint32_t>(k % 2));
    }
    const std::uint32_t tone = first_tone + draws.below(3);
    const int petals = 6;
    const float size = draws.between(0.065f, 0.095f);
    for (int k = 0; k < petals; ++k) {
        const float azimuth = 2.0f * pi * static_cast<float>(k) / petals + draws.between(-0.1f, 0.1f);
        const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth));
        const vec3 direction = glm::normalize(outward + draws.between(0.25f, 0.7f) * up);
        add_leaf(mesh, top, direction, {-outward.z, 0.0f, outward.x}, size, 0.8f * size, tone);
    }
    return mesh;
}

Mesh vine_mesh(std::uint32_t leaves, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const float end = 0.5f * walk * static_cast<float>(columns_each_row - 1);
    const float roof = column_height + 0.5f;
    LeafCover cover;
    cover.count = leaves;
    cover.length_m = 0.20f;
    cover.width_share = 0.75f;
    cover.lift_m = 0.14f;
    cover.steepness = 0.5f;
    cover.first = vine_dark;
    add_leaf_cover(mesh, cover, draws, [&](Draws& d) {
        for (;;) {  // gaps where the noise is low
            const vec2 place(d.between(-end - 0.3f, end + 0.3f), d.between(back_row_z - 0.3f, front_row_z + 0.3f));
            if (smooth_noise(place * 0.45f, 77) < 0.40f && d.unit() < 0.92f) continue;
            const float hang = d.unit() < 0.16f ? d.unit() * d.unit() * 0.9f : 0.0f;
            return SurfaceSpot{{place.x, roof - hang, place.y},
                               glm::normalize(up + 0.3f * vec3(d.unit() - 0.5f, 0.0f, d.unit() - 0.5f))};
        }
    });
    // Stems wind up every second column of the front row.
    for (int i = 0; i < columns_each_row; i += 2) {
        const float x = -end + walk * static_cast<float>(i);
        std::vector<TubeRing> rings;
        for (int k = 0; k <= 24; ++k) {
            const float t = static_cast<float>(k) / 24.0f, angle = 7.5f * t + static_cast<float>(i);
            rings.push_back(
                {{x + 0.25f * std::cos(angle), t * (column_height + 0.45f), front_row_z + 0.25f * std::sin(angle)},
                 0.035f - 0.018f * t});
            if (k < 6 || k % 2 == 0) continue;
            const vec3 outward(std::cos(angle), 0.2f, std::sin(angle));
            for (int n = 0; n < 5; ++n) {
                const vec3 direction = glm::normalize(outward + 0.8f * sphere_direction(draws.unit(), draws.unit()));
                const vec3 side = glm::normalize(glm::cross(direction, up) + vec3(0.01f, 0.0f, 0.0f));
                add_leaf(mesh, rings.back().centre, direction, side, draws.between(0.12f, 0.2f), 0.11f,
                         vine_dark + draws.below(3));
            }
        }
        add_tube(mesh, rings, 6, timber);
    }
    return mesh;
}

Mesh lawn_blades_mesh(std::uint32_t blades, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    for (std::uint32_t i = 0; i < blades;) {
        const vec2 place(draws.between(-half_x, half_x), draws.between(-half_z, half_z));
        if (!on_lawn(place)) continue;
        ++i;
        const float azimuth = 2.0f * pi * draws.unit();
        const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth));
        const vec3 direction = glm::normalize(up + draws.between(0.2f, 1.1f) * outward);
        add_leaf(mesh, {place.x, -0.01f, place.y}, direction, {-outward.z, 0.0f, outward.x},
                 draws.between(0.06f, 0.12f), 0.018f, blade_dark + draws.below(3));
    }
    return mesh;
}

}  // namespace sightlines::garden
