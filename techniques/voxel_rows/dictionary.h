// Algorithm 2 of Wang 2017: the array's rows replaced by indices into a dictionary of the most frequent ones.
#pragma once

#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

/// What becomes of rows that match no row of the dictionary even when down-sampled, and which row is taken where
/// several match.
enum class Leftovers {
    random,  ///< the paper: a random row; the most frequent of several
    nearest  ///< the row that answers the fewest lights differently (differing_lights), among a bounded number
};

/// Which rows make the dictionary.
enum class DictionaryChoice {
    frequent,  ///< the paper: those that occur most often
    covering   ///< also those that stand for many others when down-sampled (dictionary_choice.h)
};

struct DictionaryOptions {
    std::uint32_t rows = 1u << 20u;  ///< n
    DictionaryChoice choice = DictionaryChoice::covering;
    int steps = 4;  ///< s, 1 to 6
    Leftovers leftovers = Leftovers::nearest;
    bool packed = true;  ///< indices of 20 bits where the dictionary has no more than 2^20 rows, the array 1.7e9; else 32
    std::uint64_t seed = 1;
    int threads = 0;
};

/// The array with its rows replaced by a dictionary and indices; `array` is not compressed yet. A function of the array
/// and the options alone, whatever the number of threads. EnvironmentError where the memory is not there.
RowArray compress(const RowArray& array, const DictionaryOptions& options, Progress& progress);

/// The bytes of dictionary and indices, without frequencies.
std::uint64_t compressed_bytes(const RowGrid& grid, std::uint32_t dictionary_rows, int index_bits);

/// A hash of a row: of several that occur equally often, the dictionary takes those of the lowest hash.
std::uint64_t row_hash(std::span<const std::uint32_t> row);

/// The first step c at which the two rows match down-sampled by 2^c; `steps` where none does (left over).
int mapping_step(std::span<const std::uint32_t> row, std::span<const std::uint32_t> dictionary_row, int steps);

/// The measure of "nearest". From each surface of `row` rays leave along the row: they start at the first and at the
/// second voxel beyond it, where these are clear, and end at lights in the voxels from there to the row's end. Lights
/// spread evenly through space stand in a cone round the row, so that (k + 1)^3 - k^3 of them are k voxels away (an
/// eighth of these in rows of more than 128 voxels). So many lights does `dictionary_row` answer differently.
std::uint32_t differing_lights(std::span<const std::uint32_t> row, std::span<const std::uint32_t> dictionary_row,
                               int resolution);

}  // namespace sightlines::voxel_rows
