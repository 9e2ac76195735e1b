#include "techniques/visibility_field/bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/base/parallel.h"
#include "techniques/visibility_field/casting.h"
#include "techniques/visibility_field/mask_rows.h"
#include "techniques/visibility_field/memory_need.h"
#include "techniques/visibility_field/surface_cells.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::int64_t cells_per_task = 16;
constexpr int most_rays = 4096;

void check_options(const BakeOptions& options) {
    const auto refuse = [](const std::string& what, const std::string& range) {
        throw InputError("visibility field", what, "is out of range", "choose " + range);
    };
    if (!(options.cell_m > 0.0f) || !std::isfinite(options.cell_m)) refuse("cell size", "more than 0 m");
    if (options.mask_size < smallest_mask || options.mask_size > largest_mask) refuse("mask size", "8 to 64 texels");
    if (options.rays < 1 || options.rays > most_rays) refuse("rays per sample", "1 to 4,096");
    if (!(options.dilation >= 0.0f && options.dilation <= 2.0f)) refuse("dilation", "0 to 2 texels");
}

/// Texels along a side of the masks that rays fall into.
int casting_size(const BakeOptions& options) { return options.mask_size * casting_steps(options.mask_size); }

/// The two masks of a cell while it is baked.
struct MaskPair {
    MaskRows visible{}, occluded{};
};

void cast_points(const EmbreeScene& embree, const RaySet& set, const CellPoints& points, std::size_t cell,
                 const BakeOptions& options, CastingRoom& room, MaskPair& masks) {
    // Merging as the rays fall (equations 5 and 6) is the OR of the points' own masks.
    for (std::uint32_t k = points.first[cell]; k < points.first[cell + 1]; ++k)
        cast_from(embree, set, points.points[k], casting_size(options), options.seed ^ casting_seed, k, room,
                  masks.visible, masks.occluded);
}

/// From the parts of texels that rays fell into to texels, dilated. Dilating the merged mask is the same as merging
/// dilated ones.
MaskRows finished(MaskRows parts, const BakeOptions& options) {
    const int steps = casting_steps(options.mask_size);
    const auto dilations = static_cast<int>(std::lround(options.dilation * static_cast<float>(steps)));
    for (int k = 0; k < dilations; ++k) parts = dilated(parts, options.mask_size * steps);
    return reduced(parts, options.mask_size, steps);
}

/// Equation 8, or the smaller region.
bool occlusion_label(const MaskPair& masks, const BakeOptions& options) {
    const int occluded = texels_set(masks.occluded);
    if (options.label == LabelRule::texels) return 2 * occluded > options.mask_size * options.mask_size;
    return occluded > texels_set(masks.visible);
}

/// Marks the cells that hold points, and numbers them.
void number_cells(const CellPoints& points, VisibilityField& field) {
    field.bricks.resize(brick_count(field.shape), FieldBrick{});
    for (std::size_t k = 0; k < points.cells.size(); ++k) {
        FieldBrick& brick = field.bricks[points.cells[k] / 64];
        const std::uint32_t bit = points.cells[k] % 64;
        if ((brick.occupied_low | brick.occupied_high) == 0) brick.first_cell = static_cast<std::uint32_t>(k);
        (bit < 32 ? brick.occupied_low : brick.occupied_high) |= 1u << (bit % 32);
    }
    field.cells = static_cast<std::uint32_t>(points.cells.size());
    field.points = points.points.size();
}

void set_labels(const CellPoints& points, const std::vector<std::uint8_t>& labels, VisibilityField& field) {
    for (std::size_t k = 0; k < labels.size(); ++k) {
        if (labels[k] == 0) continue;
        FieldBrick& brick = field.bricks[points.cells[k] / 64];
        const std::uint32_t bit = points.cells[k] % 64;
        (bit < 32 ? brick.label_low : brick.label_high) |= 1u << (bit % 32);
    }
}

/// Stores each mask once, in the order in which they come. Half of Sponza's are copies: cells without sky, for one.
void store_masks(const std::vector<std::uint32_t>& masks, VisibilityField& field) {
    const auto words = static_cast<std::size_t>(field.shape.words_per_mask);
    std::unordered_map<std::string_view, std::uint32_t> numbers;
    for (std::size_t start = 0; start < masks.size(); start += words) {
        const std::string_view bytes(reinterpret_cast<const char*>(&masks[start]), words * sizeof(std::uint32_t));
        const auto [known, is_new] = numbers.try_emplace(bytes, static_cast<std::uint32_t>(numbers.size()));
        field.mask_numbers.push_back(known->second);
        if (is_new) field.masks.insert(field.masks.end(), &masks[start], &masks[start] + words);
    }
    field.masks.resize(field.masks.size() + spare_words);
    field.masks.shrink_to_fit();
}

void cast_all(const EmbreeScene& embree, const CellPoints& points, const BakeOptions& options, VisibilityField& field,
              Progress& progress) {
    const RaySet set = make_ray_set(options.rays);
    const auto words = static_cast<std::size_t>(field.shape.words_per_mask);
    std::vector<std::uint32_t> masks(2 * points.cells.size() * words);
    std::vector<std::uint8_t> labels(points.cells.size());
    progress.begin("casting rays from point samples", static_cast<std::int64_t>(points.points.size()));
    const std::int64_t tasks = (static_cast<std::int64_t>(labels.size()) + cells_per_task - 1) / cells_per_task;
    parallel_for(tasks, options.threads, [&](std::int64_t task) {
        CastingRoom room(set);
        const auto begin = static_cast<std::size_t>(task * cells_per_task);
        for (std::size_t k = begin; k < std::min(begin + cells_per_task, labels.size()); ++k) {
            MaskPair pair;
            cast_points(embree, set, points, k, options, room, pair);
            pair = {finished(pair.visible, options), finished(pair.occluded, options)};
            labels[k] = occlusion_label(pair, options);
            pack(pair.visible, options.mask_size, std::span(masks).subspan(2 * k * words, words));
            pack(pair.occluded, options.mask_size, std::span(masks).subspan((2 * k + 1) * words, words));
            progress.advance(points.first[k + 1] - points.first[k]);
        }
    });
    store_masks(masks, field);
    set_labels(points, labels, field);
    field.rays = field.points * static_cast<std::uint64_t>(options.rays);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int casting_steps(int mask_size) { return largest_mask / mask_size; }

VisibilityField bake(const Scene& scene, const EmbreeScene& embree, const BakeOptions& options, Progress& progress,
                     CellPoints* kept) {
    check_options(options);
    require_memory(scene.bounds, sampled_area(scene), scene.triangles.size(), options, available_memory_bytes());
    VisibilityField field;
    field.shape = make_shape(scene.bounds, options.cell_m, options.mask_size);
    const auto start = std::chrono::steady_clock::now();
    CellPoints points = place_points(scene, field.shape, options, progress);
    number_cells(points, field);
    field.place_seconds = seconds_since(start);
    cast_all(embree, points, options, field, progress);
    field.cast_seconds = seconds_since(start) - field.place_seconds;
    if (kept != nullptr) *kept = std::move(points);
    return field;
}

CellSteps bake_steps(const CellPoints& all, const FieldShape& shape, const EmbreeScene& embree,
                     const BakeOptions& options, ivec3 place) {
    CellSteps steps;
    const auto found = std::ranges::lower_bound(all.cells, cell_number(shape, place));
    if (found == all.cells.end() || *found != cell_number(shape, place)) return steps;
    const auto cell = static_cast<std::size_t>(found - all.cells.begin());
    const RaySet set = make_ray_set(options.rays);
    CastingRoom room(set);
    const auto packed = [&](const MaskRows& rows) {
        std::vector<std::uint32_t> words(static_cast<std::size_t>(shape.words_per_mask));
        pack(reduced(rows, options.mask_size, casting_steps(options.mask_size)), options.mask_size, words);
        return words;
    };
    for (std::uint32_t k = all.first[cell]; k < all.first[cell + 1]; ++k) {
        MaskPair masks;
        cast_from(embree, set, all.points[k], casting_size(options), options.seed ^ casting_seed, k, room,
                  masks.visible, masks.occluded);
        steps.visible.push_back(packed(masks.visible));
        steps.occluded.push_back(packed(masks.occluded));
        steps.points.points.push_back(all.points[k]);
    }
    steps.points.cells = {*found};
    steps.points.first = {0, static_cast<std::uint32_t>(steps.points.points.size())};
    return steps;
}

CellSteps bake_steps(const Scene& scene, const EmbreeScene& embree, const BakeOptions& options, ivec3 place,
                     Progress& progress) {
    check_options(options);
    require_memory(scene.bounds, sampled_area(scene), scene.triangles.size(), options, available_memory_bytes());
    const FieldShape shape = make_shape(scene.bounds, options.cell_m, options.mask_size);
    return bake_steps(place_points(scene, shape, options, progress), shape, embree, options, place);
}

}  // namespace sightlines::visibility_field
