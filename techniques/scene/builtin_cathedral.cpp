// The built-in cathedral: a nave with aisles under ribbed vaults, lit by its windows and candles.
#include "techniques/scene/builtin_cathedral.h"

#include <cmath>
#include <numbers>

#include "techniques/scene/builtin_models.h"
#include "techniques/scene/builtin_posed.h"

namespace sightlines {
namespace {

using namespace cathedral;

constexpr float pi = std::numbers::pi_v<float>;
constexpr float chandelier_drop = 12.6f;
constexpr double duration_s = 12.0;

float bay_middle(int i) { return -nave_end + bay * (static_cast<float>(i) + 0.5f); }

void add_structure(PartBuilder& builder) {
    builder.add(floor_mesh(), "floor");
    std::vector<mat4> piers, arcades, vaults, aisle_vaults;
    for (int i = 0; i <= bays; ++i)
        for (const float side : {-1.0f, 1.0f})
            piers.push_back(placed({-nave_end + bay * static_cast<float>(i), 0, side * nave_half}));
    for (int i = 0; i < bays; ++i) {
        vaults.push_back(placed({bay_middle(i), vault_spring, 0}));
        for (const float side : {-1.0f, 1.0f}) {
            arcades.push_back(placed({bay_middle(i), pier_height, side * nave_half}));
            aisle_vaults.push_back(placed({bay_middle(i), aisle_spring, side * 0.5f * (nave_half + aisle_wall)}));
            const float turn = side < 0.0f ? 0.0f : 180.0f;
            const auto seed = static_cast<std::uint32_t>(10 * i + (side < 0.0f ? 0 : 1));
            builder.add(upper_bay_mesh(800 + seed), "clerestory", {placed({bay_middle(i), 0, side * nave_half}, turn)});
            builder.add(aisle_bay_mesh(900 + seed), "aisle wall",
                        {placed({bay_middle(i), 0, side * (aisle_wall + 0.5f)}, turn)});
        }
    }
    builder.add(pier_mesh(), "pier", piers);
    builder.add(arcade_bay_mesh(), "arcade", arcades);
    builder.add(vault_mesh(0.5f * bay, nave_half, vault_rise), "vault", vaults);
    builder.add(vault_mesh(0.5f * bay, 0.5f * (aisle_wall - nave_half), aisle_rise), "aisle vault", aisle_vaults);
    builder.add(west_front_mesh(), "west front", {placed({-nave_end - 0.6f, 0, 0}, 90.0f)});
    builder.add(apse_mesh(), "apse");
    // What closes the aisles' ends.
    Mesh ends;
    for (const float side : {-1.0f, 1.0f}) {
        const float z = side < 0.0f ? -aisle_wall : nave_half;
        add_box(ends, {{-nave_end - 1.0f, 0, z}, {-nave_end - 0.3f, 11.6f, z + aisle_wall - nave_half}}, stone);
        add_box(ends, {{nave_end + 0.3f, 0, z}, {nave_end + 1.0f, 11.6f, z + aisle_wall - nave_half}}, stone);
    }
    builder.add(ends, "aisle ends");
}

std::vector<vec3> chandelier_hooks() {
    std::vector<vec3> hooks;
    for (int i = 1; i < bays; ++i) hooks.push_back({bay_middle(i) - 0.5f * bay, vault_spring + vault_rise - 0.2f, 0});
    return hooks;
}

void add_furniture(PartBuilder& builder) {
    std::vector<mat4> pews, chandeliers, sticks;
    for (int row = 0; row < 22; ++row)
        for (const float side : {-1.0f, 1.0f})
            pews.push_back(placed({-nave_end + 5.0f + 1.35f * static_cast<float>(row), 0, side * 2.95f}));
    for (const vec3 hook : chandelier_hooks()) chandeliers.push_back(placed(hook));
    for (const float z : {-2.6f, -1.9f, 1.9f, 2.6f}) sticks.push_back(placed({nave_end - 0.4f, 0.48f, z}));
    for (int i = 1; i < bays; i += 2)
        for (const float side : {-1.0f, 1.0f})
            sticks.push_back(placed({bay_middle(i) - 0.5f * bay + 1.3f, 0, side * nave_half}));
    builder.add(pew_mesh(), "pew", pews);
    builder.add(chandelier_mesh(chandelier_drop), "chandelier", chandeliers);
    builder.add(candlestick_mesh(), "candlestick", sticks);
    builder.add(altar_mesh(), "altar", {placed({nave_end + 1.2f, 0.48f, 0})});
    builder.add(pulpit_mesh(), "pulpit", {placed({nave_end - 6.5f, 0, -4.1f}, 120.0f)});
}

Light window_light(vec3 position, vec3 inward, vec3 colour) {
    Light light;
    light.kind = LightKind::spot;
    light.position = position;
    light.direction = glm::normalize(inward + vec3(0, -0.75f, 0));
    light.outer_cone_deg = 80.0f;
    light.inner_cone_deg = 15.0f;
    light.intensity = colour;
    return light;
}

/// Candles, which flicker, and the glow of each window from just before its glass.
std::vector<Light> own_lights(double time_s) {
    std::vector<Light> lights;
    const vec3 warm(3.6f, 2.1f, 0.9f);
    std::uint32_t number = 0;
    const auto candle_at = [&](vec3 place) {
        const float phase = 2.0f * pi * random_unit(31, number, 0),
                    turns = 9.0f + static_cast<float>(random_u32(31, number, 1) % 11);
        ++number;
        const auto loop = static_cast<float>(time_s / duration_s - std::floor(time_s / duration_s));
        Light light;
        light.position = place;
        light.intensity = warm * (0.92f + 0.08f * std::sin(2.0f * pi * turns * loop + phase));
        lights.push_back(light);
    };
    for (const vec3 hook : chandelier_hooks())
        for (int k = 0; k < chandelier_candles; ++k) {
            const float angle = 2.0f * pi * (static_cast<float>(k) + 0.5f) / chandelier_candles;
            candle_at(hook + vec3(chandelier_radius * std::cos(angle), -chandelier_drop - 0.62f,
                                  chandelier_radius * std::sin(angle)));
        }
    const vec3 cool(15.0f, 22.0f, 40.0f), gold(48.0f, 31.0f, 15.0f);
    for (int i = 0; i < bays; ++i)
        for (const float side : {-1.0f, 1.0f}) {
            const vec3 inward(0, 0, -side);
            // The south is to the side of +z: warm.
            const vec3 colour = side > 0.0f ? gold : cool;
            for (const float x : {-0.8f, 0.8f}) {
                lights.push_back(
                    window_light({bay_middle(i) + x, 17.2f, side * (nave_half - 0.75f)}, inward, 0.9f * colour));
                lights.push_back(
                    window_light({bay_middle(i) + x, 5.6f, side * (aisle_wall - 0.8f)}, inward, 0.30f * colour));
            }
        }
    for (int k = 0; k < 5; ++k) {
        const float angle = pi * (static_cast<float>(k) - 2.0f) / 5.0f;
        const vec3 out(std::cos(angle), 0, std::sin(angle));
        for (const float y : {6.5f, 11.5f})
            lights.push_back(
                window_light(vec3(nave_end, y, 0) + (nave_half - 0.6f) * out, -out, vec3(24.0f, 24.0f, 26.0f)));
    }
    lights.push_back(window_light({-nave_end + 0.8f, 14.6f, 0}, {1, 0, 0}, {110.0f, 80.0f, 62.0f}));
    return lights;
}

std::vector<Camera> cameras() {
    Camera nave{"default", CameraKind::perspective, {-21.6f, 4.6f, 2.3f}, {10.0f, 8.4f, -0.9f}};
    nave.vertical_field_of_view_deg = 66.0f;
    Camera gallery{"gallery", CameraKind::perspective, {19.5f, 12.6f, 3.2f}, {-8.0f, 5.5f, -1.6f}};
    gallery.vertical_field_of_view_deg = 64.0f;
    Camera aisle{"aisle", CameraKind::perspective, {-21.0f, 1.8f, 9.6f}, {4.0f, 3.6f, 6.4f}};
    aisle.vertical_field_of_view_deg = 62.0f;
    return {nave, gallery, aisle};
}

PosableScene made_cathedral() {
    PosableScene church;
    church.rest.materials = materials();
    PartBuilder builder{church.rest};
    add_structure(builder);
    add_furniture(builder);
    church.rest.cameras = cameras();
    // In the nave, over the pews and below the vault's springing.
    church.rest.light_volume = {{-nave_end + 1.0f, 2.6f, -nave_half + 1.2f},
                                {nave_end + 1.0f, 13.5f, nave_half - 1.2f}};
    church.pose = [](Scene& scene, double time_s) { scene.lights = own_lights(time_s); };
    return church;
}

}  // namespace

SceneModel cathedral_model() {
    return posed_model("cathedral",
                       "A nave with aisles under ribbed vaults, lit by stained glass and flickering candles.",
                       duration_s, made_cathedral);
}

}  // namespace sightlines
