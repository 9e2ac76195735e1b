// Algorithm 2 works on distinct rows: each is mapped once, and all rows that are the same follow it.
#include "techniques/voxel_rows/dictionary.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include "techniques/base/parallel.h"
#include "techniques/base/random.h"
#include "techniques/voxel_rows/dictionary_choice.h"
#include "techniques/voxel_rows/dictionary_search.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::uint32_t most_looked_at = 64;        ///< rows of the dictionary for one that matches some down-sampled
constexpr std::uint32_t fewest_looked_at = 16;      ///< of those that match it best
constexpr std::uint32_t most_for_left_over = 1024;  ///< the same for one that is left over
constexpr int step_to_look_in = 3;  ///< the nearest is looked for among all that match down-sampled by 8, or more
constexpr std::uint32_t near_enough = 128;   ///< no nearer row is looked for below such a part of the lights
constexpr std::array later_shifts{4, 2, 6};  ///< half of what becomes one voxel at step_to_look_in, and quarters
constexpr double least_distance = 0.5;       ///< for a later look, of the mean over all distinct rows
constexpr std::uint32_t most_packed_rows = 1u << 20u;
constexpr std::size_t most_packed_indices = 1'700'000'000;  // whose bytes the wide kernels count in 32 bits
constexpr std::size_t rows_between_checks = 1024;
constexpr std::size_t rows_ahead = 16;  ///< whose indices' places, anywhere in memory, are asked for early

/// What mapping one deal's rows came to. Lights: of all rows together.
struct MappedCounts {
    std::array<std::uint64_t, coarsest_step + 1> by_step{};
    std::uint64_t left_over = 0, lights = 0;
    std::int64_t differing_lights = 0;

    MappedCounts& operator+=(const MappedCounts& more) {
        for (std::size_t k = 0; k < by_step.size(); ++k) by_step[k] += more.by_step[k];
        left_over += more.left_over;
        lights += more.lights;
        differing_lights += more.differing_lights;
        return *this;
    }
};

/// Everything that mapping needs, and where it writes.
template <int length>
struct Mapping {
    const DictionaryOptions& options;
    int resolution;
    const SortedRows<length>& sorted;
    std::vector<std::uint32_t> place_of_index;  ///< where each row of the dictionary is among those not shifted
    std::span<std::uint32_t> index_of_id;       ///< of the dictionary
};

/// A row on its way to the dictionary.
template <int length>
struct Asked {
    RowBits<length> row;
    std::uint32_t place;  ///< among the sorted rows
    RowProbes<length> probes;
};

template <int length>
Match compared(const Mapping<length>& mapping, const Asked<length>& asked, std::uint32_t place) {
    return nearest_in(mapping.sorted, {place, 1}, asked.row, asked.probes, {place, farthest});
}

/// Line 14: an index that depends on nothing but the seed and the bits.
template <int length>
std::uint32_t random_place(const Mapping<length>& mapping, const RowBits<length>& row) {
    const std::uint64_t hash = hash_row(row);
    const std::uint32_t number =
        random_u32(mapping.options.seed, static_cast<std::uint32_t>(hash >> 32u), static_cast<std::uint32_t>(hash));
    return mapping.place_of_index[number % mapping.place_of_index.size()];
}

/// At most `most` rows of `all`, round `place`.
Range window(Range all, std::uint32_t place, std::uint32_t most) {
    if (all.count <= most) return all;
    const std::uint32_t first = (place > most / 2 ? place - most / 2 : 0) / rows_at_once * rows_at_once;
    return {std::clamp(first, all.first, all.first + all.count - most), most};
}

/// The nearest round where the row would be, or `best`.
template <int length>
Match nearest_round(const SortedRows<length>& sorted, const Asked<length>& asked, Range all, std::uint32_t most,
                    const Match& best) {
    return nearest_in(sorted, window(all, asked.place, most), asked.row, asked.probes, best);
}

/// `some` and what else of `all` shares their blocks: it costs nothing more to compare.
Range whole_blocks(Range some, Range all) {
    const std::uint32_t end = (some.end() + rows_at_once - 1) / rows_at_once * rows_at_once;
    const std::uint32_t first = std::max(some.first / rows_at_once * rows_at_once, all.first);
    return {first, std::min(end, all.end()) - first};
}

/// The dictionary's row for one that matches some: the paper's, or one that is no further away.
template <int length>
Match choose(const Mapping<length>& mapping, const Matching& matching, const Asked<length>& asked) {
    const bool left_over = matching.step >= mapping.options.steps;
    const Group& alike = group_of(mapping.sorted, matching, matching.step);
    const std::uint32_t papers = left_over ? random_place(mapping, asked.row) : alike.best;
    if (mapping.options.leftovers == Leftovers::random) return compared(mapping, asked, papers);
    if (left_over)
        return nearest_round(mapping.sorted, asked, alike.range, most_for_left_over, compared(mapping, asked, papers));

    // The likelier ones first: the others are given up the sooner.
    const Range wider = group_of(mapping.sorted, matching, step_to_look_in).range;
    const Range near = whole_blocks(window(alike.range, asked.place, fewest_looked_at), wider);
    const bool is_near = papers >= near.first && papers < near.end();
    Match match = is_near ? Match{papers, farthest} : compared(mapping, asked, papers);
    const auto look_from = [&](std::uint32_t first, std::uint32_t end) {
        if (first < end) match = nearest_in(mapping.sorted, {first, end - first}, asked.row, asked.probes, match);
    };
    look_from(near.first, near.end());
    if (std::uint64_t{match.distance.lights} * near_enough < asked.probes.lights()) return match;
    const Range far = window(wider, asked.place, most_looked_at);
    look_from(far.first, std::min(near.first, far.end()));
    look_from(std::max(near.end(), far.first), far.end());
    return match;
}

/// Lines 7 to 15 for one row that is not in the dictionary.
template <int length>
Match map_row(const Mapping<length>& mapping, const Asked<length>& asked, std::uint64_t*& counter,
              MappedCounts& counts) {
    const bool nearest = mapping.options.leftovers == Leftovers::nearest;
    const auto matching = find_matching(mapping.sorted, asked.row, asked.place, 1);
    if (matching && (matching->step < mapping.options.steps || nearest)) {
        counter = matching->step < mapping.options.steps ? &counts.by_step[static_cast<std::size_t>(matching->step)]
                                                         : &counts.left_over;
        return choose(mapping, *matching, asked);
    }
    counter = &counts.left_over;
    return compared(mapping, asked, random_place(mapping, asked.row));
}

/// The rows of the dictionary that lie in the order where a deal's rows do.
template <int length>
Range range_of_deal(const SortedRows<length>& sorted, const RowDeals<length>& rows, std::size_t deal) {
    const auto place = [&](std::uint64_t prefix) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(sorted.prefix, prefix) - sorted.prefix.begin());
    };
    const std::uint32_t first = deal == 0 ? 0 : place(rows.cuts[deal - 1]);
    const auto all = static_cast<std::uint32_t>(sorted.rows.size());
    return {first, (deal == rows.cuts.size() ? all : place(rows.cuts[deal])) - first};
}

/// Makes ready for writing the index of a row to come.
template <int length>
void prefetch_index(const Mapping<length>& mapping, const RowDeals<length>& rows, std::size_t place) {
    if (place < rows.rows()) __builtin_prefetch(&mapping.index_of_id[rows.id(place)], 1);
}

template <int length>
MappedCounts map_deal(const Mapping<length>& mapping, const RowDeals<length>& rows, std::size_t deal,
                      const Progress& progress) {
    MappedCounts counts;
    const Range own = range_of_deal(mapping.sorted, rows, deal);
    for (std::size_t k = rows.first[deal]; k < rows.first[deal + 1]; ++k) {
        if ((k - rows.first[deal]) % rows_between_checks == 0) progress.check();
        prefetch_index(mapping, rows, k + rows_ahead);
        const DealtRow<length> dealt = rows[k];
        const std::uint32_t place = place_among(mapping.sorted, own, dealt.row);
        const Asked<length> asked{dealt.row, place, RowProbes<length>(dealt.row, mapping.resolution)};
        Match match{place, {}};
        std::uint64_t* counter = &counts.by_step[0];
        if (place == mapping.sorted.rows.size() || mapping.sorted.rows[place] != dealt.row)
            match = map_row(mapping, asked, counter, counts);
        *counter += dealt.count;
        counts.lights += asked.probes.lights() * dealt.count;
        counts.differing_lights += std::int64_t{match.distance.lights} * dealt.count;
        mapping.index_of_id[dealt.id] = mapping.sorted.index[match.place];
        rows.distance(k) = match.distance.lights;
    }
    return counts;
}

/// Looks for rows that are nearer among those that match shifted and down-sampled.
template <int length>
MappedCounts look_again(const Mapping<length>& mapping, RowDeals<length>& rows, std::size_t deal,
                        const Progress& progress) {
    MappedCounts counts;
    const Range own = range_of_deal(mapping.sorted, rows, deal);
    for (std::size_t k = rows.first[deal]; k < rows.first[deal + 1]; ++k) {
        if ((k - rows.first[deal]) % rows_between_checks == 0) progress.check();
        prefetch_index(mapping, rows, k + rows_ahead);
        const DealtRow<length> dealt = rows[k];
        const std::uint32_t place = place_among(mapping.sorted, own, dealt.row);
        const auto matching = find_matching(mapping.sorted, dealt.row, place, step_to_look_in);
        if (!matching) continue;
        const Asked<length> asked{dealt.row, place, RowProbes<length>(dealt.row, mapping.resolution)};
        const Match known{place, {dealt.distance, 0}};
        const Range alike = group_of(mapping.sorted, *matching, step_to_look_in).range;
        const Match match = nearest_round(mapping.sorted, asked, alike, most_looked_at, known);
        if (match.distance == known.distance) continue;
        counts.differing_lights -= std::int64_t{dealt.distance - match.distance.lights} * dealt.count;
        rows.distance(k) = match.distance.lights;
        mapping.index_of_id[dealt.id] = mapping.sorted.index[match.place];
    }
    return counts;
}

/// Calls map(deal) for all deals and sums up what comes.
template <class Map>
MappedCounts map_deals(std::size_t deals, int threads, Progress& progress, const Map& map) {
    std::vector<MappedCounts> counts(deals);
    parallel_for(static_cast<std::int64_t>(deals), threads, [&](std::int64_t deal) {
        counts[static_cast<std::size_t>(deal)] = map(static_cast<std::size_t>(deal));
        progress.advance();
    });
    MappedCounts total;
    for (const MappedCounts& deal : counts) total += deal;
    return total;
}

/// Lines 3 to 15.
template <int length>
MappedCounts map_rows(RowDeals<length> rows, const std::vector<RowBits<length>>& dictionary, int resolution,
                      const DictionaryOptions& options, std::span<std::uint32_t> index_of_id, Progress& progress) {
    progress.begin("mapping rows to the dictionary", static_cast<std::int64_t>(rows.deals()));
    SortedRows<length> sorted = sort_rows(dictionary, resolution, 0, options.threads, progress);
    Mapping<length> mapping{options, resolution, sorted, std::vector<std::uint32_t>(dictionary.size()), index_of_id};
    for (std::uint32_t place = 0; place < sorted.index.size(); ++place)
        mapping.place_of_index[sorted.index[place]] = place;
    MappedCounts total = map_deals(rows.deals(), options.threads, progress,
                                   [&](std::size_t deal) { return map_deal(mapping, rows, deal, progress); });
    if (options.leftovers == Leftovers::random) return total;

    const double mean =
        static_cast<double>(total.differing_lights) / static_cast<double>(std::max<std::size_t>(1, rows.rows()));
    const auto least = static_cast<std::uint32_t>(least_distance * mean) + 1;
    for (const int shift : later_shifts) {
        rows = deal_again(std::move(rows), shift, least, options.threads, progress);
        progress.begin("looking for nearer rows", static_cast<std::int64_t>(rows.deals()));
        sorted = sort_rows(dictionary, resolution, shift, options.threads, progress, std::move(sorted));
        total += map_deals(rows.deals(), options.threads, progress,
                           [&](std::size_t deal) { return look_again(mapping, rows, deal, progress); });
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
    RowHistogram<length> histogram = count_rows<length>(array, options.threads, progress);
    RowDeals<length> rows = deal_rows(histogram.parts, options.threads, progress, std::exchange(histogram.spare, {}));
    histogram.parts.clear();
    histogram.memory.clear();
    const std::vector<ChosenRow<length>> chosen = choose_rows(rows, options, progress);
    std::vector<RowBits<length>> dictionary;
    for (const ChosenRow<length>& row : chosen) dictionary.push_back(row.row);
    // Where there is no blank row, its place, which is that of padding too, stays 0.
    const HugeBuffer index_of_id = allocate_huge(histogram.ids);
    const MappedCounts counts =
        map_rows(std::move(rows), dictionary, array.grid.resolution, options, index_of_id.words, progress);

    RowDictionary& kept = made.dictionary;
    kept.rows = static_cast<std::uint32_t>(dictionary.size());
    const bool fit = kept.rows <= most_packed_rows && array.grid.rows() <= most_packed_indices;
    kept.index_bits = options.packed && fit ? 20 : 32;
    kept.steps = options.steps;
    kept.distinct_rows = histogram.distinct;
    kept.rows_mapped.assign(counts.by_step.begin(), counts.by_step.begin() + options.steps);
    kept.rows_left_over = counts.left_over;
    kept.differing_share =
        static_cast<double>(counts.differing_lights) / std::max(1.0, static_cast<double>(counts.lights));
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
        return first_common_step(a, b, 0, steps);
    });
}

std::uint32_t differing_lights(std::span<const std::uint32_t> row, std::span<const std::uint32_t> dictionary_row,
                               int resolution) {
    return with_row_length(static_cast<int>(row.size()), [&](auto length) {
        const RowProbes<length()> probes(load_row<length()>(row.data()), resolution);
        return differing_lights(probes, load_row<length()>(dictionary_row.data()));
    });
}

}  // namespace sightlines::voxel_rows
