// The tables by which directions are drawn where a map of the surroundings is bright (shaders/map_light.h).
#pragma once

#include <memory>
#include <vector>

#include "shaders/weighted_samples_data.h"
#include "techniques/base/image.h"

namespace sightlines {

/// Texels by their light. A hundredth is shared out evenly, so that no direction is left out.
struct MapTables {
    ImageSize size{0, 0};        ///< of the map, or less: at most 1,024 x 512
    std::vector<float> rows;     ///< [height + 1], cumulative, from 0 to 1
    std::vector<float> columns;  ///< [height][width + 1], cumulative within a row, from 0 to 1
    std::vector<float> density;  ///< [height][width], per sr
    std::vector<float> heights;  ///< [height + 1], cosines of the rows' edges' angles from +Y
};

/// Draws directions by a map that is turned. Cheap to copy.
struct MapDistribution {
    std::shared_ptr<const MapTables> tables;
    MapShape shape{};  ///< of the tables, turned
};

/// A map as the kernels want it.
MapShape map_shape(ImageSize size, float turn_deg);

/// By a map's radiance, not turned. Takes some milliseconds.
MapDistribution make_distribution(const ImageRgb& map);

/// The same, turned by so much instead of as before.
MapDistribution turned(const MapDistribution& distribution, float turn_deg);

/// The direction for two numbers in [0, 1), unit, world.
vec3 drawn_direction(const MapDistribution& distribution, vec2 numbers);

/// How densely `drawn_direction` draws a unit direction, per sr.
float drawn_density(const MapDistribution& distribution, vec3 direction);

}  // namespace sightlines
