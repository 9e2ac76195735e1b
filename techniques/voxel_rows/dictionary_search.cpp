#include "techniques/voxel_rows/dictionary_search.h"

#include <algorithm>
#include <numeric>

// The build fixes the instruction set.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/highway.h>

#include "techniques/base/parallel.h"

namespace sightlines::voxel_rows {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<std::uint64_t, 8>;
using Vector = hn::Vec<Tag>;
constexpr std::size_t lanes = hn::MaxLanes(Tag());

/// The row down-sampled by 32, 16 and 8, bit after bit from the top: rows sorted by it lie together where they are
/// alike after any of these steps.
template <int length>
std::uint64_t coarse_prefix(const RowBits<length>& row) {
    static_assert(length * (1 + 2 + 4) <= 64);
    std::uint64_t prefix = 0;
    for (int step = 5; step >= 3; --step) {
        const RowBits<length> key = simplify(row, step);
        for (const std::uint32_t word : key.words)
            for (unsigned bit = 0; bit < 32; bit += 1u << static_cast<unsigned>(step))
                prefix = prefix << 1u | (word >> bit & 1u);
    }
    return prefix;
}

template <int length>
SortedRows<length> sort_rows(const std::vector<RowBits<length>>& rows, const Progress& progress) {
    constexpr std::size_t rows_between_checks = 1u << 14u;
    std::vector<std::uint64_t> prefix(rows.size());
    for (std::size_t index = 0; index < rows.size(); ++index) {
        if (index % rows_between_checks == 0) progress.check();
        prefix[index] = coarse_prefix(rows[index]);
    }
    SortedRows<length> sorted;
    sorted.index.resize(rows.size());
    std::iota(sorted.index.begin(), sorted.index.end(), 0u);
    std::uint32_t compared = 0;
    std::ranges::sort(sorted.index, [&](std::uint32_t a, std::uint32_t b) {
        if (++compared % (1u << 16u) == 0) progress.check();
        if (prefix[a] != prefix[b]) return prefix[a] < prefix[b];
        for (int step = 2; step >= 1; --step)
            if (const auto order = simplify(rows[a], step) <=> simplify(rows[b], step); order != 0) return order < 0;
        return a < b;
    });
    constexpr std::size_t planes = std::tuple_size_v<RowPlanes<length>>;
    sorted.up.assign(planes, std::vector<std::uint64_t>(rows.size() + lanes));
    sorted.down = sorted.up;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (k % rows_between_checks == 0) progress.check();
        sorted.prefix.push_back(prefix[sorted.index[k]]);
        const RowBits<length>& row = rows[sorted.index[k]];
        const auto up = planes_of(row), down = planes_of(reversed(row));
        for (std::size_t plane = 0; plane < planes; ++plane) {
            sorted.up[plane][k] = up[plane];
            sorted.down[plane][k] = down[plane];
        }
    }
    return sorted;
}

template <int length>
DictionaryStep<length> make_step(const std::vector<RowBits<length>>& rows, const SortedRows<length>& sorted, int step,
                                 const Progress& progress) {
    std::vector<typename DictionaryStep<length>::Group> found;
    for (std::uint32_t k = 0; k < sorted.index.size(); ++k) {
        if (k % (1u << 14u) == 0) progress.check();
        const RowBits<length> key = simplify(rows[sorted.index[k]], step);
        if (found.empty() || found.back().key != key) found.push_back({key, {k, 0}, sorted.index[k]});
        ++found.back().range.count;
        found.back().lowest = std::min(found.back().lowest, sorted.index[k]);
    }
    DictionaryStep<length> made;
    made.step = step;
    made.groups.resize(std::bit_ceil(2 * found.size() + 1));
    for (const auto& group : found) {
        std::size_t at = made.place_of(group.key);
        while (made.groups[at].range.count != 0) at = (at + 1) & (made.groups.size() - 1);
        made.groups[at] = group;
    }
    return made;
}

/// The first set bit from `start` on of each lane's row; `end` where there is none.
template <std::size_t planes>
HWY_INLINE Vector next_set(const std::array<Vector, planes>& rows, std::uint32_t start, std::uint32_t end) {
    const Tag tag;
    Vector found = hn::Set(tag, end);
    for (std::size_t k = planes; k-- > start / 64;) {
        const std::uint64_t mask = k == start / 64 ? ~std::uint64_t{0} << (start % 64) : ~std::uint64_t{0};
        const Vector bits = hn::And(rows[k], hn::Set(tag, mask));
        const Vector below =
            hn::AndNot(bits, hn::Sub(bits, hn::Set(tag, 1)));  // the clear bits under the lowest set one
        const Vector place = hn::Add(hn::PopulationCount(below), hn::Set(tag, 64 * k));
        found = hn::IfThenElse(hn::Eq(bits, hn::Zero(tag)), found, place);
    }
    return found;
}

/// Adds how many of the rays one way each lane's row answers differently. Ends early where all lanes reach `enough`.
template <int length, std::size_t planes>
HWY_INLINE Vector add_differing(Vector sum, const Probes<length>& probes, const std::array<Vector, planes>& rows,
                                std::uint32_t end, Vector enough) {
    const Tag tag;
    for (std::size_t k = 0; k < probes.count; ++k) {
        if (hn::AllTrue(tag, hn::Eq(hn::Max(sum, enough), sum))) break;
        const Vector ours = next_set(rows, probes.probes[k].start, end);
        const Vector right = hn::Set(tag, probes.probes[k].blocker);
        sum = hn::Add(sum, hn::Sub(hn::Max(ours, right), hn::Min(ours, right)));
    }
    return sum;
}

}  // namespace

template <int length>
DictionarySearch<length> make_search(const std::vector<RowBits<length>>& rows, int resolution, int threads,
                                     Progress& progress) {
    DictionarySearch<length> search{rows, resolution, sort_rows(rows, progress), {}};
    search.steps.resize(coarsest_step);
    parallel_for(coarsest_step, threads, [&](std::int64_t k) {
        search.steps[static_cast<std::size_t>(k)] = make_step(rows, search.sorted, static_cast<int>(k) + 1, progress);
        progress.advance();
    });
    return search;
}

template <int length>
Match nearest_in(const SortedRows<length>& sorted, Range range, const RowBits<length>& row,
                 const RowProbes<length>& probes, Match best) {
    constexpr std::size_t planes = std::tuple_size_v<RowPlanes<length>>;
    constexpr unsigned voxel_bits = 16;
    const Tag tag;
    const RowPlanes<length> own = planes_of(row);
    std::uint64_t least = std::uint64_t{best.distance.rays} << voxel_bits | best.distance.voxels;
    for (std::uint32_t first = range.first; first < range.first + range.count; first += lanes) {
        std::array<Vector, planes> up, down;
        Vector voxels = hn::Zero(tag);
        for (std::size_t k = 0; k < planes; ++k) {
            up[k] = hn::LoadU(tag, &sorted.up[k][first]);
            down[k] = hn::LoadU(tag, &sorted.down[k][first]);
            voxels = hn::Add(voxels, hn::PopulationCount(hn::Xor(up[k], hn::Set(tag, own[k]))));
        }
        const Vector enough = hn::Set(tag, (least >> voxel_bits) + 1);
        Vector rays = add_differing<length>(hn::Zero(tag), probes.up, up, probes.up_end, enough);
        rays = add_differing<length>(rays, probes.down, down, probes.down_end, enough);
        alignas(64) std::array<std::uint64_t, lanes> distance;
        hn::Store(hn::Or(hn::ShiftLeft<voxel_bits>(rays), voxels), tag, distance.data());
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            if (distance[lane] >= least || first + lane >= range.first + range.count) continue;
            least = distance[lane];
            best.index = sorted.index[first + lane];
        }
    }
    best.distance = {static_cast<std::uint32_t>(least >> voxel_bits),
                     static_cast<std::uint32_t>(least & ((1u << voxel_bits) - 1))};
    return best;
}

template <int length>
std::uint32_t place_among(const SortedRows<length>& sorted, const RowBits<length>& row) {
    const auto place = std::ranges::lower_bound(sorted.prefix, coarse_prefix(row));
    return static_cast<std::uint32_t>(place - sorted.prefix.begin());
}

#define SIGHTLINES_FOR_ROW_LENGTH(length)                                                                         \
    template DictionarySearch<length> make_search(const std::vector<RowBits<length>>&, int, int, Progress&);      \
    template Match nearest_in(const SortedRows<length>&, Range, const RowBits<length>&, const RowProbes<length>&, \
                              Match);                                                                             \
    template std::uint32_t place_among(const SortedRows<length>&, const RowBits<length>&);
SIGHTLINES_FOR_ROW_LENGTH(1)
SIGHTLINES_FOR_ROW_LENGTH(2)
SIGHTLINES_FOR_ROW_LENGTH(4)
SIGHTLINES_FOR_ROW_LENGTH(8)
#undef SIGHTLINES_FOR_ROW_LENGTH

}  // namespace sightlines::voxel_rows
