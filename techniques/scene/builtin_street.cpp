// The built-in street: old houses over shops, a terrace, cobbles, trees; a cross street with a fountain.
#include "techniques/scene/builtin_street.h"

#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_models.h"
#include "techniques/scene/builtin_posed.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines {
namespace {

using namespace street;

constexpr double duration_s = 24.0;
constexpr float half_street = 9.0f, half_road = 4.4f;  ///< to the houses, to the kerbs
constexpr float near_end = 32.0f, far_end = -56.0f;
constexpr float cross_near = -10.0f, cross_far = -22.0f, half_cross = 27.0f;

/// The road, and the cross street from house to house.
bool on_road(vec2 place) {
    const bool cross = place.y < cross_near - 2.0f && place.y > cross_far + 2.0f && std::abs(place.x) < half_cross;
    return cross || (std::abs(place.x) < half_road && place.y < near_end && place.y > far_end);
}

bool in_street(vec2 place) {
    const bool cross = place.y < cross_near && place.y > cross_far && std::abs(place.x) < half_cross;
    return cross || (std::abs(place.x) < half_street && place.y < near_end && place.y > far_end);
}

/// One of three tones from `first`, in loose patches.
std::uint32_t toned(std::uint32_t first, vec2 place, Draws& draws) {
    const float tone = 0.55f * smooth_noise(0.3f * place, 17) + 0.45f * draws.unit();
    return first + (tone < 0.42f ? 0u : tone < 0.66f ? 1u : 2u);
}

/// Stones in rows, each row shifted against the one before.
Mesh cobbles_mesh() {
    Mesh mesh;
    Draws draws{1201};
    constexpr float across = 0.125f, along = 0.165f;
    int row = 0;
    for (float z = far_end; z < near_end; z += across, ++row)
        for (float x = -half_cross + 0.5f * along * static_cast<float>(row % 2); x < half_cross; x += along) {
            const vec2 size = vec2(along, across) - vec2(draws.between(0.01f, 0.03f), draws.between(0.01f, 0.025f));
            if (!on_road({x, z}) || !on_road({x + size.x, z + size.y})) continue;
            // A gutter at the kerbs.
            const float to_kerb = half_road - std::abs(x);
            const float gutter = to_kerb > 0.0f ? 0.02f * std::exp(-2.0f * to_kerb) : 0.0f;
            const float top = draws.between(-0.008f, 0.006f) - gutter;
            add_tile(mesh, {{x, top - 0.05f, z}, {x + size.x, top, z + size.y}}, 0.018f, toned(cobble, {x, z}, draws));
        }
    return mesh;
}

Mesh pavements_mesh() {
    Mesh mesh;
    Draws draws{1202};
    add_quad(mesh, {-half_cross, -0.035f, near_end}, {2.0f * half_cross, 0.0f, 0.0f}, {0.0f, 0.0f, far_end - near_end},
             joint);
    constexpr float size = 0.55f, high = 0.13f;
    for (float z = far_end; z < near_end; z += size)
        for (float x = -half_cross; x < half_cross; x += size) {
            const vec2 low(x, z), high_corner(x + size, z + size);
            const auto paved = [](vec2 place) { return in_street(place) && !on_road(place); };
            if (!paved(low) || !paved(high_corner) || !paved({x + size, z}) || !paved({x, z + size})) continue;
            add_tile(mesh, {{x + 0.004f, -0.03f, z + 0.004f}, {x + size - 0.004f, high, z + size - 0.004f}}, 0.008f,
                     toned(slab, low, draws));
        }
    const auto kerbs = [&](vec2 from, vec2 to) {
        const int stones = static_cast<int>(std::lround(glm::distance(from, to)));
        const vec2 along = (to - from) / static_cast<float>(stones);
        const vec2 wide = 0.15f * vec2(along.x == 0.0f ? 1.0f : 0.0f, along.x == 0.0f ? 0.0f : 1.0f);
        for (int i = 0; i < stones; ++i) {
            const vec2 a = from + static_cast<float>(i) * along, b = a + 0.985f * along;
            const vec2 low = glm::min(a, b) - wide, high_corner = glm::max(a, b) + wide;
            add_tile(mesh, {{low.x, -0.05f, low.y}, {high_corner.x, 0.14f, high_corner.y}}, 0.025f, kerb);
        }
    };
    for (const float side : {-1.0f, 1.0f}) {
        kerbs({side * half_road, cross_near - 2.0f}, {side * half_road, near_end});
        kerbs({side * half_road, far_end}, {side * half_road, cross_far + 2.0f});
        kerbs({side * half_road, cross_near - 2.0f}, {side * half_cross, cross_near - 2.0f});
        kerbs({side * half_road, cross_far + 2.0f}, {side * half_cross, cross_far + 2.0f});
    }
    return mesh;
}

/// Houses side by side from `from` to `to` along z, their fronts at x = -side * half_street facing the road.
void add_row(PartBuilder& builder, float side, float from, float to, bool near_corner, Draws& draws) {
    const int count = static_cast<int>(std::lround((to - from) / 8.6f));
    float at = from;
    for (int i = 0; i < count; ++i) {
        const float left = static_cast<float>(count - i);
        const float width = i + 1 == count ? to - at : (to - at) / left * draws.between(0.86f, 1.14f);
        HouseShape shape;
        shape.width_m = width;
        shape.upper_floors = 3 + static_cast<int>(draws.below(3));
        shape.wall = first_wall + draws.below(wall_tones);
        shape.shutter = first_shutter + draws.below(shutter_tones);
        shape.canvas = canvas_red + draws.below(2);
        shape.ivy = draws.unit() < 0.17f;
        const bool corner = near_corner ? i == 0 : i + 1 == count;
        // The side that looks into the cross street: towards -z where the row begins there, +z where it ends.
        shape.left_front = corner && (side > 0.0f) == near_corner;
        shape.right_front = corner && (side > 0.0f) != near_corner;
        const mat4 place = placed({side * half_street, 0.0f, at + 0.5f * width}, side > 0.0f ? 270.0f : 90.0f);
        builder.add(house_mesh(shape, 1300 + draws.below(100000)), "house", {place});
        at += width;
    }
}

void add_houses(PartBuilder& builder) {
    Draws draws{1210};
    for (const float side : {-1.0f, 1.0f}) {
        add_row(builder, side, cross_near, near_end, true, draws);
        add_row(builder, side, far_end, cross_far, false, draws);
        HouseShape closing;
        closing.width_m = cross_near - cross_far;
        closing.upper_floors = 4;
        closing.wall = first_wall + draws.below(wall_tones);
        closing.shutter = first_shutter + draws.below(shutter_tones);
        builder.add(house_mesh(closing, 1290 + (side > 0.0f ? 1u : 0u)), "house",
                    {placed({side * half_cross, 0.0f, 0.5f * (cross_near + cross_far)}, side > 0.0f ? 270.0f : 90.0f)});
    }
    for (const float end : {near_end, far_end})
        for (const float side : {-1.0f, 1.0f}) {
            HouseShape closing;
            closing.width_m = half_street;
            closing.upper_floors = 4 + static_cast<int>(draws.below(2));
            closing.wall = first_wall + draws.below(wall_tones);
            closing.shutter = first_shutter + draws.below(shutter_tones);
            builder.add(house_mesh(closing, 1280 + draws.below(1000)), "house",
                        {placed({0.5f * side * half_street, 0.0f, end}, end > 0.0f ? 180.0f : 0.0f)});
        }
}

void add_terrace(PartBuilder& builder) {
    Draws draws{1220};
    constexpr std::uint32_t kinds = 6;
    std::array<std::vector<mat4>, kinds> tables;
    std::vector<mat4> chairs;
    std::array<std::vector<mat4>, 2> parasols;
    constexpr float ground = 0.13f;
    const auto set_table = [&](vec2 place) {
        tables[draws.below(kinds)].push_back(placed({place.x, ground, place.y}, draws.between(0.0f, 360.0f)));
        const std::uint32_t seats = 2 + draws.below(3);
        const float first = draws.between(0.0f, 360.0f);
        for (std::uint32_t i = 0; i < seats; ++i) {
            const float turn = first + 360.0f * static_cast<float>(i) / static_cast<float>(seats);
            const mat4 seat = placed({place.x, ground, place.y}, turn + draws.between(-14.0f, 14.0f));
            chairs.push_back(seat * placed({0.0f, 0.0f, -draws.between(0.56f, 0.72f)}));
        }
    };
    // Two terraces: at the cross street's corner on the left, and a smaller one on the right.
    for (int i = 0; i < 9; ++i)
        for (const float x : {-7.0f, -5.4f})
            set_table({x + draws.between(-0.15f, 0.15f), -7.4f + 1.9f * static_cast<float>(i)});
    for (int i = 0; i < 5; ++i) set_table({6.2f + draws.between(-0.3f, 0.3f), 9.0f + 2.1f * static_cast<float>(i)});
    for (int i = 0; i < 5; ++i)
        parasols[0].push_back(
            placed({-6.2f, ground, -6.4f + 3.8f * static_cast<float>(i)}, draws.between(0.0f, 45.0f)));
    for (int i = 0; i < 2; ++i)
        parasols[1].push_back(placed({6.9f, ground, 10.0f + 4.2f * static_cast<float>(i)}, draws.between(0.0f, 45.0f)));
    for (std::uint32_t k = 0; k < kinds; ++k) builder.add(table_mesh(1230 + k), "table", tables[k]);
    builder.add(chair_mesh(), "chair", chairs);
    builder.add(parasol_mesh(canvas_red), "parasol", parasols[0]);
    builder.add(parasol_mesh(canvas_green), "parasol", parasols[1]);
}

void add_street_life(PartBuilder& builder) {
    Draws draws{1240};
    constexpr float ground = 0.13f;
    std::vector<mat4> lamps;
    for (int i = 0; i < 9; ++i)
        for (const float side : {-1.0f, 1.0f}) {
            const float z = 27.0f - 9.6f * static_cast<float>(i) - (side > 0.0f ? 4.8f : 0.0f);
            if (z < cross_near && z > cross_far) continue;
            if (z < far_end + 2.0f) continue;
            lamps.push_back(placed({side * (half_road + 0.5f), ground, z}, 90.0f));
        }
    builder.add(lamp_mesh(), "lamp", lamps);
    std::array<std::vector<mat4>, 3> trees, bicycles, planters;
    for (int i = 0; i < 5; ++i) {
        const float z = 22.2f - 9.6f * static_cast<float>(i);
        if (z < cross_near && z > cross_far) continue;
        trees[draws.below(3)].push_back(
            placed({half_road + 1.3f, ground, z + 2.4f}, draws.between(0.0f, 360.0f), draws.between(0.85f, 1.05f)));
    }
    for (int i = 0; i < 4; ++i)
        for (const float side : {-1.0f, 1.0f})
            trees[draws.below(3)].push_back(
                placed({side * (half_road + 1.3f), ground, -26.0f - 8.0f * static_cast<float>(i)},
                       draws.between(0.0f, 360.0f), draws.between(0.85f, 1.05f)));
    for (std::uint32_t k = 0; k < 3; ++k) {
        TreeShape shape;
        shape.height_m = 8.0f;
        shape.crown_radius_m = 2.3f;
        shape.leaves = 20000;
        shape.leaf_length_m = 0.17f;
        shape.bark = bark;
        shape.first_leaf = leaf_dark;
        builder.add(tree_mesh(shape, 1250 + k), "tree", trees[k]);
    }
    for (int i = 0; i < 9; ++i)
        bicycles[draws.below(3)].push_back(placed({8.1f, ground, -1.5f + 0.62f * static_cast<float>(i)},
                                                  draws.between(-6.0f, 6.0f) + (i % 3 == 0 ? 180.0f : 0.0f)));
    for (std::uint32_t k = 0; k < 3; ++k) builder.add(bicycle_mesh(paint_red + k), "bicycle", bicycles[k]);
    for (int i = 0; i < 12; ++i)
        for (const float side : {-1.0f, 1.0f}) {
            const float z = 29.0f - 7.3f * static_cast<float>(i);
            if (z < cross_near + 1.0f && z > cross_far - 1.0f) continue;
            if (z < far_end + 1.0f) continue;
            planters[draws.below(3)].push_back(placed({side * 8.35f, ground, z}, draws.between(0.0f, 360.0f)));
        }
    for (std::uint32_t k = 0; k < 3; ++k) builder.add(planter_mesh(1260 + k), "planter", planters[k]);
    builder.add(fountain_mesh(), "fountain", {placed({0.0f, -0.02f, 0.5f * (cross_near + cross_far)})});
    for (int i = 0; i < 6; ++i) {
        const float z = 22.0f - 5.0f * static_cast<float>(i), lean = draws.between(-2.5f, 2.5f);
        builder.add(string_of_lights_mesh({-half_street + 0.2f, 7.4f, z}, {half_street - 0.2f, 7.4f, z + lean}),
                    "lights");
    }
}

std::vector<Camera> cameras() {
    Camera walk{"default", CameraKind::perspective, {1.6f, 1.75f, 16.5f}, {-1.6f, 3.6f, -12.0f}};
    walk.vertical_field_of_view_deg = 58.0f;
    Camera terrace{"terrace", CameraKind::perspective, {-3.1f, 1.7f, 3.2f}, {-6.9f, 1.1f, -4.5f}};
    terrace.vertical_field_of_view_deg = 52.0f;
    Camera roofs{"roofs", CameraKind::perspective, {13.0f, 31.0f, 34.0f}, {-2.0f, 5.0f, -14.0f}};
    roofs.vertical_field_of_view_deg = 48.0f;
    return {walk, terrace, roofs};
}

PosableScene made_street() {
    PosableScene made;
    made.rest.materials = street::materials();
    PartBuilder builder{made.rest};
    builder.add(cobbles_mesh(), "cobbles");
    builder.add(pavements_mesh(), "pavement");
    add_houses(builder);
    add_terrace(builder);
    add_street_life(builder);
    made.rest.cameras = cameras();
    made.rest.light_volume = {{-8.5f, 2.0f, far_end + 2.0f}, {8.5f, 13.0f, near_end - 2.0f}};
    SunArc sun;
    sun.irradiance = {5.0f, 4.3f, 3.4f};
    sun.first_azimuth_deg = 52.0f;
    sun.last_azimuth_deg = 128.0f;
    sun.lowest_elevation_deg = 44.0f;
    sun.highest_elevation_deg = 58.0f;
    sun.duration_s = duration_s;
    made.rest.lights = {sun_light(sun, 0.0)};
    const std::vector<Light> sky = sky_lights(48, {0.95f, 1.25f, 1.7f});
    made.rest.lights.insert(made.rest.lights.end(), sky.begin(), sky.end());
    made.pose = [sun](Scene& scene, double time_s) { scene.lights[0] = sun_light(sun, time_s); };
    return made;
}

}  // namespace

SceneModel street_model() {
    return posed_model("street", "An old street of shops, balconies and café tables, under a moving sun.", duration_s,
                       made_street);
}

}  // namespace sightlines
