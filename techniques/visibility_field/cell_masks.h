// From the texels that rays fell into to a field: dilation, labels, each mask stored once (Algorithm 1, lines 15 to
// 36).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "techniques/rays/embree_scene.h"
#include "techniques/visibility_field/field.h"
#include "techniques/visibility_field/mask_rows.h"
#include "techniques/visibility_field/points.h"

namespace sightlines::visibility_field {

struct BakeOptions;

/// Texels along a side of the masks that rays fall into: casting_steps for each of the finished mask's.
int casting_size(const BakeOptions& options);

/// Words of a packed mask.
constexpr std::size_t words_per_mask(int mask_size) {
    return (static_cast<std::size_t>(mask_size * mask_size) + 31) / 32;
}

/// A cell's two masks. While rays fall: casting_size along a side; merging as they fall (equations 5 and 6) is the OR
/// of the points' own masks.
struct MaskPair {
    MaskRows visible{}, occluded{};
};

/// The finished masks of many cells.
struct FinishedMasks {
    std::vector<std::uint32_t> words;  ///< [cells][visible, occluded][words_per_mask]
    std::vector<std::uint8_t> labels;  ///< [cells]
    std::uint64_t probes = 0;          ///< rays into texels at the masks' rims
};

/// Dilates and reduces the texels that a cell's rays fell into, finds its label and keeps all that as the masks of one
/// more cell.
void add_cell(const MaskPair& parts, const BakeOptions& options, FinishedMasks& masks);

/// Algorithm 1, lines 5 to 28, for all cells: rays cast from their samples, rims probed or else dilated. `blocked`:
/// where not null, gets the answer to each ray, [points][words_of_rays].
FinishedMasks cast_cells(const EmbreeScene& embree, const CellPoints& points, const BakeOptions& options,
                         Progress& progress, std::vector<std::uint32_t>* blocked = nullptr);

/// The number of each mask by its bytes, which lie elsewhere.
using MaskNumbers = std::unordered_map<std::string_view, std::uint32_t>;

std::string_view mask_bytes(std::span<const std::uint32_t> mask);

/// Puts cells that hold masks (as CellPoints numbers them) and their labels into the field's bricks.
void set_cells(std::span<const std::uint32_t> cells, std::span<const std::uint8_t> labels, VisibilityField& field);

/// The same, and stores each mask once, in the order in which they come. The field's shape is known.
void assemble(const CellPoints& points, const FinishedMasks& masks, VisibilityField& field);

}  // namespace sightlines::visibility_field
