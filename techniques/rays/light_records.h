// Lights as the kernels take them.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "shaders/lighting_data.h"
#include "techniques/scene/scene.h"

namespace sightlines {

inline LightRecord light_record(const Light& light) {
    LightRecord record;
    record.position = light.position;
    record.kind = light.kind == LightKind::point     ? light_point
                  : light.kind == LightKind::spot    ? light_spot
                  : light.kind == LightKind::surface ? light_surface
                                                     : light_directional;
    record.intensity = light.intensity;
    record.cosine_outer = light.kind == LightKind::surface ? light.nearest_m * light.nearest_m
                                                           : std::cos(glm::radians(light.outer_cone_deg));
    record.direction = light.direction;
    record.cosine_inner = std::cos(glm::radians(light.inner_cone_deg));
    return record;
}

inline std::vector<LightRecord> light_records(std::span<const Light> lights) {
    std::vector<LightRecord> records;
    records.reserve(lights.size());
    for (const Light& light : lights) records.push_back(light_record(light));
    return records;
}

}  // namespace sightlines
