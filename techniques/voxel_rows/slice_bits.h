// One slice (constant v) of a voxelization as a square matrix of bits, on its way from marks to rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

/// N x N bits, padded to whole 64-bit words; bit u of row w is bit u % 64 of rows[w * words() + u / 64].
struct SliceBits {
    explicit SliceBits(int resolution)
        : blocks((resolution + 63) / 64), rows(static_cast<std::size_t>(blocks) * blocks * 64) {}

    static constexpr int most_needed = 128;

    int stride() const { return blocks * 64; }  ///< bytes from one row of marks to the next
    std::size_t marks() const { return static_cast<std::size_t>(stride()) * stride(); }
    /// Bit set where the byte is at least `needed` (1 to most_needed). bytes: [marks()].
    void pack(std::span<const std::uint8_t> bytes, int needed);
    void transpose_of(const SliceBits& other);

    int blocks;                       ///< 64-bit words in a row, and 64-row blocks in a column
    std::vector<std::uint64_t> rows;  ///< [64 * blocks][blocks]
};

/// Writes the slice's rows to their places: row w of the slice is the row (v, w) of `direction`.
void store_slice(RowArray& array, const RowShape& shape, int direction, int v, const SliceBits& bits);

}  // namespace sightlines::voxel_rows
