// Wang 2017, Algorithm 2, line 2: which rows make the dictionary.
#pragma once

#include "techniques/voxel_rows/dictionary.h"
#include "techniques/voxel_rows/row_deals.h"

namespace sightlines::voxel_rows {

/// A row of the dictionary to be.
template <int length>
struct ChosenRow {
    RowBits<length> row;
    std::uint64_t hash;
    std::uint32_t count;
    std::uint32_t worth;  ///< at most 2^32 - 1
};

/// At most options.rows rows by options.choice, most frequent first; of those equally frequent the lowest hash first.
template <int length>
std::vector<ChosenRow<length>> choose_rows(const RowDeals<length>& rows, const DictionaryOptions& options,
                                           Progress& progress);

/// What a row is worth for a dictionary that is to cover: how often the row occurs, and, if it is the most frequent one
/// of all that are alike down-sampled by 2 (or 4), how often these occur together, times as many.
constexpr std::uint64_t worth_of_group[3]{1, 4, 16};

}  // namespace sightlines::voxel_rows
