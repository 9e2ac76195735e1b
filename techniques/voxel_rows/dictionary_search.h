// Wang 2017, Algorithm 2, lines 4 to 11: the dictionary, down-sampled, and the search for a row in it.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "techniques/base/huge_buffer.h"
#include "techniques/base/progress.h"
#include "techniques/voxel_rows/row_probes.h"

namespace sightlines::voxel_rows {

constexpr int coarsest_step = 5;            ///< down-sampled by 32
constexpr std::uint32_t rows_at_once = 16;  ///< ranges of SortedRows cost least where they begin at a multiple

/// How far a row of the dictionary is from another one: by what it answers differently first, then voxels.
struct Distance {
    std::uint32_t lights = 0;  ///< differing_lights
    std::uint32_t voxels = 0;

    auto operator<=>(const Distance&) const = default;
};
constexpr Distance farthest{~0u, ~0u};

/// Some rows of the dictionary that lie together in SortedRows.
struct Range {
    std::uint32_t first = 0, count = 0;

    std::uint32_t end() const { return first + count; }
};

/// A row of the dictionary for another one.
struct Match {
    std::uint32_t place = 0;  ///< in SortedRows
    Distance distance;
};

/// Rows of the dictionary that are alike after some step.
struct Group {
    Range range;
    std::uint32_t best = 0;  ///< the place of the most frequent one
};

/// The dictionary's rows in an order in which those that are alike when shifted and down-sampled lie together, for
/// every step at once.
template <int length>
struct SortedRows {
    int shift = 0;
    std::vector<RowBits<length>> rows;
    std::vector<std::uint64_t> prefix, fine;               ///< coarse_prefix and fine_key of each, shifted
    std::vector<std::uint32_t> index;                      ///< of each in the dictionary
    std::vector<std::array<Group, coarsest_step>> groups;  ///< each row's own after step 1, 2 ...
    /// For comparing many at once: [blocks of as many rows as a vector has lanes][up, down][word, next][length][lane];
    /// down is the reversed row, next the first set bit behind the word, or the row's end.
    HugeBuffer blocks;
};

/// `rows`: of the dictionary, the most frequent first, of so many voxels each. `spare`: whose memory nobody needs.
template <int length>
SortedRows<length> sort_rows(const std::vector<RowBits<length>>& rows, int resolution, int shift, int threads,
                             Progress& progress, SortedRows<length> spare = {});

/// Where `row` is among the sorted ones, or would be: in `within`, or at its end.
template <int length>
std::uint32_t place_among(const SortedRows<length>& sorted, Range within, const RowBits<length>& row);

/// A row of the dictionary that matches another one after some step.
struct Matching {
    int step;
    std::uint32_t place;
};

/// The first step from `least_step` on after which rows of the dictionary match `row`, whose place is given, and one of
/// them; nothing where no step makes any match. Inlined, since its result would be returned through memory in halves
/// and read as a whole, which waits for both.
template <int length>
[[gnu::always_inline]] inline std::optional<Matching> find_matching(const SortedRows<length>& sorted,
                                                                    const RowBits<length>& row, std::uint32_t place,
                                                                    int least_step) {
    const RowBits<length> moved = shifted(row, sorted.shift);
    Matching matching{coarsest_step + 1, 0};
    for (const std::uint32_t neighbour : {place - 1, place}) {
        if (neighbour >= sorted.rows.size()) continue;
        const RowBits<length> other = shifted(sorted.rows[neighbour], sorted.shift);
        const int common = first_common_step(other, moved, least_step, matching.step);
        if (common < matching.step) matching = {common, neighbour};
    }
    if (matching.step > coarsest_step) return {};
    return matching;
}

/// All rows that match it after so many steps, or after its own step where that is more.
template <int length>
const Group& group_of(const SortedRows<length>& sorted, const Matching& matching, int step) {
    return sorted.groups[matching.place][static_cast<std::size_t>(std::max(step, matching.step) - 1)];
}

/// The nearest to a row (whose probes are given) among some rows of the dictionary, the first of equals; `best` where
/// none is nearer.
template <int length>
Match nearest_in(const SortedRows<length>& sorted, Range range, const RowBits<length>& row,
                 const RowProbes<length>& probes, Match best);

}  // namespace sightlines::voxel_rows
