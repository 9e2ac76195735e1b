#include "techniques/visibility_field/cell_masks.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "techniques/base/parallel.h"
#include "techniques/visibility_field/bake.h"
#include "techniques/visibility_field/casting.h"
#include "techniques/visibility_field/rim_probes.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::size_t cells_per_task = 16;
constexpr std::size_t most_asking = 4096;  ///< points of a cell that ask each texel at its masks' rims at least once

/// From the parts of texels that rays fell into to texels, dilated. Dilating the merged mask is the same as merging
/// dilated ones.
MaskRows finished(MaskRows parts, const BakeOptions& options) {
    const int steps = casting_steps(options.mask_size);
    const auto dilations = static_cast<int>(std::lround(options.dilation * static_cast<float>(steps)));
    for (int k = 0; k < dilations; ++k) parts = dilated(parts, options.mask_size * steps);
    return reduced(parts, options.mask_size, steps);
}

MaskPair finished(const MaskPair& parts, const BakeOptions& options) {
    return {finished(parts.visible, options), finished(parts.occluded, options)};
}

/// The same, but what rays find at the rims in place of dilation. Adds to `cast`.
MaskPair probed(const EmbreeScene& embree, std::span<const SurfacePoint> points, std::uint32_t cell,
                const MaskPair& parts, const BakeOptions& options, std::uint64_t& cast) {
    const int size = options.mask_size, steps = casting_steps(size);
    MaskPair masks{reduced(parts.visible, size, steps), reduced(parts.occluded, size, steps)};
    // Points that are alone in seeing past something are not passed over.
    const std::uint64_t budget = points.size() * static_cast<std::uint64_t>(options.rays);
    const ProbeLimits limits{std::max(options.probes, static_cast<int>(std::min(points.size(), most_asking))), budget};
    cast += probe_rims(embree, points, size, limits, options.seed, cell, masks);
    return masks;
}

/// Equation 8, or the smaller region.
bool occlusion_label(const MaskRows& visible, const MaskRows& occluded, const BakeOptions& options) {
    const int hidden = texels_set(occluded);
    if (options.label == LabelRule::texels) return 2 * hidden > options.mask_size * options.mask_size;
    return hidden > texels_set(visible);
}

/// Finds the label of a cell's finished masks and keeps them as those of cell `cell`.
void keep_cell(const MaskPair& pair, const BakeOptions& options, std::size_t cell, FinishedMasks& masks) {
    const std::size_t words = words_per_mask(options.mask_size);
    masks.labels[cell] = occlusion_label(pair.visible, pair.occluded, options);
    pack(pair.visible, options.mask_size, std::span(masks.words).subspan(2 * cell * words, words));
    pack(pair.occluded, options.mask_size, std::span(masks.words).subspan((2 * cell + 1) * words, words));
}

}  // namespace

int casting_steps(int mask_size) { return largest_mask / mask_size; }

int casting_size(const BakeOptions& options) { return options.mask_size * casting_steps(options.mask_size); }

void add_cell(const MaskPair& parts, const BakeOptions& options, FinishedMasks& masks) {
    masks.labels.push_back(0);
    masks.words.resize(2 * masks.labels.size() * words_per_mask(options.mask_size));
    keep_cell(finished(parts, options), options, masks.labels.size() - 1, masks);
}

FinishedMasks cast_cells(const EmbreeScene& embree, const CellPoints& points, const BakeOptions& options,
                         Progress& progress, std::vector<std::uint32_t>* blocked) {
    const RaySet set = make_ray_set(options.rays);
    const std::size_t cells = points.cells.size(), words = words_of_rays(options.rays);
    FinishedMasks masks{std::vector<std::uint32_t>(2 * cells * words_per_mask(options.mask_size)),
                        std::vector<std::uint8_t>(cells)};
    if (blocked != nullptr) blocked->resize(points.points.size() * words);
    progress.begin("casting rays from point samples", static_cast<std::int64_t>(points.points.size()));
    const auto tasks = static_cast<std::int64_t>((cells + cells_per_task - 1) / cells_per_task);
    std::atomic<std::uint64_t> probes{0};
    parallel_for(tasks, options.threads, [&](std::int64_t task) {
        CastingRoom room(set);
        std::uint64_t own_probes = 0;
        const std::size_t begin = static_cast<std::size_t>(task) * cells_per_task;
        for (std::size_t cell = begin; cell < std::min(begin + cells_per_task, cells); ++cell) {
            MaskPair parts;
            for (std::uint32_t k = points.first[cell]; k < points.first[cell + 1]; ++k) {
                progress.check();
                cast_from(embree, set, points.points[k], casting_size(options), options.seed ^ casting_seed, room,
                          parts.visible, parts.occluded);
                if (blocked != nullptr) std::copy_n(room.blocked.begin(), words, &(*blocked)[k * words]);
            }
            const auto own =
                std::span(points.points).subspan(points.first[cell], points.first[cell + 1] - points.first[cell]);
            keep_cell(options.probes > 0 ? probed(embree, own, points.cells[cell], parts, options, own_probes)
                                         : finished(parts, options),
                      options, cell, masks);
            progress.advance(static_cast<std::int64_t>(own.size()));
        }
        probes += own_probes;
    });
    masks.probes = probes;
    return masks;
}

std::string_view mask_bytes(std::span<const std::uint32_t> mask) {
    return {reinterpret_cast<const char*>(mask.data()), mask.size_bytes()};
}

void set_cells(std::span<const std::uint32_t> cells, std::span<const std::uint8_t> labels, VisibilityField& field) {
    field.bricks.assign(brick_count(field.shape), FieldBrick{});
    for (std::size_t k = 0; k < cells.size(); ++k) {
        FieldBrick& brick = field.bricks[cells[k] / 64];
        const std::uint32_t bit = cells[k] % 64, place = 1u << (bit % 32);
        if ((brick.occupied_low | brick.occupied_high) == 0) brick.first_cell = static_cast<std::uint32_t>(k);
        (bit < 32 ? brick.occupied_low : brick.occupied_high) |= place;
        if (labels[k] != 0) (bit < 32 ? brick.label_low : brick.label_high) |= place;
    }
    field.cells = static_cast<std::uint32_t>(cells.size());
}

void assemble(const CellPoints& points, const FinishedMasks& masks, VisibilityField& field) {
    set_cells(points.cells, masks.labels, field);
    field.points = points.points.size();
    // Half of Sponza's masks are copies: cells without sky, for one.
    const auto words = static_cast<std::size_t>(field.shape.words_per_mask);
    MaskNumbers numbers;
    for (std::size_t start = 0; start < masks.words.size(); start += words) {
        const auto mask = std::span(masks.words).subspan(start, words);
        const auto [known, is_new] = numbers.try_emplace(mask_bytes(mask), static_cast<std::uint32_t>(numbers.size()));
        field.mask_numbers.push_back(known->second);
        if (is_new) field.masks.insert(field.masks.end(), mask.begin(), mask.end());
    }
    field.masks.resize(field.masks.size() + spare_words);
    field.masks.shrink_to_fit();
}

}  // namespace sightlines::visibility_field
