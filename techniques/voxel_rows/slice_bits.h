// One slice (constant v) of a voxelization as a square matrix of bits, on its way from marks to rows.
#pragma once

#include <cstdint>

#include <vector>

#include <oneapi/tbb/cache_aligned_allocator.h>

#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

/// Whole vectors load from its beginning without crossing cache lines.
template <class Value>
using AlignedVector = std::vector<Value, tbb::cache_aligned_allocator<Value>>;

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

    int side;                           ///< voxels in a padded row, and rows
    int pitch;                          ///< bytes from one row to the next
    AlignedVector<std::uint8_t> bytes;  ///< the voxel (u, w) is bytes[place_of(u, w)]
};

/// N x N bits, padded to whole 64-bit words; bit u of row w is bit u % 64 of words[u / 64 * side + w].
struct SliceBits {
    explicit SliceBits(int resolution)
        : side((resolution + 63) / 64 * 64), words(static_cast<std::size_t>(side) * side / 64) {}

    int side;                            ///< bits in a padded row, and rows
    AlignedVector<std::uint64_t> words;  ///< [side / 64][side]
};

/// What a voxel must hold to be set: at least `along_u` (`along_w`) by itself, or together with the fuller of its two
/// neighbours along that axis if it holds no less than that one. So a surface that straddles two voxels sets the one
/// with more of it. 1: sets every voxel that holds anything.
struct Needed {
    int along_u = 1, along_w = 1;
};

/// Packs the slice by what is needed along each axis, and empties it. Returns the sum of all that it held.
std::uint64_t take_bits(SliceCounts& counts, Needed needed, SliceBits& along_u, SliceBits& along_w);

void transpose(const SliceBits& bits, SliceBits& transposed);

/// Writes the slice's voxels to occupied[(w * N + v) * N + u], 0 or 1.
void unpack_slice(const SliceBits& bits, int resolution, int v, std::span<std::uint8_t> occupied);

/// Whether rows take the place of those that the array holds, or their bits are set in addition.
enum class Storing { replace, add };

/// Writes the slice's rows to their places: row w of the slice is the row (v, w) of `direction`.
void store_slice(RowArray& array, const RowShape& shape, int direction, int v, const SliceBits& bits,
                 Storing storing = Storing::replace);

/// What this thread has stored may be read by others from here on.
void finish_storing();

}  // namespace sightlines::voxel_rows
