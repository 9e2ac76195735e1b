// How differently two rows answer the rays that matter: those that leave a surface of the first towards lights.
#pragma once

#include <algorithm>

#include "techniques/voxel_rows/row_bits.h"

namespace sightlines::voxel_rows {

inline std::uint32_t reversed(std::uint32_t word) {
    word = (word & 0x55555555u) << 1u | (word >> 1u & 0x55555555u);
    word = (word & 0x33333333u) << 2u | (word >> 2u & 0x33333333u);
    word = (word & 0x0f0f0f0fu) << 4u | (word >> 4u & 0x0f0f0f0fu);
    return __builtin_bswap32(word);
}

/// The row as it is met from its other end: bit u becomes bit 32 * length - 1 - u.
template <int length>
RowBits<length> reversed(const RowBits<length>& row) {
    RowBits<length> back;
    for (std::size_t k = 0; k < length; ++k) back.words[length - 1 - k] = reversed(row.words[k]);
    return back;
}

/// The first set bit from `start` on; `end`, which no set bit is beyond, where there is none. Without branches, which
/// nobody could foretell: as long as all words were clear, the clear bits below a word's first set one are added.
template <std::size_t count>
std::uint32_t next_set(const std::array<std::uint64_t, count>& planes, std::uint32_t start, std::uint32_t end) {
    std::uint32_t place = 0, still_clear = ~0u;
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint64_t below = ~(~std::uint64_t{0} << (start % 64));
        const std::uint64_t left_out = k < start / 64 ? ~std::uint64_t{0} : k == start / 64 ? below : 0;
        const auto clear = static_cast<std::uint32_t>(std::countr_zero(planes[k] & ~left_out));
        place += clear & still_clear;
        still_clear &= 0u - (clear >> 6u);
    }
    return std::min(place, end);
}

template <int length>
constexpr int light_weight_shift = length > 4 ? 3 : 0;  ///< so that all of a row's lights can be counted in 32 bits

/// How many lights a ray reaches that passes so many free voxels. Where lights are spread evenly through space, as many
/// stand in a cone as its volume is: the cube of its length.
template <int length>
std::uint32_t light_weight(std::uint32_t free_voxels) {
    return free_voxels * free_voxels * free_voxels >> light_weight_shift<length>;
}

/// Rays that leave a surface one way and end at lights in any of the voxels from their start to the end of the row.
/// They start one and two voxels beyond the surface's own, as those that are asked do (their offsets are 1.5 voxels and
/// a little), where these are clear.
struct ProbePair {
    std::uint32_t way;            ///< 0: up; 1: down, in the reversed row
    std::uint32_t start;          ///< of the first ray; the second one's is the next voxel
    std::uint32_t second;         ///< all bits where there is a second ray, none where not
    std::uint32_t first_lights;   ///< light_weight of the voxels before the first set one, or before the row's end
    std::uint32_t second_lights;  ///< 0 where there is no second ray
};

/// All of a row's, made gap by gap: the clear voxels between two surfaces are left from both.
template <int length>
struct RowProbes {
    static constexpr std::uint32_t down_end = 32 * static_cast<std::uint32_t>(length);
    std::uint32_t up_end = 0;
    std::size_t count = 0;
    std::array<ProbePair, down_end + 1> pairs;

    RowProbes(const RowBits<length>& row, int resolution) : up_end(static_cast<std::uint32_t>(resolution)) {
        // Where the bits change, from the row's beginning on: a surface's first voxel and the one behind it by turns.
        std::array<std::uint32_t, down_end + 1> edges;
        std::size_t edge_count = 0;
        std::uint64_t before = 0;
        const RowPlanes<length> planes = planes_of(row);
        for (std::size_t k = 0; k < planes.size(); ++k) {
            for (std::uint64_t left = planes[k] ^ (planes[k] << 1u | before >> 63u); left != 0; left &= left - 1)
                edges[edge_count++] =
                    static_cast<std::uint32_t>(64 * k + static_cast<unsigned>(std::countr_zero(left)));
            before = planes[k];
        }
        if (edge_count == 0) return;
        if (edges[0] > 0) add(1, down_end - edges[0], edges[0]);
        for (std::size_t k = 1; k + 1 < edge_count; k += 2) {
            add(0, edges[k], edges[k + 1] - edges[k]);
            add(1, down_end - edges[k + 1], edges[k + 1] - edges[k]);
        }
        const std::uint32_t last = edges[edge_count - 1];
        if (edge_count % 2 == 0 && last < up_end) add(0, last, up_end - last);
    }

    /// How many lights there are in all.
    std::uint64_t lights() const {
        std::uint64_t sum = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t most = end(pairs[k].way) - pairs[k].start;
            sum += light_weight<length>(most) + (light_weight<length>(most - 1) & pairs[k].second);
        }
        return sum;
    }

    std::uint32_t end(std::uint32_t way) const { return way == 0 ? up_end : down_end; }

private:
    void add(std::uint32_t way, std::uint32_t start, std::uint32_t free_voxels) {
        const std::uint32_t second = free_voxels > 1 ? ~0u : 0u;
        pairs[count++] = {way, start, second, light_weight<length>(free_voxels), light_weight<length>(free_voxels - 1)};
    }
};

/// How many of the lights another row answers differently: for each start, those between the first blockers.
template <int length>
std::uint32_t differing_lights(const RowProbes<length>& probes, const RowBits<length>& other) {
    const std::array ways{planes_of(other), planes_of(reversed(other))};
    std::uint32_t sum = 0;
    const auto add = [&](std::uint32_t way, std::uint32_t start, std::uint32_t lights) {
        const auto others = light_weight<length>(next_set(ways[way], start, probes.end(way)) - start);
        sum += std::max(others, lights) - std::min(others, lights);
    };
    for (std::size_t k = 0; k < probes.count; ++k) {
        const ProbePair& pair = probes.pairs[k];
        add(pair.way, pair.start, pair.first_lights);
        if (pair.second != 0) add(pair.way, pair.start + 1, pair.second_lights);
    }
    return sum;
}

/// Voxels that are set in one of the rows only.
template <int length>
std::uint32_t differing_voxels(const RowBits<length>& a, const RowBits<length>& b) {
    int sum = 0;
    for (std::size_t k = 0; k < length; ++k) sum += std::popcount(a.words[k] ^ b.words[k]);
    return static_cast<std::uint32_t>(sum);
}

}  // namespace sightlines::voxel_rows
