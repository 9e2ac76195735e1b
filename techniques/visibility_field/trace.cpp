// One sample through the recording compilation of the kernel.
#include <algorithm>
#include <limits>
#include <numbers>

#include "shaders/recording.h"  // first: makes the kernels below record

#include "shaders/harmonic_light.h"
#include "shaders/visibility_field.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/trace.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = recording_kernel;

TraceGeometry box_of(const FieldShape& shape, ivec3 cell) {
    const Box3 box = cell_box(shape, cell);
    const float side = shape.cell_m;
    return {
        "cell", TraceShape::box, {box.lowest, vec3(side, 0.0f, 0.0f), vec3(0.0f, side, 0.0f), vec3(0.0f, 0.0f, side)}};
}

struct Asked {
    vec3 position, normal, direction;
};

Asked asked_sample(const EnvironmentRequest& request, std::size_t pixel, std::size_t tile, std::size_t sample) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const SamplePattern& pattern = *request.pattern;
    const kernel::HemisphereFrame frame =
        kernel::frame_about(surfaces.shading_normal[pixel], pattern.turns[tile].x, pattern.turns[tile].y);
    return {surfaces.position[pixel], surfaces.normal[pixel],
            kernel::direction_in(frame, pattern.x[sample], pattern.y[sample], pattern.z[sample])};
}

/// Runs the kernel as the renderer does; fills in all but the truth.
void decide(const VisibilityField& field, const EnvironmentRequest& request, const Asked& asked, SampleTrace& traced) {
    const FieldShape& shape = field.shape;
    const kernel::FieldCell cell = kernel::locate_cell(shape, {field.bricks.data()}, asked.position, asked.normal);
    traced.cell = {cell.x, cell.y, cell.z};
    traced.cell_index = cell.index;
    traced.label = request.culling == Culling::visible ? 1 : cell.label;
    const bool above = kernel::leaves_surface(asked.normal, asked.direction);
    kernel::Decision decision;
    if (cell.index == kernel::no_cell) {
        decision = kernel::decide_without_masks(above);
    } else {
        const int texel = kernel::texel_of(shape, asked.direction);
        traced.texel = {texel % shape.mask_size, texel / shape.mask_size};
        const kernel::Words masks{field.masks.data()}, numbers{field.mask_numbers.data()};
        const int words = shape.words_per_mask;
        traced.visible_bit =
            kernel::is_set(kernel::load_mask(masks, kernel::mask_start(shape, numbers, cell.index, 0), words), texel);
        traced.occluded_bit =
            kernel::is_set(kernel::load_mask(masks, kernel::mask_start(shape, numbers, cell.index, 1), words), texel);
        decision = request.culling == Culling::both
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

}  // namespace

SampleTrace trace_sample(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                         int x, int y, int sample) {
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(request.surfaces->size.width) +
                       static_cast<std::size_t>(x);
    const Asked asked =
        asked_sample(request, pixel, request.pattern->tile_place(x, y), static_cast<std::size_t>(sample));
    SampleTrace traced;
    {
        kernel::Recording recording;
        decide(field, request, asked, traced);
        traced.trace.steps = std::move(recording.steps);
    }
    const vec3 start = lifted_off(embree, asked.position, asked.normal);
    const float reach_m =
        std::max(glm::length(field.shape.cell_m * vec3(field.shape.cells_x, field.shape.cells_y, field.shape.cells_z)),
                 field.shape.cell_m);
    traced.trace.ray = {start, start + reach_m * asked.direction};
    traced.blocked_in_truth = is_blocked(embree, start, asked.direction);
    const bool was_asked = traced.fate == Fate::traced || traced.fate == Fate::outside_cells;
    traced.trace.blocked = was_asked ? traced.blocked_in_truth : traced.fate != Fate::taken_for_open;
    // What is traced in the occluded region is subtracted where it is blocked; elsewhere open rays add.
    const bool subtracts =
        request.culling == Culling::label && traced.label == 0 && traced.cell_index != kernel::no_cell;
    const float sign = subtracts ? (traced.trace.blocked ? -1.0f : 0.0f) : (traced.trace.blocked ? 0.0f : 1.0f);
    traced.adds = sign * std::numbers::pi_v<float> / static_cast<float>(request.pattern->samples) *
                  radiance(request.light, asked.direction);
    for (TraceStep& step : traced.trace.steps) {
        if (step.paper == "Algorithm 2, line 3") step.geometry.push_back(box_of(field.shape, traced.cell));
        step.geometry.push_back({"ray", TraceShape::segment, {traced.trace.ray.origin, traced.trace.ray.target}});
    }
    return traced;
}

NearestSamples nearest_samples(const Scene& scene, const EmbreeScene& embree, const BakeOptions& options,
                               const SampleTrace& traced, Progress& progress) {
    const FieldShape shape = make_shape(scene.bounds, options.cell_m, options.mask_size);
    const CellPoints all = place_points(scene, shape, options, progress);
    NearestSamples result;
    const std::uint32_t number = cell_number(shape, traced.cell);
    const auto found = std::ranges::lower_bound(all.cells, number);
    if (found == all.cells.end() || *found != number) return result;
    const auto cell = static_cast<std::size_t>(found - all.cells.begin());
    const vec3 direction = glm::normalize(traced.trace.ray.target - traced.trace.ray.origin);
    result.nearest_m = result.should_have_seen_m = std::numeric_limits<float>::infinity();
    for (std::uint32_t k = all.first[cell]; k < all.first[cell + 1]; ++k) {
        const SurfacePoint& point = all.points[k];
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
