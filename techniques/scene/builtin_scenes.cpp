#include "techniques/scene/builtin_scenes.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "techniques/base/error.h"
#include "techniques/base/random.h"
#include "techniques/scene/builtin_models.h"
#include "techniques/scene/gltf.h"

namespace sightlines {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// The unit vector to a point of the sky. Azimuth 0 is +x, 90 is +z.
vec3 sky_direction(float azimuth_deg, float elevation_deg) {
    const float azimuth = azimuth_deg * pi / 180.0f, elevation = elevation_deg * pi / 180.0f;
    return {std::cos(elevation) * std::cos(azimuth), std::sin(elevation), std::cos(elevation) * std::sin(azimuth)};
}

/// "a, b and c"
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
    return text;
}

}  // namespace

std::vector<Light> sky_lights(int count, vec3 irradiance) {
    std::vector<Light> lights;
    float cosines = 0.0f;
    for (int i = 0; i < count; ++i) {
        const float height =
            (static_cast<float>(i) + 0.5f) / static_cast<float>(count);  // equal areas of the hemisphere
        const float azimuth = 2.0f * pi * std::numbers::phi_v<float> * static_cast<float>(i);
        const float radius = std::sqrt(1.0f - height * height);
        Light light;
        light.kind = LightKind::directional;
        light.direction = -vec3(radius * std::cos(azimuth), height, radius * std::sin(azimuth));
        lights.push_back(light);
        cosines += height;
    }
    for (Light& light : lights) light.intensity = irradiance / cosines;
    return lights;
}

Light sun_light(const SunArc& arc, double time_s) {
    const double phase = time_s / arc.duration_s;
    // There and back, so that the loop has no jump.
    const auto along = static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (phase - std::floor(phase))));
    const float azimuth = arc.first_azimuth_deg + (arc.last_azimuth_deg - arc.first_azimuth_deg) * along;
    const float elevation =
        arc.lowest_elevation_deg + (arc.highest_elevation_deg - arc.lowest_elevation_deg) * std::sin(pi * along);
    Light light;
    light.kind = LightKind::directional;
    light.direction = -sky_direction(azimuth, elevation);
    light.intensity = arc.irradiance;
    return light;
}

const std::vector<SceneModel>& builtin_scenes() {
    static const std::vector<SceneModel> scenes = {cornell_model(),   atrium_model(), trees_model(), garden_model(),
                                                   cathedral_model(), planes_model(), bear_model(),  bear_full_model(),
                                                   park_model(),      tv_model(),     street_model()};
    return scenes;
}

SceneModel find_scene(const std::string& name_or_path, Progress& progress) {
    std::vector<std::string> names;
    for (const SceneModel& model : builtin_scenes()) {
        if (model.name == name_or_path) return model;
        names.push_back(model.name);
    }
    std::string extension = std::filesystem::path(name_or_path).extension().string();
    for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    if (extension == ".gltf" || extension == ".glb") return load_gltf(name_or_path, progress);
    const std::string near = nearest_name(name_or_path, names);
    throw InputError("scene", name_or_path,
                     "there is no built-in scene of this name, and it is not a .gltf or .glb file",
                     near.empty() ? "built in are " + listed(names) : "did you mean " + near + "?");
}

}  // namespace sightlines
