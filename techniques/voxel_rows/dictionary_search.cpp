#include "techniques/voxel_rows/dictionary_search.h"

#include <algorithm>
#include <ranges>

// The build fixes the instruction set.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/highway.h>

#include "techniques/base/parallel.h"
#include "techniques/base/parallel_sort.h"
#include "techniques/voxel_rows/row_deals.h"

namespace sightlines::voxel_rows {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<std::uint32_t, rows_at_once>;
using Vector = hn::Vec<Tag>;
constexpr std::size_t lanes = hn::MaxLanes(Tag());
template <int length>
constexpr std::size_t way_words = 2 * static_cast<std::size_t>(length) * lanes;

constexpr std::size_t rows_between_checks = 1u << 14u;
constexpr std::size_t pairs_between_checks = 4;

/// Which of two rows comes first where their prefix and fine key are the same: down-sampled by 2, and then the bits
/// themselves.
template <int length>
bool comes_before(const RowBits<length>& a, const RowBits<length>& b, int shift) {
    const auto by_2 = simplify(shifted(a, shift), 1) <=> simplify(shifted(b, shift), 1);
    return by_2 != 0 ? by_2 < 0 : a < b;
}

/// Calls body(place) for all places below `count`.
template <class Body>
void for_each_place(std::size_t count, int threads, const Progress& progress, const Body& body) {
    const std::size_t chunks = (count + rows_between_checks - 1) / rows_between_checks;
    parallel_for(static_cast<std::int64_t>(chunks), threads, [&](std::int64_t chunk) {
        progress.check();
        const std::size_t first = static_cast<std::size_t>(chunk) * rows_between_checks;
        for (std::size_t place = first; place < std::min(count, first + rows_between_checks); ++place) body(place);
    });
}

/// Fills rows, prefix, fine and index.
template <int length>
void put_in_order(const std::vector<RowBits<length>>& rows, SortedRows<length>& sorted, int threads,
                  const Progress& progress) {
    struct Numbered {
        std::uint64_t prefix, fine;
        std::uint32_t index;
    };
    std::vector<Numbered> order(rows.size());
    for_each_place(rows.size(), threads, progress, [&](std::size_t index) {
        const RowBits<length> moved = shifted(rows[index], sorted.shift);
        order[index] = {coarse_prefix(moved), fine_key(moved), static_cast<std::uint32_t>(index)};
    });
    sort_in_parallel(order, threads, [&](const Numbered& a, const Numbered& b) {
        progress.check();
        if (a.prefix != b.prefix) return a.prefix < b.prefix;
        if (a.fine != b.fine) return a.fine < b.fine;
        return comes_before(rows[a.index], rows[b.index], sorted.shift);
    });
    sorted.rows.resize(rows.size());
    sorted.prefix.resize(rows.size());
    sorted.fine.resize(rows.size());
    sorted.index.resize(rows.size());
    for_each_place(rows.size(), threads, progress, [&](std::size_t place) {
        const Numbered& each = order[place];
        sorted.rows[place] = rows[each.index];
        sorted.prefix[place] = each.prefix;
        sorted.fine[place] = each.fine;
        sorted.index[place] = each.index;
    });
}

template <int length>
RowBits<length> key_of(const SortedRows<length>& sorted, std::uint32_t place, int step) {
    return simplify(shifted(sorted.rows[place], sorted.shift), step);
}

template <int length>
void find_groups(SortedRows<length>& sorted, int step, const Progress& progress) {
    const auto which = static_cast<std::size_t>(step - 1);
    for (std::uint32_t first = 0, end = 0; first < sorted.rows.size(); first = end) {
        const RowBits<length> key = key_of(sorted, first, step);
        Group group{{first, 0}, first};
        for (; end < sorted.rows.size() && key_of(sorted, end, step) == key; ++end) {
            if (end % rows_between_checks == 0) progress.check();
            if (sorted.index[end] < sorted.index[group.best]) group.best = end;
        }
        group.range.count = end - first;
        for (std::uint32_t place = first; place < end; ++place) sorted.groups[place][which] = group;
    }
}

/// Writes one lane of one way of a block.
template <int length>
void fill_lane(const RowBits<length>& row, std::uint32_t end, std::uint32_t* lane) {
    std::uint32_t next = end;
    for (std::size_t word = length; word-- > 0;) {
        const std::uint32_t bits = row.words[word];
        lane[word * lanes] = bits;
        lane[(length + word) * lanes] = next;
        if (bits != 0)
            next = static_cast<std::uint32_t>(32 * word) + static_cast<std::uint32_t>(std::countr_zero(bits));
    }
}

template <int length>
void fill_blocks(SortedRows<length>& sorted, int resolution, const Progress& progress) {
    const std::size_t blocks = (sorted.rows.size() + lanes - 1) / lanes;
    sorted.blocks = reuse_huge(sorted.blocks, blocks * 2 * way_words<length>);
    for (std::size_t place = 0; place < sorted.rows.size(); ++place) {
        if (place % rows_between_checks == 0) progress.check();
        std::uint32_t* lane = &sorted.blocks.words[place / lanes * 2 * way_words<length> + place % lanes];
        fill_lane(sorted.rows[place], static_cast<std::uint32_t>(resolution), lane);
        fill_lane(reversed(sorted.rows[place]), RowProbes<length>::down_end, lane + way_words<length>);
    }
}

/// The clear bits below the lowest set one: 32 where none is set.
HWY_INLINE Vector clear_below(Vector bits) {
    const Tag tag;
    return hn::PopulationCount(hn::AndNot(bits, hn::Sub(bits, hn::Set(tag, 1))));
}

/// light_weight of each lane.
template <int length>
HWY_INLINE Vector light_weights(Vector free_voxels) {
    const Vector cube = hn::Mul(hn::Mul(free_voxels, free_voxels), free_voxels);
    return hn::ShiftRight<light_weight_shift<length>>(cube);
}

/// How many of the lights each lane's row answers differently. Ends early where all lanes exceed `most`.
template <int length>
HWY_INLINE Vector differing_lights_of(const RowProbes<length>& probes, const std::uint32_t* block, Vector most) {
    const Tag tag;
    const hn::RebindToSigned<Tag> signed_tag;
    const auto difference = [&](Vector a, std::uint32_t b) {  // of numbers below 2^31
        return hn::BitCast(tag, hn::Abs(hn::BitCast(signed_tag, hn::Sub(a, hn::Set(tag, b)))));
    };
    Vector sum = hn::Zero(tag);
    for (std::size_t k = 0; k < probes.count; ++k) {
        if (k % pairs_between_checks == 0 && hn::AllTrue(tag, hn::Gt(sum, most))) break;
        const ProbePair& pair = probes.pairs[k];
        const std::uint32_t word = pair.start / 32, bit = pair.start % 32;
        const std::uint32_t* way = block + pair.way * way_words<length>;
        // The first set bit behind the first start: in the same word or, where that has none, the one behind the word.
        const Vector bits = hn::LoadU(tag, way + word * lanes);
        const Vector behind = hn::And(bits, hn::Set(tag, ~1u << bit));
        const Vector place = hn::Add(clear_below(behind), hn::Set(tag, 32 * word));
        const Vector next =
            hn::IfThenElse(hn::Eq(behind, hn::Zero(tag)), hn::LoadU(tag, way + (length + word) * lanes), place);
        const Vector from_second = hn::Sub(next, hn::Set(tag, pair.start + 1));
        const auto first_is_clear = hn::Eq(hn::And(bits, hn::Set(tag, 1u << bit)), hn::Zero(tag));
        const Vector from_first = hn::IfThenElseZero(first_is_clear, hn::Add(from_second, hn::Set(tag, 1)));
        sum = hn::Add(sum, difference(light_weights<length>(from_first), pair.first_lights));
        const Vector of_second = difference(light_weights<length>(from_second), pair.second_lights);
        sum = hn::Add(sum, hn::And(of_second, hn::Set(tag, pair.second)));
    }
    return sum;
}

}  // namespace

template <int length>
SortedRows<length> sort_rows(const std::vector<RowBits<length>>& rows, int resolution, int shift, int threads,
                             Progress& progress, SortedRows<length> spare) {
    SortedRows<length> sorted = std::move(spare);
    sorted.shift = shift;
    put_in_order(rows, sorted, threads, progress);
    sorted.groups.resize(rows.size());
    parallel_for(coarsest_step + 1, threads, [&](std::int64_t step) {
        if (step == 0)
            fill_blocks(sorted, resolution, progress);
        else
            find_groups(sorted, static_cast<int>(step), progress);
    });
    return sorted;
}

template <int length>
std::uint32_t place_among(const SortedRows<length>& sorted, Range within, const RowBits<length>& row) {
    const RowBits<length> moved = shifted(row, sorted.shift);
    const std::uint64_t prefix = coarse_prefix(moved);
    // Halves without branches, which nobody could foretell.
    std::uint32_t first = within.first;
    for (std::uint32_t count = within.count; count > 0;) {
        const std::uint32_t half = (count + 1) / 2;
        first += sorted.prefix[first + half - 1] < prefix ? half : 0;
        count -= half;
    }
    const std::uint32_t end = within.first + within.count;
    if (first == end || sorted.prefix[first] != prefix) return first;
    const std::uint64_t fine = fine_key(moved);
    const auto before = [&](std::uint32_t place) {
        if (sorted.prefix[place] != prefix) return false;
        if (sorted.fine[place] != fine) return sorted.fine[place] < fine;
        return comes_before(sorted.rows[place], row, sorted.shift);
    };
    if (!before(first)) return first;
    const auto places = std::views::iota(first, end);  // several rows have this prefix
    return first + static_cast<std::uint32_t>(std::ranges::partition_point(places, before) - places.begin());
}

template <int length>
Match nearest_in(const SortedRows<length>& sorted, Range range, const RowBits<length>& row,
                 const RowProbes<length>& probes, Match best) {
    const Tag tag;
    for (std::size_t first = range.first / lanes * lanes; first < range.end(); first += lanes) {
        const std::uint32_t* up = &sorted.blocks.words[first / lanes * 2 * way_words<length>];
        const Vector most = hn::Set(tag, best.distance.lights);
        const Vector lights = differing_lights_of(probes, up, most);
        if (hn::AllTrue(tag, hn::Gt(lights, most))) continue;
        Vector voxels = hn::Zero(tag);
        for (std::size_t k = 0; k < length; ++k)
            voxels = hn::Add(voxels,
                             hn::PopulationCount(hn::Xor(hn::LoadU(tag, up + k * lanes), hn::Set(tag, row.words[k]))));
        alignas(64) std::array<std::uint32_t, lanes> lane_lights, lane_voxels;
        hn::Store(lights, tag, lane_lights.data());
        hn::Store(voxels, tag, lane_voxels.data());
        const std::size_t begin = std::max<std::size_t>(range.first, first);
        const std::size_t end = std::min<std::size_t>(range.end(), first + lanes);
        for (std::size_t k = begin; k < end; ++k)
            if (const Distance distance{lane_lights[k - first], lane_voxels[k - first]}; distance < best.distance)
                best = {static_cast<std::uint32_t>(k), distance};
    }
    return best;
}

#define SIGHTLINES_FOR_ROW_LENGTH(length)                                                                         \
    template SortedRows<length> sort_rows(const std::vector<RowBits<length>>&, int, int, int, Progress&,          \
                                          SortedRows<length>);                                                    \
    template std::uint32_t place_among(const SortedRows<length>&, Range, const RowBits<length>&);                 \
    template Match nearest_in(const SortedRows<length>&, Range, const RowBits<length>&, const RowProbes<length>&, \
                              Match);
SIGHTLINES_FOR_ROW_LENGTH(1)
SIGHTLINES_FOR_ROW_LENGTH(2)
SIGHTLINES_FOR_ROW_LENGTH(4)
SIGHTLINES_FOR_ROW_LENGTH(8)
#undef SIGHTLINES_FOR_ROW_LENGTH

}  // namespace sightlines::voxel_rows
