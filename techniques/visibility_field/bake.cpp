#include "techniques/visibility_field/bake.h"

#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/visibility_field/casting.h"
#include "techniques/visibility_field/cell_masks.h"
#include "techniques/visibility_field/memory_need.h"
#include "techniques/visibility_field/moving_bake.h"

namespace sightlines::visibility_field {
namespace {

constexpr int most_rays = 4096;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void check_bake(const Scene& scene, const BakeOptions& options) {
    const auto refuse = [](const std::string& what, const std::string& range) {
        throw InputError("visibility field", what, "is out of range", "choose " + range);
    };
    if (!(options.cell_m > 0.0f) || !std::isfinite(options.cell_m)) refuse("cell size", "more than 0 m");
    if (options.mask_size < smallest_mask || options.mask_size > largest_mask) refuse("mask size", "8 to 64 texels");
    if (options.rays < 1 || options.rays > most_rays) refuse("rays per sample", "1 to 4,096");
    if (options.probes < 0 || options.probes > most_rays) refuse("probes", "0 to 4,096");
    if (!(options.dilation >= 0.0f && options.dilation <= 2.0f)) refuse("dilation", "0 to 2 texels");
    require_memory(scene, options, available_memory_bytes());
}

VisibilityField bake(const Scene& scene, const EmbreeScene& embree, const BakeOptions& options, Progress& progress,
                     CellPoints* kept) {
    check_bake(scene, options);
    if (anything_moves(scene))
        return bake_moment(*bake_fixed(scene, options, progress), scene, embree, options, progress, kept);
    VisibilityField field;
    field.shape = make_shape(scene.bounds, options.cell_m, options.mask_size);
    const auto start = std::chrono::steady_clock::now();
    CellPoints points = place_points(scene, field.shape, options, progress);
    field.place_seconds = seconds_since(start);
    const FinishedMasks masks = cast_cells(embree, points, options, progress);
    assemble(points, masks, field);
    field.rays = field.points * static_cast<std::uint64_t>(options.rays) + masks.probes;
    field.cast_seconds = seconds_since(start) - field.place_seconds;
    if (kept != nullptr) *kept = std::move(points);
    return field;
}

CellSteps bake_steps(CellPoints samples, const EmbreeScene& embree, const BakeOptions& options) {
    CellSteps steps;
    const RaySet set = make_ray_set(options.rays);
    CastingRoom room(set);
    const auto packed = [&](const MaskRows& rows) {
        std::vector<std::uint32_t> words(words_per_mask(options.mask_size));
        pack(reduced(rows, options.mask_size, casting_steps(options.mask_size)), options.mask_size, words);
        return words;
    };
    for (const SurfacePoint& point : samples.points) {
        MaskPair masks;
        cast_from(embree, set, point, casting_size(options), options.seed ^ casting_seed, room, masks.visible,
                  masks.occluded);
        steps.visible.push_back(packed(masks.visible));
        steps.occluded.push_back(packed(masks.occluded));
    }
    steps.points = std::move(samples);
    return steps;
}

}  // namespace sightlines::visibility_field
