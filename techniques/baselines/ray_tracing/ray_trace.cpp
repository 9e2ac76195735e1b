#include "shaders/recording.h"  // first: makes the kernels below record

#include "shaders/ray_triangle.h"
#include "techniques/baselines/ray_tracing/ray_trace.h"
#include "techniques/rays/light_records.h"

namespace sightlines::baselines {

Segment asked_ray(const TraceRequest& request, float reach_m) {
    const LightRecord light = light_record(request.light);
    return {request.position, recording_kernel::light_end(light, request.position, reach_m)};
}

Trace trace_triangle(const Segment& ray, const std::optional<std::array<vec3, 3>>& blocker) {
    Trace trace;
    trace.ray = ray;
    trace.blocked = blocker.has_value();
    if (!blocker) return trace;
    const auto& [a, b, c] = *blocker;
    {
        recording_kernel::Recording recording;
        recording_kernel::meets_triangle(ray.target, ray.origin, a, b, c);
        trace.steps = std::move(recording.steps);
    }
    for (TraceStep& step : trace.steps)
        step.geometry = {{"ray", TraceShape::segment, {ray.origin, ray.target}},
                         {"edge", TraceShape::segment, {a, b}},
                         {"edge", TraceShape::segment, {b, c}},
                         {"edge", TraceShape::segment, {c, a}}};
    return trace;
}

}  // namespace sightlines::baselines
