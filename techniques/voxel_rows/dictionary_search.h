// Wang 2017, Algorithm 2, lines 4 to 11: the dictionary, down-sampled, and the search for a row in it.
#pragma once

#include <optional>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/voxel_rows/row_probes.h"

namespace sightlines::voxel_rows {

constexpr int coarsest_step = 5;  ///< down-sampled by 32

/// How far a row of the dictionary is from another one: rays first, then voxels.
struct Distance {
    std::uint32_t rays = 0, voxels = 0;

    auto operator<=>(const Distance&) const = default;
};

/// A row of the dictionary for another one.
struct Match {
    std::uint32_t index = 0;
    Distance distance;
};

/// Some rows of the dictionary that lie together in SortedRows.
struct Range {
    std::uint32_t first = 0, count = 0;
};

/// The dictionary's rows in an order in which those that are alike when down-sampled lie together, for every step at
/// once, and what they are for the search: bit planes, so that many are compared together.
template <int length>
struct SortedRows {
    std::vector<std::uint32_t> index;                  ///< in the dictionary
    std::vector<std::uint64_t> prefix;                 ///< what the rows are sorted by first: their coarse steps
    std::vector<std::vector<std::uint64_t>> up, down;  ///< [planes][rows, padded by a vector]; down: reversed rows
};

/// Rows of the dictionary that are alike down-sampled by 2^step, found by what they are then.
template <int length>
struct DictionaryStep {
    struct Group {
        RowBits<length> key;
        Range range;               ///< of SortedRows; count 0: a free place
        std::uint32_t lowest = 0;  ///< index of the most frequent row
    };
    int step = 0;
    std::vector<Group> groups;  ///< open addressing by hash_row(key), a power of two

    std::size_t place_of(const RowBits<length>& key) const { return hash_row(key) & (groups.size() - 1); }
    /// The group of `key`, or a free place.
    const Group& find(const RowBits<length>& key) const {
        std::size_t at = place_of(key);
        while (groups[at].range.count != 0 && groups[at].key != key) at = (at + 1) & (groups.size() - 1);
        return groups[at];
    }
};

template <int length>
struct DictionarySearch {
    const std::vector<RowBits<length>>& rows;  ///< of the dictionary, most frequent first
    int resolution = 0;
    SortedRows<length> sorted;
    std::vector<DictionaryStep<length>> steps;  ///< [coarsest_step], the first down-sampled by 2
};

template <int length>
DictionarySearch<length> make_search(const std::vector<RowBits<length>>& rows, int resolution, int threads,
                                     Progress& progress);

/// The nearest to a row (whose probes are given) among some rows of the dictionary, the first of equals; `best` where
/// none is nearer.
template <int length>
Match nearest_in(const SortedRows<length>& sorted, Range range, const RowBits<length>& row,
                 const RowProbes<length>& probes, Match best);

/// Where a row would lie among the sorted ones, by its coarse steps.
template <int length>
std::uint32_t place_among(const SortedRows<length>& sorted, const RowBits<length>& row);

}  // namespace sightlines::voxel_rows
