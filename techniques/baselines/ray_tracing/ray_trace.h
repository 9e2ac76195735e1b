// One ray against the triangle that Embree found in its way, recorded.
#pragma once

#include <array>
#include <optional>

#include "techniques/technique.h"

namespace sightlines::baselines {

/// From the surface to the light; a directional light is put `reach_m` away.
Segment asked_ray(const TraceRequest& request, float reach_m);

/// `blocker`: the corners of the triangle nearest to the light, where there is one.
Trace trace_triangle(const Segment& ray, const std::optional<std::array<vec3, 3>>& blocker);

}  // namespace sightlines::baselines
