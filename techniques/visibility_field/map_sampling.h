// Directions drawn where a map of the surroundings is bright (Pharr, Jakob, Humphreys: Physically Based Rendering, 2-D
// inversion of the cumulative distribution).
#pragma once

#include <vector>

#include "techniques/scene/environment_light.h"

namespace sightlines::visibility_field {

/// Draws texels by their light. A hundredth is shared out evenly, so that no direction is left out.
struct MapDistribution {
    ImageSize size{0, 0};        ///< of the map, or less: at most 1,024 x 512
    std::vector<float> rows;     ///< [height + 1], cumulative, from 0 to 1
    std::vector<float> columns;  ///< [height][width + 1], cumulative within a row, from 0 to 1
    std::vector<float> density;  ///< [height][width], per sr
    mat3 world_from_map{1.0f};   ///< the map's turn
    mat3 map_from_world{1.0f};
};

MapDistribution make_distribution(const EnvironmentLight& light);

/// The direction for two numbers in [0, 1), unit, world.
vec3 drawn_direction(const MapDistribution& distribution, vec2 numbers);

/// How densely `drawn_direction` draws a unit direction, per sr.
float drawn_density(const MapDistribution& distribution, vec3 direction);

}  // namespace sightlines::visibility_field
