// One ray through the recording compilation of the kernel.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "shaders/recording.h"  // first: makes the kernels below record

#include "shaders/voxel_row_objects.h"
#include "shaders/voxel_rows.h"
#include "shaders/voxel_rows_first_hit.h"
#include "techniques/rays/light_records.h"
#include "techniques/trace_boxes.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines::voxel_rows {
namespace {

namespace kernel = recording_kernel;

/// The ray of a request, from the surface to the light, before the kernel moves its ends.
Segment asked_segment(const RowShape& query, const TraceRequest& request) {
    const vec3 to_light = kernel::to_light(light_record(request.light), request.position, query.reach_m);
    return {request.position, request.position + to_light};
}

/// Voxels first .. last (inclusive) of the row (v, w) as an oblong box in world space.
TraceGeometry row_box(const char* name, const mat4& world, int v, int w, int first, int last) {
    return box_geometry(name, world, vec3(first, v, w), vec3(std::max(first, last + 1), v + 1, w + 1));
}

TraceStep* find_step(std::vector<TraceStep>& steps, std::string_view paper) {
    const auto step = std::ranges::find(steps, paper, &TraceStep::paper);
    return step == steps.end() ? nullptr : &*step;
}

template <class T>
T value_of(const TraceStep& step, std::string_view name) {
    return std::get<T>(std::ranges::find(step.values, name, &TraceValue::name)->value);
}

std::int64_t whole_value(const TraceStep& step, std::string_view name) { return value_of<std::int64_t>(step, name); }

bool holds(const TraceStep& step, std::string_view name) {
    return std::ranges::find(step.values, name, &TraceValue::name) != step.values.end();
}

/// Boxes of the rows, of the voxels kept of them, and of the part that a search for the first hit goes on in. `world`
/// is that of the voxels in the frame of the steps.
void add_rows(std::span<TraceStep> steps, const mat4& world, int resolution) {
    int v = 0, w = 0;
    for (TraceStep& step : steps) {
        // Line 3 comes twice where there is a dictionary; only its first step knows where the row lies.
        if (step.paper == "Algorithm 3, line 3" && holds(step, "v")) {
            v = static_cast<int>(whole_value(step, "v"));
            w = static_cast<int>(whole_value(step, "w"));
            step.geometry.push_back(row_box("row", world, v, w, 0, resolution - 1));
        }
        if (step.paper == "Algorithm 3, line 4")
            step.geometry.push_back(row_box("extent", world, v, w, static_cast<int>(whole_value(step, "span.first")),
                                            static_cast<int>(whole_value(step, "span.last"))));
        if (step.paper == "Section 7, binary search")
            step.geometry.push_back(row_box("searched", world, v, w, static_cast<int>(whole_value(step, "low")),
                                            static_cast<int>(whole_value(step, "high"))));
    }
}

/// What the figures of the steps mean in space: the kernel knows indices, the frame says where they lie.
void add_geometry(std::vector<TraceStep>& steps, const RowArray& array, const ServedRay& served) {
    const mat4 world = world_from_voxels(array.grid, served.direction);
    const vec3 midpoint = 0.5f * (served.ray.origin + served.ray.target);
    const vec3 half = 0.5f * glm::length(served.ray.target - served.ray.origin) * served.row_direction;
    if (TraceStep* step = find_step(steps, "Algorithm 3, line 2")) {
        step->values.push_back({"row_direction", served.row_direction, ""});
        step->values.push_back({"angular_error", static_cast<double>(served.angular_error_deg), "deg"});
        step->geometry.push_back({"twin", TraceShape::segment, {midpoint - half, midpoint + half}});
        step->geometry.push_back(box_geometry("voxelization", world, vec3(0.0f), vec3(ivec3(array.grid.resolution))));
    }
    add_rows(steps, world, array.grid.resolution);
}

/// The geometry of an object's steps, which its kernel sees in the object's own frame, where the world has it.
void place_geometry(std::span<TraceStep> steps, const RowArray& type, const mat4& world_from_object) {
    const auto direction = std::ranges::find(steps, "Algorithm 3, line 1", &TraceStep::paper);
    if (direction != steps.end()) {
        const auto theta = whole_value(*direction, "theta_step"), phi = whole_value(*direction, "phi_step");
        add_rows(steps, world_from_voxels(type.grid, static_cast<int>(theta * type.grid.angles + phi)),
                 type.grid.resolution);
    }
    for (TraceStep& step : steps) {
        for (TraceGeometry& shape : step.geometry) {
            for (std::size_t k = 0; k < shape.points.size(); ++k) {
                // A box is a corner and three edges.
                const float is_place = shape.shape == TraceShape::box && k > 0 ? 0.0f : 1.0f;
                shape.points[k] = vec3(world_from_object * vec4(shape.points[k], is_place));
            }
        }
    }
}

/// Algorithm 5 from line 4 on, after the steps of what stands still.
void add_objects(Trace& trace, const TraceRequest& request, const Objects& objects) {
    const std::vector<ObjectInstance> instances = object_instances(objects, request.parameters);
    std::vector<TraceStep> steps;
    {
        kernel::Recording recording;
        trace.blocked = kernel::objects_block({instances.data()}, static_cast<int>(instances.size()), trace.ray.origin,
                                              request.normal, trace.ray.target);
        steps = std::move(recording.steps);
    }
    const auto begins = [](const TraceStep& step) { return step.paper == "Algorithm 5, line 4"; };
    for (auto first = steps.begin(); first != steps.end();) {
        const auto next = std::find_if(first + 1, steps.end(), begins);
        const PlacedObject& placed = objects.placed[static_cast<std::size_t>(whole_value(*first, "instance"))];
        const RowArray& type = objects.types[placed.type];
        const auto met = std::ranges::find(first, next, "Algorithm 5, line 6", &TraceStep::paper);
        if (met != next) met->geometry.push_back(box_geometry("object", type.grid.bounds));
        place_geometry({first, next}, type, placed.world_from_object);
        first = next;
    }
    std::ranges::move(steps, std::back_inserter(trace.steps));
}

/// Section 7: after whether the ray is blocked, where; nothing where no voxel is met.
void add_first_hit(Trace& trace, const TraceRequest& request, const RowArray& array, const RowShape& query,
                   const mat4& world) {
    const vec3 origin = kernel::ray_origin(query, trace.ray.origin, request.normal);
    std::vector<TraceStep> steps;
    kernel::RowHit found{};
    {
        kernel::Recording recording;
        found =
            kernel::first_hit(query, {array.grid.frames.data()}, {array.words.words.data()}, origin, trace.ray.target);
        steps = std::move(recording.steps);
    }
    if (!found.hit) return;
    add_rows(steps, world, array.grid.resolution);
    const vec3 along = trace.ray.target - trace.ray.origin;
    TraceStep& last = steps.back();
    last.values.push_back({"distance", static_cast<double>(found.share * glm::length(along)), "m"});
    last.geometry.push_back({"first hit", TraceShape::point, {trace.ray.origin + found.share * along}});
    std::ranges::move(steps, std::back_inserter(trace.steps));
}

}  // namespace

ServedRay serve(const RowArray& array, const TraceRequest& request) {
    const RowShape query = make_query(array, request.parameters, std::span(&request.light, 1));
    ServedRay served;
    const Segment asked = asked_segment(query, request);
    served.ray = {kernel::ray_origin(query, asked.origin, request.normal), asked.target};
    if (query.clip_to_bounds != 0) kernel::clip_to_bounds(query, served.ray.origin, served.ray.target);
    const vec3 along_ray = served.ray.target - served.ray.origin;
    const kernel::Direction direction = kernel::discretize_direction(query, along_ray);
    served.theta = direction.theta;
    served.phi = direction.phi;
    served.direction = kernel::frame_index(query, direction);
    const DirectionFrame& frame = array.grid.frames[static_cast<std::size_t>(served.direction)];
    const vec3 midpoint = 0.5f * (served.ray.origin + served.ray.target);
    const vec3 at_midpoint = voxel_coordinates(query, frame, midpoint);
    served.v = kernel::voxel_index(query, at_midpoint.y);
    served.w = kernel::voxel_index(query, at_midpoint.z);
    const kernel::RowSpan span = kernel::locate_span(query, frame, direction, served.ray.origin, served.ray.target,
                                                     query.start_offset, query.light_offset);
    served.first = span.first;
    served.last = span.last;
    served.blocked = is_blocked(array, query, asked, request.normal);
    served.row_direction = glm::normalize(frame.u);
    if (glm::dot(served.row_direction, along_ray) < 0.0f) served.row_direction = -served.row_direction;
    const vec3 ray_direction = glm::normalize(along_ray);
    served.angular_error_deg = glm::degrees(std::atan2(glm::length(glm::cross(ray_direction, served.row_direction)),
                                                       glm::dot(ray_direction, served.row_direction)));
    const auto words = row_words(array, span.row);
    for (int u = 0; u < query.resolution; ++u)
        served.bits.push_back((words[static_cast<std::size_t>(u / 32)] >> (u % 32)) & 1u);
    return served;
}

std::vector<AskedObject> asked_objects(const Objects& objects, const Trace& trace) {
    std::vector<AskedObject> asked;
    for (const TraceStep& step : trace.steps) {
        const auto whole = [&](std::string_view name) { return static_cast<int>(whole_value(step, name)); };
        if (step.paper == "Algorithm 5, line 4")
            asked.push_back({.instance = static_cast<std::uint32_t>(whole("instance"))});
        if (asked.empty()) continue;  // still of what stands still
        AskedObject& object = asked.back();
        if (step.paper == "Algorithm 5, line 6") object.met = value_of<bool>(step, "met");
        if (step.paper == "Algorithm 3, line 1") {
            const RowArray& type = objects.types[objects.placed[object.instance].type];
            object.direction = whole("theta_step") * type.grid.angles + whole("phi_step");
        }
        if (step.paper == "Algorithm 3, line 3") object.rows.push_back({.v = whole("v"), .w = whole("w")});
        if (step.paper == "Algorithm 3, line 4") {
            object.rows.back().first = whole("span.first");
            object.rows.back().last = whole("span.last");
        }
        if (step.paper == "Algorithm 3, lines 5 to 7") object.rows.back().blocked = value_of<bool>(step, "blocked");
    }
    return asked;
}

Trace trace(const RowArray& array, const TraceRequest& request, const Objects& objects) {
    const RowShape query = make_query(array, request.parameters, std::span(&request.light, 1));
    Trace trace;
    trace.ray = asked_segment(query, request);
    {
        kernel::Recording recording;
        const vec3 origin = kernel::ray_origin(query, trace.ray.origin, request.normal);
        trace.blocked =
            kernel::is_blocked(query, {array.grid.frames.data()}, {array.words.words.data()}, origin, trace.ray.target);
        trace.steps = std::move(recording.steps);
    }
    const ServedRay served = serve(array, request);
    add_geometry(trace.steps, array, served);
    if (parameter_value(technique().parameters, request.parameters, "first_hits") != 0.0)
        add_first_hit(trace, request, array, query, world_from_voxels(array.grid, served.direction));
    if (!trace.blocked && !objects.empty()) add_objects(trace, request, objects);
    return trace;
}

}  // namespace sightlines::voxel_rows
