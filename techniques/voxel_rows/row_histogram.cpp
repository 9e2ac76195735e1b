// Sorting 133 million rows would take a minute. Instead they are dealt out by their hash to parts that fit a
// processor's own cache, some hundred parts in each sweep over the array, and each part is counted by a hash table.
#include "techniques/voxel_rows/row_histogram.h"

#include <algorithm>
#include <cassert>

#include "techniques/base/parallel.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::size_t most_parts = 4096;
constexpr std::size_t parts_per_sweep = 1024;  ///< dealt out at once: their open lines stay in the second-level cache
constexpr std::size_t rows_per_chunk = 1u << 18u;  ///< at most 512 chunks

/// How the work is cut, a function of the number of rows alone.
struct Cut {
    std::size_t rows, parts, sweeps, chunks;

    Cut(std::size_t rows_, std::size_t rows_per_part)
        : rows(rows_),
          parts(std::clamp<std::size_t>(std::bit_ceil(rows_ / rows_per_part + 1), 1, most_parts)),
          sweeps((parts + parts_per_sweep - 1) / parts_per_sweep),
          chunks(std::clamp<std::size_t>(rows_ / rows_per_chunk, 1, 512)) {}
    std::size_t begin_of(std::size_t chunk) const { return rows * chunk / chunks; }
    std::size_t parts_in_sweep() const { return parts / sweeps; }
    std::size_t part_of(std::uint64_t hash) const { return parts == 1 ? 0 : hash >> (64 - std::countr_zero(parts)); }
};

/// Which of the rows in memory no ray asks for: row_index() pads each direction to whole blocks of 8 x 8.
struct Padding {
    std::uint32_t resolution, blocks;

    explicit Padding(int resolution_)
        : resolution(static_cast<std::uint32_t>(resolution_)), blocks((resolution + 7) / 8) {}
    bool holds(std::size_t row) const {
        if (resolution % 8 == 0) return false;
        const auto block = static_cast<std::uint32_t>(row >> 8u);
        const std::uint32_t v = block / blocks % blocks * 8 + (row >> 3u & 7u);
        return v >= resolution || block % blocks * 8 + (row & 7u) >= resolution;
    }
};

/// Rows of one sweep, part after part, and where they come from. When a part has been counted, its distinct rows and
/// their counts lie at its beginning, and each row's id in it beside the row's number.
template <int length>
struct DealtRows {
    HugeBuffer memory;                         ///< of the rest
    std::span<std::uint32_t> bits;             ///< [capacity * length]
    std::span<std::uint32_t> number;           ///< [capacity] of the row in the array
    std::span<std::uint32_t> id;               ///< [capacity] inside its part
    std::span<std::uint32_t> count;            ///< [capacity]
    std::vector<std::size_t> first;            ///< [parts in a sweep + 1]
    std::vector<std::uint32_t> distinct = {};  ///< [parts in a sweep]
};

/// counts[chunk * parts + part], without blank rows and padding; sums up the blank ones.
template <int length>
std::vector<std::uint32_t> count_parts(const RowArray& array, const Cut& cut, int threads, Progress& progress,
                                       std::uint64_t& blank_rows) {
    std::vector<std::uint32_t> counts(cut.chunks * cut.parts);
    std::vector<std::uint64_t> blank(cut.chunks);
    parallel_for(static_cast<std::int64_t>(cut.chunks), threads, [&](std::int64_t index) {
        const auto chunk = static_cast<std::size_t>(index);
        const Padding padding(array.grid.resolution);
        std::uint32_t* own = &counts[chunk * cut.parts];
        for (std::size_t row = cut.begin_of(chunk); row < cut.begin_of(chunk + 1); ++row) {
            if (padding.holds(row)) continue;
            const auto bits = load_row<length>(&array.words.words[row * length]);
            if (is_blank(bits))
                ++blank[chunk];
            else
                ++own[cut.part_of(hash_row(bits))];
        }
        progress.advance();
    });
    blank_rows = 0;
    for (const std::uint64_t count : blank) blank_rows += count;
    return counts;
}

/// Turns the counts of one sweep's parts into the places where each chunk begins in each part.
std::vector<std::size_t> places_of(const Cut& cut, std::size_t sweep, std::vector<std::uint32_t>& counts) {
    const std::size_t in_sweep = cut.parts_in_sweep();
    std::vector<std::size_t> first(in_sweep + 1);
    std::size_t place = 0;
    for (std::size_t part = 0; part < in_sweep; ++part) {
        first[part] = place;
        for (std::size_t chunk = 0; chunk < cut.chunks; ++chunk) {
            std::uint32_t& count = counts[chunk * cut.parts + sweep * in_sweep + part];
            const std::uint32_t begin = static_cast<std::uint32_t>(place);
            place += count;
            count = begin;
        }
    }
    first[in_sweep] = place;
    return first;
}

template <int length>
void deal(const RowArray& array, const Cut& cut, std::size_t sweep, std::vector<std::uint32_t>& places, int threads,
          DealtRows<length>& dealt, Progress& progress) {
    const std::size_t in_sweep = cut.parts_in_sweep();
    parallel_for(static_cast<std::int64_t>(cut.chunks), threads, [&](std::int64_t index) {
        const auto chunk = static_cast<std::size_t>(index);
        const Padding padding(array.grid.resolution);
        std::uint32_t* next = &places[chunk * cut.parts + sweep * in_sweep];
        for (std::size_t row = cut.begin_of(chunk); row < cut.begin_of(chunk + 1); ++row) {
            const auto bits = load_row<length>(&array.words.words[row * length]);
            if (is_blank(bits) || padding.holds(row)) continue;
            const std::size_t part = cut.part_of(hash_row(bits)) - sweep * in_sweep;
            if (part >= in_sweep) continue;  // of another sweep
            const std::size_t place = next[part]++;
            std::memcpy(&dealt.bits[place * length], bits.words.data(), sizeof bits);
            dealt.number[place] = static_cast<std::uint32_t>(row);
        }
        progress.advance();
    });
}

/// Open addressing from the hash to ids; grows with what it holds, and stays as large for the next part.
struct IdTable {
    struct Slot {
        std::uint32_t hash = 0, id_plus_1 = 0;  ///< 0: free
    };
    std::vector<Slot> slots = std::vector<Slot>(1024);

    std::size_t mask() const { return slots.size() - 1; }
    void clear() { std::ranges::fill(slots, Slot{}); }
    void grow() {
        std::vector<Slot> old(2 * slots.size());
        old.swap(slots);
        for (const Slot& slot : old) {
            if (slot.id_plus_1 == 0) continue;
            std::size_t at = slot.hash & mask();
            while (slots[at].id_plus_1 != 0) at = (at + 1) & mask();
            slots[at] = slot;
        }
    }
};

/// Finds the distinct rows among those dealt to one part and gives each of these its id inside the part.
template <int length>
void count_part(DealtRows<length>& dealt, std::size_t part, IdTable& table, const Progress& progress) {
    constexpr std::size_t rows_between_checks = 1u << 18u;
    const std::size_t begin = dealt.first[part], end = dealt.first[part + 1];
    std::uint32_t* const distinct_bits = dealt.bits.data() + begin * length;
    std::uint32_t distinct = 0;
    table.clear();
    for (std::size_t place = begin; place < end; ++place) {
        if ((place - begin) % rows_between_checks == 0) progress.check();
        const auto bits = load_row<length>(&dealt.bits[place * length]);
        const auto hash = static_cast<std::uint32_t>(hash_row(bits));
        std::size_t at = hash & table.mask();
        for (;; at = (at + 1) & table.mask()) {
            const auto [hash_there, id_plus_1] = table.slots[at];
            if (id_plus_1 == 0) break;
            if (hash_there == hash && load_row<length>(distinct_bits + (id_plus_1 - 1) * length) == bits) break;
        }
        const bool is_new = table.slots[at].id_plus_1 == 0;
        const std::uint32_t id = is_new ? distinct : table.slots[at].id_plus_1 - 1;
        dealt.id[place] = id;
        if (!is_new) {
            ++dealt.count[begin + id];
            continue;
        }
        table.slots[at] = {hash, id + 1};
        std::memcpy(distinct_bits + std::size_t{id} * length, bits.words.data(), sizeof bits);  // read already
        dealt.count[begin + id] = 1;
        if (2 * ++distinct > table.slots.size()) table.grow();
    }
    dealt.distinct[part] = distinct;
}

/// Counts all parts of a sweep.
template <int length>
void count_parts_of_sweep(DealtRows<length>& dealt, int threads, Progress& progress) {
    constexpr std::size_t parts_with_one_table = 8;
    const std::size_t parts = dealt.first.size() - 1;
    dealt.distinct.assign(parts, 0);
    parallel_for(static_cast<std::int64_t>((parts + parts_with_one_table - 1) / parts_with_one_table), threads,
                 [&](std::int64_t index) {
                     IdTable table;
                     const std::size_t first = static_cast<std::size_t>(index) * parts_with_one_table;
                     for (std::size_t part = first; part < std::min(parts, first + parts_with_one_table); ++part) {
                         count_part(dealt, part, table, progress);
                         progress.advance();
                     }
                 });
}

/// Copies a sweep's distinct rows to the histogram's parts, and tells the array's rows the ids that they have been
/// given.
template <int length>
void keep_sweep(const DealtRows<length>& dealt, std::size_t sweep, int threads, const Progress& progress,
                RowHistogram<length>& histogram) {
    const std::size_t parts = dealt.distinct.size();
    std::vector<std::size_t> first_row(parts + 1);
    for (std::size_t part = 0; part < parts; ++part) first_row[part + 1] = first_row[part] + dealt.distinct[part];
    HugeBuffer& memory = histogram.memory.emplace_back(allocate_huge(first_row.back() * (length + 1)));
    parallel_for(static_cast<std::int64_t>(parts), threads, [&](std::int64_t index) {
        progress.check();
        const auto part = static_cast<std::size_t>(index);
        const std::size_t begin = dealt.first[part], rows = dealt.distinct[part];
        const auto kept = memory.words.subspan(first_row[part] * (length + 1), rows * (length + 1));
        std::ranges::copy(dealt.bits.subspan(begin * length, rows * length), kept.begin());
        std::ranges::copy(dealt.count.subspan(begin, rows), kept.begin() + static_cast<std::ptrdiff_t>(rows * length));
        const std::uint32_t first_id = histogram.ids + static_cast<std::uint32_t>(first_row[part]);
        histogram.parts[sweep * parts + part] = {first_id, kept.first(rows * length), kept.last(rows)};
        for (std::size_t place = begin; place < dealt.first[part + 1]; ++place)
            histogram.id_of_row.words[dealt.number[place]] = first_id + dealt.id[place];
    });
    histogram.ids += static_cast<std::uint32_t>(first_row.back());
    histogram.distinct += first_row.back();
}

/// Memory for the largest sweep.
template <int length>
DealtRows<length> allocate_dealt(const Cut& cut, const std::vector<std::uint32_t>& counts) {
    std::vector<std::size_t> rows(cut.sweeps);
    for (std::size_t k = 0; k < counts.size(); ++k) rows[k % cut.parts / cut.parts_in_sweep()] += counts[k];
    const std::size_t most = *std::ranges::max_element(rows);
    const HugeBuffer memory = allocate_huge(most * (length + 3));
    const auto of = [&](std::size_t from, std::size_t words) {
        return memory.words.subspan(most * from, most * words);
    };
    return {memory, of(0, length), of(length, 1), of(length + 1, 1), of(length + 2, 1), {}};
}

/// The blank row, which has the id 0.
template <int length>
void keep_blank(std::uint32_t count, RowHistogram<length>& histogram) {
    const auto words = histogram.memory.emplace_back(allocate_huge(length + 1)).words;
    words[length] = count;
    histogram.parts.push_back({0, words.first(length), words.last(1)});
    ++histogram.distinct;
}

}  // namespace

std::uint64_t counting_bytes(std::size_t rows, int words_per_row, std::size_t distinct) {
    const Cut cut(rows, default_rows_per_part);
    const auto length = static_cast<std::uint64_t>(words_per_row);
    return sizeof(std::uint32_t) * (rows + rows / cut.sweeps * (length + 3) + distinct * (length + 1));
}

template <int length>
RowHistogram<length> count_rows(const RowArray& array, int threads, Progress& progress, std::size_t rows_per_part) {
    const RowGrid& grid = array.grid;
    assert(grid.words_per_row == length);
    const Cut cut(grid.rows(), rows_per_part);
    progress.begin("counting rows", static_cast<std::int64_t>((1 + cut.sweeps) * cut.chunks + cut.parts));
    std::uint64_t blank_rows = 0;
    std::vector<std::uint32_t> places = count_parts<length>(array, cut, threads, progress, blank_rows);
    RowHistogram<length> histogram;
    histogram.id_of_row = allocate_huge(cut.rows);
    histogram.parts.resize(cut.parts);
    auto dealt = allocate_dealt<length>(cut, places);
    for (std::size_t sweep = 0; sweep < cut.sweeps; ++sweep) {
        dealt.first = places_of(cut, sweep, places);
        deal(array, cut, sweep, places, threads, dealt, progress);
        count_parts_of_sweep(dealt, threads, progress);
        keep_sweep(dealt, sweep, threads, progress, histogram);
    }
    const auto n = static_cast<std::size_t>(grid.resolution);
    histogram.rows = grid.frames.size() * n * n;
    histogram.spare = dealt.memory;
    if (blank_rows > 0) keep_blank(static_cast<std::uint32_t>(blank_rows), histogram);
    return histogram;
}

template RowHistogram<1> count_rows(const RowArray&, int, Progress&, std::size_t);
template RowHistogram<2> count_rows(const RowArray&, int, Progress&, std::size_t);
template RowHistogram<4> count_rows(const RowArray&, int, Progress&, std::size_t);
template RowHistogram<8> count_rows(const RowArray&, int, Progress&, std::size_t);

}  // namespace sightlines::voxel_rows
