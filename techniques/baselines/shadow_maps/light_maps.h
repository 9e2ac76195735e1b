// The maps of a few lights at a time: a light's are rendered, all pixels look them up, then their memory is used again.
#pragma once

#include <vector>

#include "shaders/shadow_map_data.h"

namespace sightlines::baselines {

struct LightMaps {
    std::uint32_t first_light = 0;
    std::vector<ShadowMapShape> shapes;  ///< [lights at once]
    std::vector<float> numbers;          ///< [lights at once][maps per light][resolution * pitch]
    std::size_t per_light = 0;           ///< numbers

    LightMaps(std::uint32_t lights, int maps_per_light, int resolution)
        : shapes(lights),
          per_light(static_cast<std::size_t>(maps_per_light) * static_cast<std::size_t>(resolution) *
                    static_cast<std::size_t>((resolution + 15) / 16 * 16)) {
        numbers.resize(lights * per_light);
    }
    const ShadowMapShape& shape(std::uint32_t light) const { return shapes[light - first_light]; }
    const float* maps(std::uint32_t light) const { return numbers.data() + (light - first_light) * per_light; }
    float* maps(std::uint32_t light) { return numbers.data() + (light - first_light) * per_light; }
};

}  // namespace sightlines::baselines
