// One slice (constant v) of a voxelization as a square matrix of bits, on its way from marks to rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

/// What the surface leaves in each of N x N voxels, 0 to 255. Rows are padded to whole 64-bit words of voxels; a
/// margin of empty voxels lies all around, so that every voxel has neighbours.
struct SliceCounts {
    static constexpr int most = 255;
    static constexpr int margin = 64;

    explicit SliceCounts(int resolution)
        : side((resolution + 63) / 64 * 64),
          pitch(side + margin),
          bytes(static_cast<std::size_t>(pitch) * (side + 2) + margin) {}

    int place_of(int u, int w) const { return (w + 1) * pitch + margin + u; }
    /// Both leave the margin out, which stays empty.
    void clear();
    std::uint64_t sum() const;

    int side;                         ///< voxels in a padded row, and rows
    int pitch;                        ///< bytes from one row to the next
    std::vector<std::uint8_t> bytes;  ///< the voxel (u, w) is bytes[place_of(u, w)]
};

/// N x N bits, padded to whole 64-bit words; bit u of row w is bit u % 64 of rows[w * blocks + u / 64].
struct SliceBits {
    explicit SliceBits(int resolution)
        : blocks((resolution + 63) / 64), rows(static_cast<std::size_t>(blocks) * blocks * 64) {}

    /// Sets a voxel that holds at least `needed`, or does so together with the fuller of its two neighbours along
    /// `axis` (0: u, 1: w) and holds no less than that one: a surface that straddles two voxels sets the one with more
    /// of it. needed 0: sets every voxel that holds anything.
    void pack(const SliceCounts& counts, int axis, int needed);
    void transpose_of(const SliceBits& other);

    int blocks;                       ///< 64-bit words in a row, and 64-row blocks in a column
    std::vector<std::uint64_t> rows;  ///< [64 * blocks][blocks]
};

/// Writes the slice's rows to their places: row w of the slice is the row (v, w) of `direction`.
void store_slice(RowArray& array, const RowShape& shape, int direction, int v, const SliceBits& bits);

}  // namespace sightlines::voxel_rows
