// One look-up in a light's maps, recorded.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "shaders/shadow_map_data.h"
#include "techniques/baselines/baselines.h"
#include "techniques/technique.h"

namespace sightlines::baselines {

enum class MapKind { conventional, imperfect };

/// `maps`: all maps of the light, complete.
Trace trace_map(const ShadowMapShape& shape, const float* maps, MapKind kind, const TraceRequest& request,
                float reach_m);

/// The maps that `traced`, by trace_map, looked up, as pictures with the texel asked; `titles`: [maps of the light].
std::vector<LookedUpMap> maps_of_trace(const ShadowMapShape& shape, const float* maps,
                                       std::span<const std::string_view> titles, const Trace& traced);

}  // namespace sightlines::baselines
