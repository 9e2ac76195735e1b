// The tables by which directions are drawn where a map of the surroundings is bright (shaders/map_light.h).
#pragma once

#include <vector>

#include "shaders/weighted_samples_data.h"
#include "techniques/scene/environment_light.h"

namespace sightlines::visibility_field {

/// Draws texels by their light. A hundredth is shared out evenly, so that no direction is left out.
struct MapDistribution {
    ImageSize size{0, 0};        ///< of the map, or less: at most 1,024 x 512
    std::vector<float> rows;     ///< [height + 1], cumulative, from 0 to 1
    std::vector<float> columns;  ///< [height][width + 1], cumulative within a row, from 0 to 1
    std::vector<float> density;  ///< [height][width], per sr
    std::vector<float> heights;  ///< [height + 1], cosines of the rows' edges' angles from +Y
    MapShape shape{};            ///< of the tables, turned as the map is
};

/// A map as the kernels want it.
MapShape map_shape(ImageSize size, float turn_deg);

MapDistribution make_distribution(const EnvironmentLight& light);

/// The direction for two numbers in [0, 1), unit, world.
vec3 drawn_direction(const MapDistribution& distribution, vec2 numbers);

/// How densely `drawn_direction` draws a unit direction, per sr.
float drawn_density(const MapDistribution& distribution, vec3 direction);

}  // namespace sightlines::visibility_field
