// Wang 2017, Algorithm 2, line 1: how often each row occurs, and which rows are the same.
#pragma once

#include <span>
#include <vector>

#include "techniques/base/huge_buffer.h"
#include "techniques/base/progress.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/row_bits.h"

namespace sightlines::voxel_rows {

/// Some of the distinct rows: those whose hashes begin alike, few enough for a processor's own cache.
template <int length>
struct DistinctRows {
    std::uint32_t first_id = 0;             ///< of the first; the others follow
    std::span<const std::uint32_t> bits;    ///< [rows][length] each row once
    std::span<const std::uint32_t> counts;  ///< [rows] how often each occurs

    std::size_t size() const { return counts.size(); }
    RowBits<length> operator[](std::size_t k) const { return load_row<length>(&bits[k * length]); }
};

/// All rows of an array. The rows that only pad the array count for nothing.
template <int length>
struct RowHistogram {
    /// By the first bits of the hash. The blank row, where there is one, has the last part for itself.
    std::vector<DistinctRows<length>> parts;
    std::vector<HugeBuffer> memory;  ///< of the parts
    HugeBuffer spare;                ///< what counting has left for other use
    HugeBuffer id_of_row;            ///< [array.grid.rows()] 0: blank or padding
    std::uint32_t ids = 1;           ///< one more than the highest
    std::uint64_t rows = 0;          ///< without padding
    std::uint64_t distinct = 0;
};

constexpr std::size_t default_rows_per_part = 1u << 16u;

/// The most that count_rows holds beside the array, where no more than `distinct` rows are.
std::uint64_t counting_bytes(std::size_t rows, int words_per_row, std::size_t distinct);

/// `length` is array.grid.words_per_row. The same for any number of threads. `rows_per_part`: on average; most of them
/// repeat others.
template <int length>
RowHistogram<length> count_rows(const RowArray& array, int threads, Progress& progress,
                                std::size_t rows_per_part = default_rows_per_part);

}  // namespace sightlines::voxel_rows
