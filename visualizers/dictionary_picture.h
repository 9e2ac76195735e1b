// What the view "dictionary" shows: the row that serves a ray, the row of the dictionary that stands for it, and how
// well the dictionary serves the whole array (Wang 2017, Algorithm 2).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "visualizers/voxel_row_picture.h"

namespace sightlines {

/// What is the same for all rays of one compressed array.
struct DictionarySummary {
    std::vector<std::uint64_t> rows_mapped;  ///< [steps] rows of the array that each step mapped; step 0: equal rows
    std::uint64_t rows_left_over = 0;        ///< that matched no row at any step
    std::vector<std::uint32_t>
        frequencies;  ///< [dictionary rows] how often each occurs in the array, most frequent first
    std::vector<std::vector<std::uint8_t>> most_used;  ///< [K][N] the bits of the most frequent rows, K at most 32
};

/// `row` shows the array before it was compressed, and its verdict is the own row's.
struct DictionaryPicture {
    VoxelRowPicture row;
    std::vector<std::uint8_t> mapped;  ///< [N] bits of the dictionary's row
    std::uint32_t mapped_index = 0;    ///< its place in the dictionary
    std::uint32_t frequency = 0;       ///< how often the array holds it
    int step = 0;  ///< that mapped the row: both match down-sampled by 2^step; summary's step count: none
    std::shared_ptr<const DictionarySummary> summary;
};

/// Whether the two rows differ at voxel u.
inline bool differs(const DictionaryPicture& picture, int u) {
    return is_set(picture.row, {u, picture.row.v, picture.row.w}) != (picture.mapped[static_cast<std::size_t>(u)] != 0);
}

/// The verdict by the dictionary's row, on the extent of the own one.
inline bool is_mapped_blocked(const DictionaryPicture& picture) {
    for (int u = picture.row.first; u <= picture.row.last; ++u)
        if (picture.mapped[static_cast<std::size_t>(u)] != 0) return true;
    return false;
}

}  // namespace sightlines
