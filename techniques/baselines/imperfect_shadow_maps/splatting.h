// Drawing a light's imperfect maps: points become squares of texels, and what stays empty between them is filled.
#pragma once

#include <span>

#include "shaders/shadow_map_data.h"
#include "techniques/baselines/imperfect_shadow_maps/point_samples.h"
#include "techniques/baselines/imperfect_shadow_maps/pull_push.h"

namespace sightlines::baselines {

struct SplatOptions {
    float size = 1.0f;    ///< of a splat, in sides of the square that its point stands for
    int most_texels = 8;  ///< a splat is at most so wide
    int fill_levels = 2;  ///< copies that holes are filled from
    float tolerance = 0.1f;
};

/// Two paraboloids, or the one map of a directional light.
inline int imperfect_maps_of(const ShadowMapShape& shape) { return shape.directional != 0 ? 1 : 2; }

/// Draws the points of a set into all maps of the light. `numbers`: [maps * map_pitch], nearness afterwards.
void draw_imperfect_maps(const PointSamples& samples, std::size_t set, const ShadowMapShape& shape,
                         const SplatOptions& options, std::span<float> numbers, PullPushScratch& scratch);

}  // namespace sightlines::baselines
