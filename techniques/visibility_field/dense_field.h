// The paper's own layout (section 4.2, Figure 4): a byte a texel, for every cell of the grid, each map padded by a
// texel.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/base/image.h"
#include "techniques/visibility_field/field.h"

namespace sightlines::visibility_field {

constexpr std::uint8_t dense_visible = 128, dense_occluded = 64, dense_label = 32;

/// One layer for each y of the grid: the maps of cells (x, z) in columns and rows, each (mask_size + 2) texels wide and
/// high.
struct DenseField {
    FieldShape shape{};
    std::vector<std::uint8_t> texels;

    int layer_width() const { return shape.cells_x * (shape.mask_size + 2); }
    int layer_height() const { return shape.cells_z * (shape.mask_size + 2); }
    /// The texel at (column, row) of a cell's map; -1 and mask_size are its padding.
    std::size_t place(ivec3 cell, int column, int row) const;
};

/// Bytes that the dense layout of a grid takes.
std::uint64_t dense_bytes(const FieldShape& shape);

/// The same field, laid out as in the paper. The padding repeats the texels that lie beyond the edge on the sphere.
/// EnvironmentError where there is not that much memory.
DenseField to_dense(const VisibilityField& field);

/// What the renderer asks of a cell, read from the dense bytes: whether it holds masks (a cell without has no bit at
/// all), its label, and both masks packed as in VisibilityField.
struct DenseCell {
    bool occupied = false;
    std::uint32_t label = 0;
    std::vector<std::uint32_t> visible, occluded;
};
DenseCell dense_cell(const DenseField& dense, ivec3 cell);

/// One layer as in Figure 4: the byte as a grey value.
ImageScalar dense_layer(const DenseField& dense, int y);

/// The same layer of a field that was not laid out so.
ImageScalar dense_layer(const VisibilityField& field, int y);

}  // namespace sightlines::visibility_field
