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

/// Rays that start at one voxel and end at lights in any of the voxels from there to the end of the row.
struct Probe {
    std::uint32_t start;
    std::uint32_t lights;  ///< light_weight of the voxels before the first set one, or before the row's end
};

/// The rays that leave a row's surfaces one way. They start one and two voxels beyond the surface's own, as those that
/// are asked do (their offsets are 1.5 voxels and a little), where these are clear.
template <int length>
struct Probes {
    std::array<Probe, 64 * static_cast<std::size_t>(length) / 3 + 1> probes;
    std::size_t count = 0;
};

/// `end`: of the row on the rays' way: the resolution on the way up, all 32 * length bits for a reversed row.
template <int length>
Probes<length> probes_of(const RowBits<length>& row, std::uint32_t end) {
    const RowPlanes<length> planes = planes_of(row);
    Probes<length> made;
    std::uint64_t before = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const std::uint64_t one_back = planes[k] << 1u | before >> 63u, two_back = planes[k] << 2u | before >> 62u;
        for (std::uint64_t starts = (one_back | two_back) & ~planes[k]; starts != 0; starts &= starts - 1) {
            const auto start = static_cast<std::uint32_t>(64 * k + std::countr_zero(starts));
            if (start >= end) continue;
            made.probes[made.count++] = {start, light_weight<length>(next_set(planes, start, end) - start)};
        }
        before = planes[k];
    }
    return made;
}

/// Both ways.
template <int length>
struct RowProbes {
    Probes<length> up, down;  ///< down: of the reversed row
    std::uint32_t up_end = 0;
    static constexpr std::uint32_t down_end = 32 * static_cast<std::uint32_t>(length);

    RowProbes(const RowBits<length>& row, int resolution)
        : up(probes_of(row, static_cast<std::uint32_t>(resolution))),
          down(probes_of(reversed(row), down_end)),
          up_end(static_cast<std::uint32_t>(resolution)) {}

    /// How many lights there are in all.
    std::uint64_t lights() const {
        std::uint64_t sum = 0;
        for (std::size_t k = 0; k < up.count; ++k) sum += light_weight<length>(up_end - up.probes[k].start);
        for (std::size_t k = 0; k < down.count; ++k) sum += light_weight<length>(down_end - down.probes[k].start);
        return sum;
    }
};

/// How many of the lights another row answers differently: for each start, those between the first blockers.
template <int length>
std::uint32_t differing_lights(const RowProbes<length>& probes, const RowBits<length>& other) {
    const auto differing = [](const Probes<length>& way, const RowPlanes<length>& planes, std::uint32_t end) {
        std::uint32_t sum = 0;
        for (std::size_t k = 0; k < way.count; ++k) {
            const Probe& probe = way.probes[k];
            const auto lights = light_weight<length>(next_set(planes, probe.start, end) - probe.start);
            sum += std::max(lights, probe.lights) - std::min(lights, probe.lights);
        }
        return sum;
    };
    return differing(probes.up, planes_of(other), probes.up_end) +
           differing(probes.down, planes_of(reversed(other)), probes.down_end);
}

/// Voxels that are set in one of the rows only.
template <int length>
std::uint32_t differing_voxels(const RowBits<length>& a, const RowBits<length>& b) {
    int sum = 0;
    for (std::size_t k = 0; k < length; ++k) sum += std::popcount(a.words[k] ^ b.words[k]);
    return static_cast<std::uint32_t>(sum);
}

}  // namespace sightlines::voxel_rows
