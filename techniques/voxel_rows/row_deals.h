// The distinct rows of an array in an order in which rows that are alike down-sampled come together.
#pragma once

#include "techniques/voxel_rows/row_histogram.h"

namespace sightlines::voxel_rows {

/// The row down-sampled by 32, 16 and 8, one after another from the top: rows that are alike after any of these steps
/// lie together where rows are sorted by it.
template <int length>
std::uint64_t coarse_prefix(const RowBits<length>& row) {
    static_assert(length * (1 + 2 + 4) <= 64);
    std::uint64_t by_32 = 0, by_16 = 0, by_8 = 0;
    const RowPlanes<length> planes = planes_of(row);
    for (std::size_t k = 0; k < length; ++k) {
        std::uint64_t plane = planes[k / 2];
        plane |= plane >> 1u;
        plane |= plane >> 2u;
        plane |= plane >> 4u;
        // Bits 0, 8, 16 and 24 of the word move to 31, 30, 29 and 28; no two of the sixteen terms meet.
        constexpr std::uint32_t gather = 1u << 31u | 1u << 22u | 1u << 13u | 1u << 4u;
        const auto word = static_cast<std::uint32_t>(plane >> (32 * (k % 2)));
        const std::uint32_t of_8 = (word & 0x01010101u) * gather >> 28u;
        const std::uint32_t of_16 = (of_8 >> 2u != 0 ? 2u : 0u) | ((of_8 & 3u) != 0 ? 1u : 0u);
        by_8 = by_8 << 4u | of_8;
        by_16 = by_16 << 2u | of_16;
        by_32 = by_32 << 1u | (of_16 != 0 ? 1u : 0u);
    }
    return (by_32 << 2u * length | by_16) << 4u * length | by_8;
}

/// The row down-sampled by 4, eight bits for each word, those of the first word uppermost.
template <int length>
std::uint64_t fine_key(const RowBits<length>& row) {
    static_assert(8 * length <= 64);
    std::uint64_t key = 0;
    for (std::uint64_t plane : planes_of(row)) {
        plane |= plane >> 1u;
        plane |= plane >> 2u;
        plane &= 0x1111111111111111u;
        plane = (plane | plane >> 3u) & 0x0303030303030303u;
        plane = (plane | plane >> 6u) & 0x000f000f000f000fu;
        plane = plane | plane >> 12u;
        const std::uint64_t low = plane & 0xffu, high = plane >> 32u & 0xffu;
        key = length == 1 ? low : key << 16u | low << 8u | high;
    }
    return key;
}

/// A distinct row, how often it occurs, its id in the histogram, and how far the dictionary's row for it is from it.
template <int length>
struct DealtRow {
    RowBits<length> row;
    std::uint32_t count, id, distance;
};

/// Distinct rows in deals that ascend by coarse_prefix of the shifted row: each deal is small enough for a processor's
/// own cache, unless too many rows have one prefix.
template <int length>
struct RowDeals {
    static constexpr std::size_t stride = static_cast<std::size_t>(length) + 3;
    HugeBuffer words;                 ///< [rows][stride]: bits, count, id, distance
    std::span<std::uint32_t> memory;  ///< that the words lie in; the rest of it is free
    std::vector<std::size_t> first;   ///< [deals + 1]; the last is the number of rows
    /// [deals - 1] ascending: deal d holds the prefixes below cuts[d] that are in no deal before.
    std::vector<std::uint64_t> cuts;

    std::size_t deals() const { return first.size() - 1; }
    std::size_t rows() const { return first.back(); }
    DealtRow<length> operator[](std::size_t place) const {
        const std::uint32_t* from = &words.words[place * stride];
        return {load_row<length>(from), from[length], from[length + 1], from[length + 2]};
    }
    std::uint32_t id(std::size_t place) const { return words.words[place * stride + stride - 2]; }
    std::uint32_t& distance(std::size_t place) const { return words.words[place * stride + stride - 1]; }
};

/// The rows of the histogram's parts, in `spare` where that is large enough; distances are 0. The same for any number
/// of threads.
template <int length>
RowDeals<length> deal_rows(const std::vector<DistinctRows<length>>& parts, int threads, Progress& progress,
                           const HugeBuffer& spare = {});

/// Deals those out again whose distance is at least `least_distance`, shifted by `shift`: in memory of `rows` where
/// they are few enough for two copies.
template <int length>
RowDeals<length> deal_again(RowDeals<length> rows, int shift, std::uint32_t least_distance, int threads,
                            Progress& progress);

}  // namespace sightlines::voxel_rows
