// One sample through the recording compilation of the kernel.
#include <algorithm>
#include <limits>
#include <numbers>

#include "shaders/recording.h"  // first: makes the kernels below record

#include "shaders/harmonic_light.h"
#include "shaders/one_bounce.h"
#include "shaders/visibility_field.h"
#include "techniques/rays/open_rays.h"
#include "techniques/trace_boxes.h"
#include "techniques/visibility_field/one_bounce.h"
#include "techniques/visibility_field/trace.h"
#include "techniques/visibility_field/weighted_samples.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = recording_kernel;

/// Runs the kernel as the renderer does; fills in all but the truth.
void decide(const VisibilityField& field, Culling culling, const SampleRay& asked, SampleTrace& traced) {
    const FieldShape& shape = field.shape;
    const kernel::FieldCell cell = kernel::locate_cell(shape, {field.bricks.data()}, asked.position, asked.normal);
    traced.cell = {cell.x, cell.y, cell.z};
    traced.cell_index = cell.index;
    traced.label = culling == Culling::visible ? 1 : cell.label;
    const bool above = kernel::leaves_surface(asked.normal, asked.direction);
    kernel::Decision decision;
    if (cell.index == kernel::no_cell) {
        decision = kernel::decide_without_masks(above);
    } else {
        const int texel = kernel::texel_of(shape, asked.direction);
        traced.texel = {texel % shape.mask_size, texel / shape.mask_size};
        const kernel::Words masks{field.masks.data()}, numbers{field.mask_numbers.data()};
        const int words = shape.words_per_mask;
        const kernel::MaskBits bits = kernel::mask_bits(
            kernel::load_mask(masks, kernel::mask_start(shape, numbers, cell.index, 0), words),
            kernel::load_mask(masks, kernel::mask_start(shape, numbers, cell.index, 1), words), texel);
        traced.visible_bit = bits.visible;
        traced.occluded_bit = bits.occluded;
        decision = culling == Culling::both
                       ? kernel::decide_by_both(above, traced.visible_bit, traced.occluded_bit)
                       : kernel::decide_by_label(traced.label, above,
                                                 traced.label == 1 ? traced.visible_bit : traced.occluded_bit);
    }
    traced.fate = !above                          ? Fate::below_surface
                  : decision.blocked              ? Fate::taken_for_blocked
                  : decision.open                 ? Fate::taken_for_open
                  : cell.index == kernel::no_cell ? Fate::outside_cells
                                                  : Fate::traced;
}

/// How far rays are drawn: across the grid.
float reach_m(const FieldShape& shape) {
    return std::max(glm::length(shape.cell_m * vec3(shape.cells_x, shape.cells_y, shape.cells_z)), shape.cell_m);
}

bool was_asked(Fate fate) { return fate == Fate::traced || fate == Fate::outside_cells; }

/// The cell and the ray, for the view.
void add_shapes(const FieldShape& shape, const SampleTrace& traced, const char* ray_name, TraceStep& step) {
    if (step.paper == "Algorithm 2, line 3")
        step.geometry.push_back(box_geometry("cell", cell_box(shape, traced.cell)));
    step.geometry.push_back({ray_name, TraceShape::segment, {traced.trace.ray.origin, traced.trace.ray.target}});
}

}  // namespace

SampleRay sample_ray(const EnvironmentRequest& request, std::size_t pixel, int sample) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    if (is_weighted(request)) {
        const PixelSample weighted = weighted_samples(request, pixel)[static_cast<std::size_t>(sample)];
        return {surfaces.position[pixel], surfaces.normal[pixel], weighted.direction, weighted.adds};
    }
    const SamplePattern& pattern = *request.pattern;
    const auto width = static_cast<std::size_t>(surfaces.size.width);
    const std::size_t tile = pattern.tile_place(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    const auto k = static_cast<std::size_t>(sample);
    const kernel::HemisphereFrame frame =
        kernel::frame_about(surfaces.shading_normal[pixel], pattern.turns[tile].x, pattern.turns[tile].y);
    SampleRay ray{surfaces.position[pixel], surfaces.normal[pixel],
                  kernel::direction_in(frame, pattern.x[k], pattern.y[k], pattern.z[k]), vec3(0.0f)};
    ray.share =
        std::numbers::pi_v<float> / static_cast<float>(pattern.samples) * radiance(request.light, ray.direction);
    return ray;
}

SampleTrace trace_sample(const VisibilityField& field, const EmbreeScene& embree, Culling culling,
                         const SampleRay& ray) {
    SampleTrace traced;
    const vec3 start = lifted_off(embree, ray.position, ray.normal);
    traced.trace.ray = {start, start + reach_m(field.shape) * ray.direction};
    traced.blocked_in_truth = is_blocked(embree, start, ray.direction);
    {
        kernel::Recording recording;
        decide(field, culling, ray, traced);
        traced.trace.blocked = was_asked(traced.fate) ? traced.blocked_in_truth : traced.fate != Fate::taken_for_open;
        const bool subtracts = culling == Culling::label && traced.label == 0 && traced.cell_index != kernel::no_cell;
        traced.adds = kernel::sample_adds(subtracts, traced.trace.blocked, ray.share);
        traced.trace.steps = std::move(recording.steps);
    }
    for (TraceStep& step : traced.trace.steps) add_shapes(field.shape, traced, "ray", step);
    return traced;
}

void add_second_ray(const VisibilityField& field, const EmbreeScene& embree, const Scene& scene,
                    const EnvironmentRequest& request, std::uint64_t seed, const SampleRay& ray, SampleTrace& traced) {
    const vec3 origin = traced.trace.ray.origin;
    const std::optional<Hit> hit = closest_hit(embree, origin, ray.direction, std::numeric_limits<float>::infinity());
    if (!hit) return;
    const SecondRay second = second_ray(scene, request, *hit, origin, ray.direction, seed);
    const SampleRay asked{second.surface.position, second.surface.normal, second.direction, vec3(0.0f)};
    const vec3 start = lifted_off(embree, asked.position, asked.normal);
    const std::optional<Hit> in_the_way = closest_hit(embree, start, asked.direction, reach_m(field.shape));
    SampleTrace way;
    way.trace.ray = {start, start + (in_the_way ? in_the_way->distance_m : reach_m(field.shape)) * asked.direction};
    {
        kernel::Recording recording;
        kernel::second_direction(second.surface.shading_normal, second.about_up);
        decide(field, culling_used(request), asked, way);
        const bool blocked = was_asked(way.fate) ? in_the_way.has_value() : way.fate != Fate::taken_for_open;
        traced.comes_back = kernel::sent_back(second.surface.albedo, second.light, blocked);
        way.trace.steps = std::move(recording.steps);
    }
    for (TraceStep& step : way.trace.steps) {
        add_shapes(field.shape, way, "second ray", step);
        step.geometry.push_back({"ray", TraceShape::segment, {origin, asked.position}});
        traced.trace.steps.push_back(std::move(step));
    }
}

SampleTrace trace_sample(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                         int x, int y, int sample) {
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(request.surfaces->size.width) +
                       static_cast<std::size_t>(x);
    return trace_sample(field, embree, request.culling, sample_ray(request, pixel, sample));
}

NearestSamples nearest_samples(const CellPoints& samples, const EmbreeScene& embree, const SampleTrace& traced) {
    NearestSamples result;
    if (samples.points.empty()) return result;
    const vec3 direction = glm::normalize(traced.trace.ray.target - traced.trace.ray.origin);
    result.nearest_m = result.should_have_seen_m = std::numeric_limits<float>::infinity();
    for (const SurfacePoint& point : samples.points) {
        const float distance_m = glm::distance(point.position, traced.trace.ray.origin);
        ++result.points;
        if (distance_m < result.nearest_m) {
            result.nearest_m = distance_m;
            result.nearest = point;
        }
        if (glm::dot(point.normal, direction) <= 0.0f) continue;
        ++result.facing;
        const bool blocked = is_blocked(embree, lifted_off(embree, point.position, point.normal), direction);
        if (blocked == traced.blocked_in_truth && distance_m < result.should_have_seen_m) {
            result.should_have_seen_m = distance_m;
            result.should_have_seen = point;
        }
    }
    return result;
}

}  // namespace sightlines::visibility_field
