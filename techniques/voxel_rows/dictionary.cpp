// Algorithm 2 works on distinct rows: each is mapped once, and all rows that are the same follow it.
#include "techniques/voxel_rows/dictionary.h"

#include <algorithm>
#include <cassert>
#include <chrono>

#include "techniques/base/parallel.h"
#include "techniques/base/random.h"
#include "techniques/voxel_rows/dictionary_choice.h"
#include "techniques/voxel_rows/dictionary_search.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::uint32_t most_looked_at = 128;       ///< rows of the dictionary for one that matches some down-sampled
constexpr std::uint32_t fewest_looked_at = 32;      ///< of those that match it best
constexpr std::uint32_t most_for_left_over = 1024;  ///< the same for one that is left over
constexpr int step_to_look_in = 3;  ///< the nearest is looked for among all that match down-sampled by 8, or more
constexpr std::uint32_t most_packed_rows = 1u << 20u;

/// What mapping one part's rows came to. Rays: in all rows together.
struct MappedCounts {
    std::array<std::uint64_t, coarsest_step + 1> by_step{};
    std::uint64_t left_over = 0, rays = 0, differing_rays = 0;
};

/// Everything that mapping needs, and where it writes.
template <int length>
struct Mapping {
    const DictionaryOptions& options;
    const DictionarySearch<length>& search;
    std::span<std::uint32_t> index_of_id;  ///< not_mapped, or of the dictionary
    static constexpr std::uint32_t not_mapped = ~0u;
};

/// The rows of one part that no step has matched so far.
template <int length>
struct Unmapped {
    const DistinctRows<length>& part;
    std::vector<std::uint32_t> rows;  ///< inside the part
};

template <int length>
Match compared(const DictionarySearch<length>& search, const RowBits<length>& row, const RowProbes<length>& probes,
               std::uint32_t index) {
    const RowBits<length>& other = search.rows[index];
    return {index, {differing_rays(probes, other), differing_voxels(row, other)}};
}

/// Line 14: an index that depends on nothing but the seed and the bits.
template <int length>
std::uint32_t random_row(const Mapping<length>& mapping, const RowBits<length>& row) {
    const std::uint64_t hash = hash_row(row);
    return random_u32(mapping.options.seed, static_cast<std::uint32_t>(hash >> 32u), static_cast<std::uint32_t>(hash)) %
           static_cast<std::uint32_t>(mapping.search.rows.size());
}

/// At most `most` rows of `all`, round the middle of `part` of them.
Range window(Range all, Range part, std::uint32_t most) {
    if (all.count <= most) return all;
    const std::uint32_t middle = part.first + part.count / 2;
    const std::uint32_t first = middle > most / 2 ? middle - most / 2 : 0;
    return {std::clamp(first, all.first, all.first + all.count - most), most};
}

/// Where a row is compared with those of the dictionary one by one: those of the group, which it matches, and others
/// that it matches down-sampled further.
template <int length>
Range rows_to_look_at(const DictionarySearch<length>& search, const DictionaryStep<length>& step,
                      const typename DictionaryStep<length>::Group& group, const RowBits<length>& row, bool left_over) {
    if (left_over) return window(group.range, {place_among(search.sorted, row), 1}, most_for_left_over);
    if (step.step >= step_to_look_in) return window(group.range, group.range, most_looked_at);
    const auto& wider = search.steps[step_to_look_in - 1].find(simplify(row, step_to_look_in));
    return window(wider.range, group.range, most_looked_at);
}

/// The dictionary's row for `row`, which belongs to the group: the paper's, or one that is no further away.
template <int length>
Match choose(const Mapping<length>& mapping, const DictionaryStep<length>& step,
             const typename DictionaryStep<length>::Group& group, const RowBits<length>& row,
             const RowProbes<length>& probes) {
    const bool left_over = step.step >= mapping.options.steps;
    const std::uint32_t papers = left_over ? random_row(mapping, row) : group.lowest;
    const Match first = compared(mapping.search, row, probes, papers);
    if (mapping.options.leftovers == Leftovers::random) return first;
    // The likelier ones first: the others are given up the sooner.
    const Match near =
        nearest_in(mapping.search.sorted, window(group.range, group.range, fewest_looked_at), row, probes, first);
    return nearest_in(mapping.search.sorted, rows_to_look_at(mapping.search, step, group, row, left_over), row, probes,
                      near);
}

template <int length>
void keep(const Mapping<length>& mapping, const DistinctRows<length>& part, std::uint32_t row, const Match& match,
          const RowProbes<length>& probes, std::uint64_t& rows_mapped, MappedCounts& counts) {
    mapping.index_of_id[part.first_id + row] = match.index;
    rows_mapped += part.counts[row];
    counts.rays += std::uint64_t{probes.rays()} * part.counts[row];
    counts.differing_rays += std::uint64_t{match.distance.rays} * part.counts[row];
}

/// Lines 7 to 11 for one part: what matches leaves `unmapped`. In small batches, whose groups are on their way from
/// memory while others are looked at.
template <int length>
void match_step(const Mapping<length>& mapping, const DictionaryStep<length>& step, Unmapped<length>& unmapped,
                MappedCounts& counts, const Progress& progress) {
    constexpr std::size_t batch = 64;
    std::uint64_t& rows_mapped =
        step.step < mapping.options.steps ? counts.by_step[static_cast<std::size_t>(step.step)] : counts.left_over;
    std::array<RowBits<length>, batch> keys;
    std::size_t left = 0;
    for (std::size_t first = 0; first < unmapped.rows.size(); first += batch) {
        if (first % (16 * batch) == 0) progress.check();
        const std::size_t count = std::min(batch, unmapped.rows.size() - first);
        for (std::size_t k = 0; k < count; ++k) {
            keys[k] = simplify(unmapped.part.rows[unmapped.rows[first + k]], step.step);
            __builtin_prefetch(&step.groups[step.place_of(keys[k])]);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const auto& group = step.find(keys[k]);
            const std::uint32_t row = unmapped.rows[first + k];
            if (group.range.count == 0) {
                unmapped.rows[left++] = row;
                continue;
            }
            const RowBits<length>& bits = unmapped.part.rows[row];
            const RowProbes<length> probes(bits, mapping.search.resolution);
            keep(mapping, unmapped.part, row, choose(mapping, step, group, bits, probes), probes, rows_mapped, counts);
        }
    }
    unmapped.rows.resize(left);
}

/// Lines 13 to 15.
template <int length>
void map_at_random(const Mapping<length>& mapping, const Unmapped<length>& unmapped, MappedCounts& counts) {
    for (const std::uint32_t k : unmapped.rows) {
        const RowBits<length>& row = unmapped.part.rows[k];
        const RowProbes<length> probes(row, mapping.search.resolution);
        keep(mapping, unmapped.part, k, compared(mapping.search, row, probes, random_row(mapping, row)), probes,
             counts.left_over, counts);
    }
}

template <int length>
MappedCounts map_part(const Mapping<length>& mapping, const DistinctRows<length>& part, const Progress& progress) {
    MappedCounts counts;
    Unmapped<length> unmapped{part, {}};
    for (std::uint32_t k = 0; k < part.rows.size(); ++k) {
        if (mapping.index_of_id[part.first_id + k] == Mapping<length>::not_mapped) {
            unmapped.rows.push_back(k);
            continue;
        }
        counts.by_step[0] += part.counts[k];
        counts.rays +=
            std::uint64_t{RowProbes<length>(part.rows[k], mapping.search.resolution).rays()} * part.counts[k];
    }
    for (const DictionaryStep<length>& step : mapping.search.steps)
        if (step.step < mapping.options.steps || mapping.options.leftovers == Leftovers::nearest)
            match_step(mapping, step, unmapped, counts, progress);
    map_at_random(mapping, unmapped, counts);
    return counts;
}

/// Lines 3 to 15. index_of_id knows the dictionary's own rows already.
template <int length>
MappedCounts map_rows(const RowHistogram<length>& histogram, const std::vector<RowBits<length>>& dictionary,
                      int resolution, const DictionaryOptions& options, std::span<std::uint32_t> index_of_id,
                      Progress& progress) {
    progress.begin("mapping rows to the dictionary", coarsest_step + static_cast<std::int64_t>(histogram.parts.size()));
    const DictionarySearch<length> search = make_search(dictionary, resolution, options.threads, progress);
    const Mapping<length> mapping{options, search, index_of_id};
    std::vector<MappedCounts> counts(histogram.parts.size());
    parallel_for(static_cast<std::int64_t>(histogram.parts.size()), options.threads, [&](std::int64_t index) {
        const auto part = static_cast<std::size_t>(index);
        counts[part] = map_part(mapping, histogram.parts[part], progress);
        progress.advance();
    });
    MappedCounts total;
    for (const MappedCounts& part : counts) {
        for (std::size_t k = 0; k < total.by_step.size(); ++k) total.by_step[k] += part.by_step[k];
        total.left_over += part.left_over;
        total.rays += part.rays;
        total.differing_rays += part.differing_rays;
    }
    return total;
}

/// Puts each row's index in its place behind the dictionary.
void write_indices(const HugeBuffer& id_of_row, std::span<const std::uint32_t> index_of_id, int index_bits,
                   std::span<std::uint32_t> indices, int threads, Progress& progress) {
    constexpr std::size_t rows_per_chunk = 1u << 18u;  // a multiple of 8, so that no two chunks share a word
    const std::size_t rows = id_of_row.words.size(), chunks = (rows + rows_per_chunk - 1) / rows_per_chunk;
    progress.begin("writing indices", static_cast<std::int64_t>(chunks));
    parallel_for(static_cast<std::int64_t>(chunks), threads, [&](std::int64_t chunk) {
        const std::size_t begin = static_cast<std::size_t>(chunk) * rows_per_chunk;
        const std::size_t end = std::min(rows, begin + rows_per_chunk);
        std::uint64_t waiting = 0;  // bits that fill no word yet
        unsigned waiting_bits = 0;
        std::uint32_t* next = &indices[begin * static_cast<std::size_t>(index_bits) / 32];
        for (std::size_t row = begin; row < end; ++row) {
            constexpr std::size_t ahead = 24;
            if (row + ahead < end) __builtin_prefetch(&index_of_id[id_of_row.words[row + ahead]]);
            waiting |= std::uint64_t{index_of_id[id_of_row.words[row]]} << waiting_bits;
            waiting_bits += static_cast<unsigned>(index_bits);
            if (waiting_bits < 32) continue;
            *next++ = static_cast<std::uint32_t>(waiting);
            waiting >>= 32u;
            waiting_bits -= 32;
        }
        if (waiting_bits > 0) *next = static_cast<std::uint32_t>(waiting);
        progress.advance();
    });
}

std::size_t compressed_words(const RowGrid& grid, std::uint32_t dictionary_rows, int index_bits) {
    const std::size_t dictionary = std::size_t{dictionary_rows} * static_cast<std::size_t>(grid.words_per_row);
    // One word more, because an index of 20 bits is read with the word behind it; and whole texels of four.
    return (dictionary + (grid.rows() * static_cast<std::size_t>(index_bits) + 31) / 32 + 1 + 3) / 4 * 4;
}

template <int length>
RowArray compress_rows(const RowArray& array, const DictionaryOptions& options, Progress& progress) {
    RowArray made;
    made.grid = array.grid;
    made.build_seconds = array.build_seconds;
    made.fragments = array.fragments;
    const RowHistogram<length> histogram = count_rows<length>(array, options.threads, progress);
    const std::vector<ChosenRow<length>> chosen = choose_rows(histogram, options, progress);
    std::vector<RowBits<length>> dictionary;
    for (const ChosenRow<length>& row : chosen) dictionary.push_back(row.row);

    const HugeBuffer index_of_id = allocate_huge(histogram.ids);
    std::ranges::fill(index_of_id.words.subspan(1), Mapping<length>::not_mapped);
    // The blank row's place is that of padding too, and stays 0 where there is no blank row.
    if (histogram.parts.back().first_id == 0) index_of_id.words[0] = Mapping<length>::not_mapped;
    for (std::uint32_t index = 0; index < chosen.size(); ++index) index_of_id.words[chosen[index].id] = index;
    const MappedCounts counts =
        map_rows(histogram, dictionary, array.grid.resolution, options, index_of_id.words, progress);

    RowDictionary& kept = made.dictionary;
    kept.rows = static_cast<std::uint32_t>(dictionary.size());
    kept.index_bits = options.packed && kept.rows <= most_packed_rows ? 20 : 32;
    kept.steps = options.steps;
    kept.distinct_rows = histogram.distinct;
    kept.rows_mapped.assign(counts.by_step.begin(), counts.by_step.begin() + options.steps);
    kept.rows_left_over = counts.left_over;
    kept.differing_share = static_cast<double>(counts.differing_rays) / std::max(1.0, static_cast<double>(counts.rays));
    for (const ChosenRow<length>& row : chosen) kept.frequencies.push_back(row.count);
    made.words = allocate_huge(compressed_words(array.grid, kept.rows, kept.index_bits));
    std::memcpy(made.words.words.data(), dictionary.data(), dictionary.size() * sizeof dictionary[0]);
    write_indices(histogram.id_of_row, index_of_id.words, kept.index_bits,
                  made.words.words.subspan(std::size_t{kept.rows} * length), options.threads, progress);
    return made;
}

}  // namespace

RowArray compress(const RowArray& array, const DictionaryOptions& options, Progress& progress) {
    assert(array.dictionary.index_bits == 0);
    assert(options.rows > 0 && options.steps >= 1 && options.steps <= coarsest_step + 1);
    const auto start = std::chrono::steady_clock::now();
    RowArray made = with_row_length(array.grid.words_per_row,
                                    [&](auto length) { return compress_rows<length()>(array, options, progress); });
    made.dictionary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return made;
}

std::uint64_t compressed_bytes(const RowGrid& grid, std::uint32_t dictionary_rows, int index_bits) {
    return compressed_words(grid, dictionary_rows, index_bits) * sizeof(std::uint32_t);
}

std::uint64_t row_hash(std::span<const std::uint32_t> row) {
    return with_row_length(static_cast<int>(row.size()),
                           [&](auto length) { return hash_row(load_row<length()>(row.data())); });
}

int mapping_step(std::span<const std::uint32_t> row, std::span<const std::uint32_t> dictionary_row, int steps) {
    return with_row_length(static_cast<int>(row.size()), [&](auto length) {
        const auto a = load_row<length()>(row.data()), b = load_row<length()>(dictionary_row.data());
        int step = 0;
        while (step < steps && simplify(a, step) != simplify(b, step)) ++step;
        return step;
    });
}

std::uint32_t differing_rays(std::span<const std::uint32_t> row, std::span<const std::uint32_t> dictionary_row,
                             int resolution) {
    return with_row_length(static_cast<int>(row.size()), [&](auto length) {
        const RowProbes<length()> probes(load_row<length()>(row.data()), resolution);
        return differing_rays(probes, load_row<length()>(dictionary_row.data()));
    });
}

}  // namespace sightlines::voxel_rows
