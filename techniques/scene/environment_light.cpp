#include "techniques/scene/environment_light.h"

#include <utility>

namespace sightlines {

EnvironmentLight make_environment_light(Environment map) {
    EnvironmentLight light;
    light.harmonics = project(map);
    light.distribution = make_distribution(map.radiance);
    light.map = std::make_shared<const Environment>(std::move(map));
    return light;
}

EnvironmentLight turned(const EnvironmentLight& light, float turn_deg) {
    return {light.map, turn_deg, rotated(light.harmonics, turn_about_up(turn_deg - light.turn_deg)),
            turned(light.distribution, turn_deg)};
}

vec3 radiance_from(const EnvironmentLight& light, vec3 direction) {
    return radiance_from(*light.map, turn_about_up(-light.turn_deg) * direction);
}

}  // namespace sightlines
