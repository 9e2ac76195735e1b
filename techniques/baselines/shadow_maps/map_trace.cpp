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

}  // namespace sightlines::baselines
