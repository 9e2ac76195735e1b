#include "techniques/visibility_field/dense_field.h"

#include <algorithm>

#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/visibility_field/memory_need.h"

namespace sightlines::visibility_field {
namespace {

/// The texel inside the map that lies at (column, row) of the padded one.
ivec2 across_edges(int column, int row, int size) {
    if (row < 0 || row >= size) {
        row = std::clamp(row, 0, size - 1);
        column = size - 1 - column;
    }
    if (column < 0 || column >= size) {
        column = std::clamp(column, 0, size - 1);
        row = size - 1 - row;
    }
    return {column, row};
}

/// The bytes of a cell, padding included, as the map of the cell at `place` of the dense layout.
void write_cell(const VisibilityField& field, const OccupiedCell& cell, DenseField& dense, ivec3 place) {
    const int size = field.shape.mask_size;
    const auto visible = mask_words(field, cell.index, 0), occluded = mask_words(field, cell.index, 1);
    for (int row = -1; row <= size; ++row) {
        for (int column = -1; column <= size; ++column) {
            const ivec2 inside = across_edges(column, row, size);
            int byte = cell.label != 0 ? dense_label : 0;
            if (mask_bit(visible, size, inside.x, inside.y)) byte |= dense_visible;
            if (mask_bit(occluded, size, inside.x, inside.y)) byte |= dense_occluded;
            dense.texels[dense.place(place, column, row)] = static_cast<std::uint8_t>(byte);
        }
    }
}

}  // namespace

std::size_t DenseField::place(ivec3 cell, int column, int row) const {
    const int map = shape.mask_size + 2;
    const auto x = static_cast<std::size_t>(cell.x * map + column + 1);
    const auto y = static_cast<std::size_t>(cell.z * map + row + 1);
    const auto layer = static_cast<std::size_t>(layer_width()) * static_cast<std::size_t>(layer_height());
    return static_cast<std::size_t>(cell.y) * layer + y * static_cast<std::size_t>(layer_width()) + x;
}

std::uint64_t dense_bytes(const FieldShape& shape) {
    const auto map = static_cast<std::uint64_t>(shape.mask_size + 2);
    return static_cast<std::uint64_t>(shape.cells_x) * static_cast<std::uint64_t>(shape.cells_y) *
           static_cast<std::uint64_t>(shape.cells_z) * map * map;
}

DenseField to_dense(const VisibilityField& field) {
    const std::uint64_t needed = dense_bytes(field.shape), available = available_memory_bytes();
    if (needed > available)
        throw EnvironmentError("memory", "the dense layout takes " + memory_text(static_cast<double>(needed)) +
                                             ", and " + memory_text(static_cast<double>(available)) + " are free");
    DenseField dense{field.shape, std::vector<std::uint8_t>(needed)};
    for (const OccupiedCell& cell : occupied_cells(field)) write_cell(field, cell, dense, cell.place);
    return dense;
}

DenseCell dense_cell(const DenseField& dense, ivec3 cell) {
    const int size = dense.shape.mask_size;
    const auto words = static_cast<std::size_t>(dense.shape.words_per_mask);
    DenseCell result{false, 0, std::vector<std::uint32_t>(words), std::vector<std::uint32_t>(words)};
    const std::uint8_t middle = dense.texels[dense.place(cell, size / 2, size / 2)];
    result.label = (middle & dense_label) != 0 ? 1u : 0u;
    for (int row = 0; row < size; ++row) {
        const std::uint8_t* texels = &dense.texels[dense.place(cell, 0, row)];
        for (int column = 0; column < size; ++column) {
            const int texel = row * size + column;
            const auto word = static_cast<std::size_t>(texel / 32);
            result.occupied = result.occupied || texels[column] != 0;
            result.visible[word] |= std::uint32_t{(texels[column] & dense_visible) != 0} << (texel % 32);
            result.occluded[word] |= std::uint32_t{(texels[column] & dense_occluded) != 0} << (texel % 32);
        }
    }
    return result;
}

ImageScalar dense_layer(const DenseField& dense, int y) {
    ImageScalar layer({dense.layer_width(), dense.layer_height()});
    const std::size_t first = static_cast<std::size_t>(y) * layer.pixels.size();
    for (std::size_t p = 0; p < layer.pixels.size(); ++p)
        layer.pixels[p] = static_cast<float>(dense.texels[first + p]) / 255.0f;
    return layer;
}

ImageScalar dense_layer(const VisibilityField& field, int y) {
    DenseField layer{field.shape, {}};
    layer.shape.cells_y = 1;
    layer.texels.resize(dense_bytes(layer.shape));
    for (const OccupiedCell& cell : occupied_cells(field))
        if (cell.place.y == y) write_cell(field, cell, layer, {cell.place.x, 0, cell.place.z});
    return dense_layer(layer, 0);
}

}  // namespace sightlines::visibility_field
