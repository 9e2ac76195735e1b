// The built-in garden: parterres with box hedges and flowers, a fountain, a colonnade before a palace.
#include "techniques/scene/builtin_garden.h"

#include <array>
#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_models.h"
#include "techniques/scene/builtin_posed.h"
#include "techniques/scene/builtin_shapes.h"

namespace sightlines {
namespace {

using namespace garden;

constexpr float pi = std::numbers::pi_v<float>;
constexpr double duration_s = 24.0;

/// A bed: a rectangle with a hedge round it and a diamond of hedges within.
struct Bed {
    vec2 middle, half;
    std::array<std::uint32_t, 2> colours;  ///< inside the diamond, outside
};

constexpr std::array<Bed, 4> beds = {{
    {{-12.0f, 7.6f}, {7.4f, 4.6f}, {red_deep, white_pure}},
    {{12.0f, 7.6f}, {7.4f, 4.6f}, {violet_deep, yellow_deep}},
    {{-12.0f, -5.6f}, {7.4f, 2.6f}, {violet_deep, yellow_deep}},
    {{12.0f, -5.6f}, {7.4f, 2.6f}, {red_deep, white_pure}},
}};

/// 0 in a bed's middle, 1 on its diamond's edge.
float diamond(const Bed& bed, vec2 place) {
    const vec2 away = glm::abs(place - bed.middle) / (bed.half - 0.55f);
    return away.x + away.y;
}

mat4 along(vec2 from, vec2 to) {
    const vec2 middle = 0.5f * (from + to), step = to - from;
    return placed({middle.x, 0.0f, middle.y}, glm::degrees(std::atan2(-step.y, step.x)));
}

void add_hedge(Mesh& mesh, vec2 from, vec2 to, std::uint32_t seed) {
    constexpr float width = 0.42f;
    const HedgeShape shape{glm::distance(from, to) + width, width, 0.46f, 0.085f, 92, box_dark};
    append(mesh, hedge_mesh(shape, seed), along(from, to));
}

Mesh bed_mesh(const Bed& bed, std::uint32_t seed) {
    Mesh mesh;
    const vec2 low = bed.middle - bed.half, high = bed.middle + bed.half;
    const float rim = 0.07f;
    add_box(mesh, {{low.x - 0.36f, -0.1f, low.y - 0.36f}, {high.x + 0.36f, 0.05f, high.y + 0.36f}}, kerb);
    add_box(mesh, {{low.x - 0.24f, 0.0f, low.y - 0.24f}, {high.x + 0.24f, rim, high.y + 0.24f}}, soil);
    std::array<vec2, 4> corners = {low, vec2(high.x, low.y), high, vec2(low.x, high.y)};
    for (std::size_t i = 0; i < 4; ++i)
        add_hedge(mesh, corners[i], corners[(i + 1) % 4], seed + static_cast<std::uint32_t>(i));
    const vec2 reach = bed.half - 0.55f;
    const std::array<vec2, 4> tips = {bed.middle - vec2(reach.x, 0.0f), bed.middle - vec2(0.0f, reach.y),
                                      bed.middle + vec2(reach.x, 0.0f), bed.middle + vec2(0.0f, reach.y)};
    for (std::size_t i = 0; i < 4; ++i)
        add_hedge(mesh, tips[i], tips[(i + 1) % 4], seed + 4 + static_cast<std::uint32_t>(i));
    return mesh;
}

/// Flowers in loose rows, each compartment in its colour.
Mesh flowers_mesh(const Bed& bed, std::uint32_t seed) {
    constexpr std::uint32_t kinds = 12;
    std::array<std::vector<Mesh>, 2> flowers;
    for (std::size_t side = 0; side < 2; ++side)
        for (std::uint32_t k = 0; k < kinds; ++k)
            flowers[side].push_back(flower_mesh(bed.colours[side], 300 + kinds * static_cast<std::uint32_t>(side) + k));
    Mesh mesh;
    Draws draws{seed};
    constexpr float spacing = 0.262f;
    const vec2 inner = bed.half - 0.42f;
    for (float z = -inner.y; z <= inner.y; z += spacing) {
        for (float x = -inner.x; x <= inner.x; x += spacing) {
            const vec2 jitter = 0.4f * spacing * vec2(draws.between(-1, 1), draws.between(-1, 1));
            const vec2 place = bed.middle + vec2(x, z) + jitter;
            const float ring = diamond(bed, place);
            const float hedge = 0.36f * (1.0f / (bed.half.x - 0.55f) + 1.0f / (bed.half.y - 0.55f));
            const vec2 from_middle = place - bed.middle;
            const float turn = draws.between(0.0f, 360.0f), scale = draws.between(1.15f, 1.6f);
            const std::uint32_t kind = draws.below(kinds);
            if (std::abs(ring - 1.0f) < hedge || glm::length(from_middle) < 0.85f) continue;
            append(mesh, flowers[ring < 1.0f ? 0 : 1][kind], placed({place.x, 0.07f, place.y}, turn, scale));
        }
    }
    return mesh;
}

void add_beds(PartBuilder& builder) {
    for (std::uint32_t i = 0; i < beds.size(); ++i) {
        builder.add(bed_mesh(beds[i], 200 + 10 * i), "bed with box hedges");
        builder.add(flowers_mesh(beds[i], 260 + i), "flowers");
    }
    std::vector<mat4> cones, balls;
    for (const Bed& bed : beds) {
        cones.push_back(placed({bed.middle.x, 0.05f, bed.middle.y}, 40.0f * bed.middle.x));
        for (const float x : {-1.0f, 1.0f})
            for (const float z : {-1.0f, 1.0f}) {
                const vec2 corner = bed.middle + vec2(x, z) * (bed.half + 0.0f);
                balls.push_back(placed({corner.x, 0.36f, corner.y}, 70.0f * corner.x + 31.0f * corner.y));
            }
    }
    builder.add(cone_topiary_mesh(0.75f, 2.3f, 1500, 401), "clipped yew", cones);
    builder.add(ball_topiary_mesh(0.44f, 700, 402), "clipped box", balls);
}

void add_surroundings(PartBuilder& builder) {
    builder.add(ground_mesh(), "ground");
    builder.add(lawn_blades_mesh(7000, 410), "lawn");
    Mesh hedges;
    const auto tall = [&](vec2 from, vec2 to, std::uint32_t seed) {
        const HedgeShape shape{glm::distance(from, to) + 1.1f, 1.1f, 2.6f, 0.17f, 38, yew_dark};
        append(hedges, hedge_mesh(shape, seed), along(from, to));
    };
    const float x = half_x - 0.9f, z = half_z - 0.9f;
    tall({-x, palace_z + 1.2f}, {-x, -1.9f}, 421);
    tall({-x, 1.9f}, {-x, z}, 422);
    tall({x, palace_z + 1.2f}, {x, -1.9f}, 423);
    tall({x, 1.9f}, {x, z}, 424);
    tall({-x, z}, {-2.4f, z}, 425);
    tall({2.4f, z}, {x, z}, 426);
    builder.add(hedges, "tall hedges");
    std::vector<mat4> cypresses;
    for (int i = 0; i < 5; ++i)
        for (const float side : {-1.0f, 1.0f}) {
            const float spot = -6.0f + 4.6f * static_cast<float>(i);
            const auto key = static_cast<std::uint32_t>(i);
            cypresses.push_back(placed({side * 21.0f, 0.0f, spot + 0.6f}, 77.0f * spot + 40.0f * side,
                                       0.78f + 0.3f * random_unit(12, key, side > 0.0f ? 1 : 0)));
        }
    builder.add(cypress_mesh(1900, 430), "cypress", cypresses);
}

void add_stone(PartBuilder& builder) {
    std::vector<mat4> columns, bays;
    for (int i = 0; i < columns_each_row; ++i) {
        const float x = walk * (static_cast<float>(i) - 0.5f * static_cast<float>(columns_each_row - 1));
        columns.push_back(placed({x, 0.0f, front_row_z}));
        columns.push_back(placed({x, 0.0f, back_row_z}));
    }
    for (int i = 0; i < 16; ++i) bays.push_back(placed({walk * (static_cast<float>(i) - 7.5f), 0.0f, palace_z}));
    builder.add(column_mesh(), "column", columns);
    builder.add(pergola_mesh(), "pergola");
    builder.add(vine_mesh(10500, 440), "vine");
    builder.add(palace_bay_mesh(), "palace", bays);
    builder.add(fountain_mesh(), "fountain");
    std::vector<mat4> urns, plants, benches;
    for (int k = 0; k < 8; ++k) {
        const float angle = 0.25f * pi * (static_cast<float>(k) + 0.5f);
        urns.push_back(placed({5.0f * std::cos(angle), 0.02f, 4.6f * std::sin(angle)}, 45.0f * static_cast<float>(k)));
    }
    for (const float x : {-17.5f, -9.0f, 9.0f, 17.5f}) benches.push_back(placed({x, 0.0f, 12.75f}));
    for (const float x : {-6.0f, 0.0f, 6.0f}) benches.push_back(placed({x, 0.0f, palace_z + 0.75f}));
    for (const mat4& urn : urns) plants.push_back(urn * placed({0.0f, 1.66f, 0.0f}, 0.0f, 0.95f));
    builder.add(urn_mesh(), "urn", urns);
    builder.add(ball_topiary_mesh(0.40f, 620, 450), "box in an urn", plants);
    builder.add(bench_mesh(), "bench", benches);
}

std::vector<Camera> cameras() {
    Camera terrace{"default", CameraKind::perspective, {19.5f, 10.5f, 15.0f}, {1.2f, -0.6f, -1.6f}};
    terrace.vertical_field_of_view_deg = 44.0f;
    Camera walk_view{"colonnade", CameraKind::perspective, {-21.4f, 1.75f, -12.3f}, {0.0f, 1.2f, -11.4f}};
    walk_view.vertical_field_of_view_deg = 60.0f;
    Camera flowers{"flowers", CameraKind::perspective, {-3.4f, 2.3f, 12.9f}, {-11.6f, -0.3f, 6.0f}};
    flowers.vertical_field_of_view_deg = 52.0f;
    return {terrace, walk_view, flowers};
}

std::vector<Light> own_lights(double time_s) {
    SunArc arc;
    arc.first_azimuth_deg = 38.0f;
    arc.last_azimuth_deg = 142.0f;
    arc.lowest_elevation_deg = 33.0f;
    arc.highest_elevation_deg = 55.0f;
    arc.duration_s = duration_s;
    arc.irradiance = {6.4f, 5.5f, 4.3f};
    std::vector<Light> lights = {sun_light(arc, time_s)};
    const std::vector<Light> sky = sky_lights(48, {1.25f, 1.6f, 2.15f});
    lights.insert(lights.end(), sky.begin(), sky.end());
    return lights;
}

PosableScene made_garden() {
    PosableScene garden;
    garden.rest.materials = materials();
    PartBuilder builder{garden.rest};
    add_surroundings(builder);
    add_stone(builder);
    add_beds(builder);
    garden.rest.cameras = cameras();
    // Over the beds, below the palace's eaves.
    garden.rest.light_volume = {{-half_x + 2.5f, 2.0f, front_row_z + 0.6f}, {half_x - 2.5f, 8.0f, half_z - 2.0f}};
    garden.pose = [](Scene& scene, double time_s) { scene.lights = own_lights(time_s); };
    return garden;
}

}  // namespace

SceneModel garden_model() {
    return posed_model("garden", "A formal garden: flower beds, hedges, a fountain, a colonnade with a moving sun.",
                       duration_s, made_garden);
}

}  // namespace sightlines
