// The discrete visibility field (Xu 2022, section 3.1): which directions the points of each grid cell see and which
// they do not. Two bits a texel, only for cells that hold point samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shaders/visibility_field_data.h"
#include "techniques/base/types.h"

namespace sightlines::visibility_field {

/// The words behind the last mask that wide kernels may read.
constexpr std::size_t spare_words = 32;

/// Immutable once baked.
struct VisibilityField {
    FieldShape shape{};
    std::vector<FieldBrick> bricks;           ///< [z][y][x]
    std::vector<std::uint32_t> mask_numbers;  ///< [cells][visible, occluded]
    std::vector<std::uint32_t> masks;         ///< [masks][words_per_mask], each once; then spare_words zeros
    std::uint32_t cells = 0;                  ///< that hold masks
    std::uint64_t points = 0;                 ///< samples that were cast from
    std::uint64_t rays = 0;                   ///< that the masks stand for
    std::uint32_t kept_cells = 0;             ///< of a scene that moves: those with the masks of what stands still
    std::uint64_t rays_again = 0;             ///< ... that were cast for this moment
    double place_seconds = 0.0;               ///< for placing the samples
    double cast_seconds = 0.0;                ///< for casting and merging

    std::size_t bytes() const {
        return bricks.size() * sizeof(FieldBrick) + (mask_numbers.size() + masks.size()) * sizeof(std::uint32_t);
    }
};

/// A cell that holds masks.
struct OccupiedCell {
    ivec3 place{0};
    std::uint32_t index = 0;
    std::uint32_t label = 0;
};

/// The grid of cells with side `cell_m` round the bounds, their middle in its middle. Empty bounds give one cell. The
/// grid must have been checked (memory_need.h) where it could be too large.
FieldShape make_shape(const Box3& bounds, float cell_m, int mask_size);

/// How many bricks a grid has.
std::size_t brick_count(const FieldShape& shape);

/// The cells that hold masks, in the order of their masks.
std::vector<OccupiedCell> occupied_cells(const VisibilityField& field);

/// The words of a cell's mask, `which` 0 the visibility mask, 1 the occlusion mask.
std::span<const std::uint32_t> mask_words(const VisibilityField& field, std::uint32_t cell, int which);

/// The bit of a texel.
bool mask_bit(std::span<const std::uint32_t> words, int mask_size, int column, int row);

/// The share of the texels that are set in the occlusion mask (equation 7).
double occlusion_ratio(const VisibilityField& field, std::uint32_t cell);

/// The box of a cell, m.
Box3 cell_box(const FieldShape& shape, ivec3 place);

}  // namespace sightlines::visibility_field
