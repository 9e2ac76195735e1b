#include "shaders/recording.h"  // first: makes the kernels below record

#include "shaders/shadow_map.h"
#include "techniques/baselines/shadow_maps/map_shapes.h"
#include "techniques/baselines/shadow_maps/map_trace.h"
#include "techniques/baselines/trace_values.h"
#include "techniques/rays/light_records.h"

namespace sightlines::baselines {
namespace {

namespace kernel = recording_kernel;

/// What the texel holds: the blocker's place, and the way to it from the light.
void add_geometry(std::vector<TraceStep>& steps, const ShadowMapShape& shape, MapKind kind, const Segment& ray) {
    for (TraceStep& step : steps) {
        step.geometry.push_back({"ray", TraceShape::segment, {ray.origin, ray.target}});
        const auto map = whole_value(step, "place.map"), column = whole_value(step, "column"),
                   line = whole_value(step, "line");
        const auto held = step_value<double>(step, "held");
        if (!map || !column || !line || !held || *held <= 0.0) continue;
        const vec3 blocker =
            held_point(shape, *map, *column, *line, static_cast<float>(*held), kind == MapKind::imperfect);
        step.geometry.push_back({"nearest surface", TraceShape::point, {blocker}});
        const vec3 from = shape.directional != 0 ? blocker - shape.axis_depth * shape.reach_m : shape.light;
        step.geometry.push_back({"texel's ray", TraceShape::segment, {from, blocker}});
    }
}

}  // namespace

Trace trace_map(const ShadowMapShape& shape, const float* maps, MapKind kind, const TraceRequest& request,
                float reach_m) {
    Trace trace;
    const vec3 to_light = kernel::to_light(light_record(request.light), request.position, reach_m);
    trace.ray = {request.position, request.position + to_light};
    {
        kernel::Recording recording;
        trace.blocked = kind == MapKind::conventional
                            ? kernel::is_in_shadow(shape, {maps}, request.position, request.normal)
                            : kernel::is_in_imperfect_shadow(shape, {maps}, request.position, request.normal);
        trace.steps = std::move(recording.steps);
    }
    add_geometry(trace.steps, shape, kind, trace.ray);
    return trace;
}

std::vector<LookedUpMap> maps_of_trace(const ShadowMapShape& shape, const float* maps,
                                       std::span<const std::string_view> titles, const Trace& traced) {
    std::vector<LookedUpMap> looked_up;
    for (const std::string_view title : titles) {
        LookedUpMap& map = looked_up.emplace_back(LookedUpMap{std::string(title), shape.resolution, {}, {}});
        const float* numbers = maps + static_cast<std::ptrdiff_t>(looked_up.size() - 1) * shape.map_pitch;
        for (int row = 0; row < shape.resolution; ++row)
            map.nearness.insert(map.nearness.end(), numbers + static_cast<std::ptrdiff_t>(row) * shape.pitch,
                                numbers + static_cast<std::ptrdiff_t>(row) * shape.pitch + shape.resolution);
    }
    for (const TraceStep& step : traced.steps) {
        const auto map = whole_value(step, "place.map"), column = whole_value(step, "column"),
                   line = whole_value(step, "line");
        if (map && column && line) looked_up.at(static_cast<std::size_t>(*map)).asked = ivec2(*column, *line);
    }
    return looked_up;
}

}  // namespace sightlines::baselines
