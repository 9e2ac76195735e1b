// One look-up in a light's maps, recorded.
#pragma once

#include "shaders/shadow_map_data.h"
#include "techniques/technique.h"

namespace sightlines::baselines {

enum class MapKind { conventional, imperfect };

/// `maps`: all maps of the light, complete.
Trace trace_map(const ShadowMapShape& shape, const float* maps, MapKind kind, const TraceRequest& request,
                float reach_m);

}  // namespace sightlines::baselines
