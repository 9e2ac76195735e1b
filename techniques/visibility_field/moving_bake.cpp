#include "techniques/visibility_field/moving_bake.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "techniques/base/parallel.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/casting.h"
#include "techniques/visibility_field/moving_reach.h"
#include "techniques/visibility_field/surface_cells.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::size_t cells_per_task = 32;
constexpr std::size_t most_boxes = 32;
constexpr double least_share = 1.0 / 32.0;
constexpr std::uint64_t changing_seed =
    0x6d6f766573u;  // so that samples that move lie otherwise than those beside them
constexpr std::uint32_t none = 0xffffffffu;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

FieldShape shape_of(const Scene& scene, const BakeOptions& options) {
    return make_shape(bounds_of_motion(scene), options.cell_m, options.mask_size);
}

/// A cell of the moment: which of the fixed and which of the moving samples' cells it is; none: of neither.
struct MomentCell {
    std::uint32_t number = 0;  ///< as CellPoints numbers cells
    std::uint32_t fixed = none, changing = none;
};

std::vector<MomentCell> moment_cells(const CellPoints& fixed, const CellPoints& changing) {
    std::vector<MomentCell> cells;
    cells.reserve(fixed.cells.size() + changing.cells.size());
    for (std::uint32_t f = 0, c = 0; f < fixed.cells.size() || c < changing.cells.size();) {
        const std::uint32_t next_fixed = f < fixed.cells.size() ? fixed.cells[f] : none;
        const std::uint32_t next_changing = c < changing.cells.size() ? changing.cells[c] : none;
        MomentCell cell{std::min(next_fixed, next_changing), none, none};
        if (next_fixed == cell.number) cell.fixed = f++;
        if (next_changing == cell.number) cell.changing = c++;
        cells.push_back(cell);
    }
    return cells;
}

/// What all cells of a moment are baked by.
struct MomentBake {
    const FixedField& fixed;
    const CellPoints& changing;  ///< samples of what moves
    const EmbreeScene& whole;    ///< all surfaces
    const EmbreeScene& moving;   ///< what moves
    const MovingReach reach;
    const BakeOptions& options;
    const RaySet set;
};

/// What the cells of a task came to: those whose masks are not what stands still has.
struct BakedCells {
    std::vector<std::size_t> cells;
    FinishedMasks masks;
    std::uint64_t rays = 0;  ///< that were cast
};

std::uint64_t ray_seed(const BakeOptions& options) { return options.seed ^ casting_seed; }

/// The boxes of what moves that the fixed samples of a cell may see.
std::vector<Box3> boxes_of(const MomentBake& bake, const MomentCell& cell) {
    const VisibilityField& field = bake.fixed.field;
    const Box3 box = cell_box(field.shape, cell_place(field.shape, cell.number));
    std::vector<Box3> boxes;
    for (std::uint32_t left = boxes_in_reach(bake.reach, box, mask_words(field, cell.fixed, 0)); left != 0;
         left &= left - 1)
        boxes.push_back(bake.reach.boxes[static_cast<std::size_t>(std::countr_zero(left))]);
    return boxes;
}

/// The fixed samples of a cell: what blocked their rays before still does, and the others are cast at what moves.
CastCounts cast_fixed(const MomentBake& bake, const MomentCell& cell, std::span<const Box3> boxes, CastingRoom& room,
                      MaskPair& parts) {
    const FixedField& fixed = bake.fixed;
    const std::size_t words = words_of_rays(bake.set.rays);
    CastCounts counts;
    for (std::uint32_t k = fixed.points.first[cell.fixed]; k < fixed.points.first[cell.fixed + 1]; ++k) {
        const SurfacePoint& point = fixed.points.points[k];
        aim_from(bake.set, point, casting_size(bake.options), ray_seed(bake.options), room);
        std::copy_n(&fixed.blocked[k * words], words, room.blocked.begin());
        const CastCounts one =
            cast_into(boxes, bake.moving, bake.set, point.position + fixed.lift_m * point.normal, room);
        counts.cast += one.cast;
        counts.blocked += one.blocked;
        mark_answers(bake.set, room, parts.visible, parts.occluded);
    }
    return counts;
}

/// The moving samples of a cell.
std::size_t cast_changing(const MomentBake& bake, const MomentCell& cell, CastingRoom& room, MaskPair& parts) {
    const CellPoints& points = bake.changing;
    const std::uint32_t first = points.first[cell.changing], last = points.first[cell.changing + 1];
    for (std::uint32_t k = first; k < last; ++k)
        cast_from(bake.whole, bake.set, points.points[k], casting_size(bake.options), ray_seed(bake.options), room,
                  parts.visible, parts.occluded);
    return (last - first) * static_cast<std::size_t>(bake.set.rays);
}

/// The texels of a cell whose masks are not those of what stands still.
std::optional<MaskPair> cast_cell(const MomentBake& bake, const MomentCell& cell, CastingRoom& room,
                                  std::uint64_t& rays) {
    const std::vector<Box3> boxes = cell.fixed != none ? boxes_of(bake, cell) : std::vector<Box3>{};
    if (cell.changing == none && boxes.empty()) return std::nullopt;
    MaskPair parts;
    CastCounts counts;
    if (cell.fixed != none) counts = cast_fixed(bake, cell, boxes, room, parts);
    rays += counts.cast;
    if (cell.changing == none && counts.blocked == 0) return std::nullopt;
    if (cell.changing != none) rays += cast_changing(bake, cell, room, parts);
    return parts;
}

/// By tasks of cells_per_task cells, in their order.
std::vector<BakedCells> cast_moment(const MomentBake& bake, const std::vector<MomentCell>& cells, Progress& progress) {
    std::vector<BakedCells> baked((cells.size() + cells_per_task - 1) / cells_per_task);
    progress.begin("casting rays that may have changed", static_cast<std::int64_t>(cells.size()));
    parallel_for(static_cast<std::int64_t>(baked.size()), bake.options.threads, [&](std::int64_t task) {
        CastingRoom room(bake.set);
        BakedCells& own = baked[static_cast<std::size_t>(task)];
        const std::size_t begin = static_cast<std::size_t>(task) * cells_per_task;
        for (std::size_t cell = begin; cell < std::min(begin + cells_per_task, cells.size()); ++cell) {
            if (const std::optional<MaskPair> parts = cast_cell(bake, cells[cell], room, own.rays)) {
                own.cells.push_back(cell);
                add_cell(*parts, bake.options, own.masks);
            }
            progress.advance();
        }
    });
    return baked;
}

/// The field of the moment: the masks of what stands still, and after them those that are new.
void assemble(const FixedField& fixed, const std::vector<MomentCell>& cells, const std::vector<BakedCells>& baked,
              VisibilityField& field) {
    const auto words = static_cast<std::size_t>(field.shape.words_per_mask);
    std::vector<std::uint32_t> numbers(cells.size());
    std::vector<std::uint8_t> labels(cells.size());
    field.mask_numbers.resize(2 * cells.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
        numbers[k] = cells[k].number;
        if (cells[k].fixed == none) continue;
        labels[k] = fixed.labels[cells[k].fixed];
        std::copy_n(&fixed.field.mask_numbers[std::size_t{2} * cells[k].fixed], 2, &field.mask_numbers[2 * k]);
    }
    field.masks.assign(fixed.field.masks.begin(), fixed.field.masks.end() - spare_words);
    MaskNumbers added;
    std::size_t baked_cells = 0;
    auto next = static_cast<std::uint32_t>(field.masks.size() / words);
    for (const BakedCells& part : baked) {
        for (std::size_t k = 0; k < 2 * part.cells.size(); ++k) {
            const auto mask = std::span(part.masks.words).subspan(k * words, words);
            std::uint32_t& number = field.mask_numbers[2 * part.cells[k / 2] + k % 2];
            if (const auto known = fixed.mask_numbers.find(mask_bytes(mask)); known != fixed.mask_numbers.end()) {
                number = known->second;
                continue;
            }
            const auto [known, is_new] = added.try_emplace(mask_bytes(mask), next);
            number = known->second;
            if (!is_new) continue;
            field.masks.insert(field.masks.end(), mask.begin(), mask.end());
            ++next;
        }
        for (std::size_t k = 0; k < part.cells.size(); ++k) labels[part.cells[k]] = part.masks.labels[k];
        field.rays_again += part.rays;
        baked_cells += part.cells.size();
    }
    field.masks.resize(field.masks.size() + spare_words);
    set_cells(numbers, labels, field);
    field.kept_cells = static_cast<std::uint32_t>(cells.size() - baked_cells);
}

/// A little larger, for rounding.
std::vector<Box3> grown(std::vector<Box3> boxes, float by_m) {
    for (Box3& box : boxes) {
        box.lowest -= by_m;
        box.highest += by_m;
    }
    return boxes;
}

/// The field's masks by their bytes, which stay where they are.
MaskNumbers numbers_of(const VisibilityField& field) {
    MaskNumbers numbers;
    const auto words = static_cast<std::size_t>(field.shape.words_per_mask);
    const std::size_t count = (field.masks.size() - spare_words) / words;
    for (std::size_t k = 0; k < count; ++k)
        numbers.emplace(mask_bytes(std::span(field.masks).subspan(k * words, words)), static_cast<std::uint32_t>(k));
    return numbers;
}

/// Masks of moments are dilated: what probes found would have to be found again wherever something moved.
BakeOptions without_probes(BakeOptions options) {
    options.probes = 0;
    return options;
}

BakeOptions with_share(BakeOptions options, double share) {
    options.points = static_cast<std::uint32_t>(std::lround(options.points / (1.0 + share)));
    return options;
}

}  // namespace

double changing_share(const Scene& scene) {
    const double standing = sampled_area(scene, PartChoice::fixed);
    if (!(standing > 0.0)) return std::numeric_limits<double>::infinity();
    const double share = sampled_area(scene, PartChoice::changing) / standing;
    return share < least_share ? 0.0 : std::exp2(std::round(std::log2(share)));
}

std::shared_ptr<const FixedField> bake_fixed(const Scene& scene, const BakeOptions& options, Progress& progress) {
    check_bake(scene, options);
    const auto start = std::chrono::steady_clock::now();
    auto fixed = std::make_shared<FixedField>();
    const FieldShape shape = shape_of(scene, options);
    fixed->field.shape = shape;
    fixed->changing_share = changing_share(scene);
    fixed->embree = build_embree_scene(scene, EmbreeUse::benchmark, options.threads, progress, PartChoice::fixed);
    fixed->lift_m = lift_m(*fixed->embree);
    fixed->points = place_points(scene, shape, with_share(options, fixed->changing_share), progress, PartChoice::fixed);
    const CellPoints& points = fixed->points;
    FinishedMasks masks = cast_cells(*fixed->embree, points, without_probes(options), progress, &fixed->blocked);
    assemble(points, masks, fixed->field);
    fixed->mask_numbers = numbers_of(fixed->field);
    fixed->labels = std::move(masks.labels);
    fixed->seconds = seconds_since(start);
    return fixed;
}

bool serves(const FixedField& fixed, const Scene& scene, const BakeOptions& options) {
    const FieldShape shape = shape_of(scene, options);
    const FieldShape& own = fixed.field.shape;
    return shape.origin == own.origin && shape.cells_x == own.cells_x && shape.cells_y == own.cells_y &&
           shape.cells_z == own.cells_z && changing_share(scene) == fixed.changing_share;
}

VisibilityField bake_moment(const FixedField& fixed, const Scene& scene, const EmbreeScene& embree,
                            const BakeOptions& options, Progress& progress, CellPoints* kept) {
    assert(serves(fixed, scene, options));
    const auto start = std::chrono::steady_clock::now();
    VisibilityField field;
    field.shape = fixed.field.shape;
    BakeOptions placing = options;
    placing.seed ^= changing_seed;
    const std::optional<PointDensity> density =
        fixed.points.cells.empty() ? std::nullopt : std::optional(fixed.points.density);
    CellPoints changing = place_points(scene, field.shape, placing, progress, PartChoice::changing, density);
    const std::vector<MomentCell> cells = moment_cells(fixed.points, changing);
    field.place_seconds = seconds_since(start);
    const auto moving =
        build_embree_scene(scene, EmbreeUse::benchmark, options.threads, progress, PartChoice::changing);
    std::vector<Box3> boxes = grown(changing_boxes(scene, most_boxes), lift_m(embree));
    const MomentBake bake{fixed,
                          changing,
                          embree,
                          *moving,
                          make_reach(field.shape, std::move(boxes)),
                          options,
                          make_ray_set(options.rays)};
    assemble(fixed, cells, cast_moment(bake, cells, progress), field);
    field.points = fixed.points.points.size() + changing.points.size();
    field.rays = field.points * static_cast<std::uint64_t>(options.rays);
    field.cast_seconds = seconds_since(start) - field.place_seconds;
    if (kept != nullptr) *kept = std::move(changing);
    return field;
}

CellPoints samples_in(const FieldShape& shape, ivec3 place, const CellPoints& samples, const CellPoints* fixed) {
    CellPoints found{{cell_number(shape, place)}, {0}, {}, samples.density};
    for (const CellPoints* from : {fixed, &samples}) {
        if (from == nullptr) continue;
        const auto at = std::ranges::lower_bound(from->cells, found.cells.front());
        if (at == from->cells.end() || *at != found.cells.front()) continue;
        const auto cell = static_cast<std::size_t>(at - from->cells.begin());
        found.points.insert(found.points.end(), from->points.begin() + from->first[cell],
                            from->points.begin() + from->first[cell + 1]);
    }
    found.first.push_back(static_cast<std::uint32_t>(found.points.size()));
    return found;
}

}  // namespace sightlines::visibility_field
