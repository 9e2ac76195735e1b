// The surroundings as a light: turned, and as harmonics besides.
#pragma once

#include <memory>

#include "techniques/scene/environment.h"
#include "techniques/scene/harmonics.h"
#include "techniques/scene/map_sampling.h"

namespace sightlines {

/// Cheap to copy.
struct EnvironmentLight {
    std::shared_ptr<const Environment> map;  ///< as it was read or made
    float turn_deg = 0.0f;                   ///< about +Y, from -Z towards +X
    Harmonics harmonics;                     ///< turned
    MapDistribution distribution;            ///< turned
};

/// Projects the map, and makes the tables by which it is drawn.
EnvironmentLight make_environment_light(Environment map);

/// The same light, its map turned by so much instead of as before.
EnvironmentLight turned(const EnvironmentLight& light, float turn_deg);

/// Radiance of the turned map from a unit direction.
vec3 radiance_from(const EnvironmentLight& light, vec3 direction);

}  // namespace sightlines
