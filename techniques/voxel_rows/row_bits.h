// One row of bits as a value: what the dictionary (Wang 2017, Algorithm 2) does with rows one by one.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace sightlines::voxel_rows {

/// 32 * length bits, bit u of the row in bit u % 32 of word u / 32.
template <int length>
struct RowBits {
    std::array<std::uint32_t, static_cast<std::size_t>(length)> words{};

    /// That of std::array calls the C library for every row.
    bool operator==(const RowBits& other) const {
        std::uint32_t differing = 0;
        for (std::size_t k = 0; k < words.size(); ++k) differing |= words[k] ^ other.words[k];
        return differing == 0;
    }
    auto operator<=>(const RowBits&) const = default;
};

template <int length>
RowBits<length> load_row(const std::uint32_t* from) {
    RowBits<length> row;
    std::memcpy(row.words.data(), from, sizeof row);
    return row;
}

/// A row as 64-bit words, bit u in bit u % 64 of word u / 64.
template <int length>
using RowPlanes = std::array<std::uint64_t, (static_cast<std::size_t>(length) + 1) / 2>;

template <int length>
RowPlanes<length> planes_of(const RowBits<length>& row) {
    static_assert(std::endian::native == std::endian::little);
    RowPlanes<length> planes{};
    std::memcpy(planes.data(), row.words.data(), sizeof row);
    return planes;
}

template <int length>
bool is_blank(const RowBits<length>& row) {
    std::uint32_t any = 0;
    for (const std::uint32_t word : row.words) any |= word;
    return any == 0;
}

/// A hash whose upper and lower bits are both good.
template <int length>
std::uint64_t hash_row(const RowBits<length>& row) {
    std::uint64_t hash = 0;
    for (std::size_t k = 0; k < length; k += 2) {
        std::uint64_t pair = row.words[k];
        if (k + 1 < length) pair |= std::uint64_t{row.words[k + 1]} << 32u;
        hash = (hash ^ pair) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32u;
    }
    hash *= 0xd1342543de82ef95u;
    return hash ^ hash >> 32u;
}

/// The lowest bit of each group of 2^step bits.
constexpr std::array<std::uint32_t, 6> lowest_of_groups{0xffffffffu, 0x55555555u, 0x11111111u,
                                                        0x01010101u, 0x00010001u, 0x00000001u};

/// The lowest bit of each group of 2^(step + 1) is set iff any of the group is, where that holds for 2^step already.
inline std::uint32_t gather_groups(std::uint32_t word, int step) {
    return word | word >> (1u << static_cast<unsigned>(step));
}

/// Down-sampled by 2^step, at most 32: the lowest bit of each group of 2^step is set iff any of the group is; the
/// others are clear.
template <int length>
[[gnu::always_inline]] inline RowBits<length> simplify(RowBits<length> row, int step) {
    for (std::uint32_t& word : row.words) {
        for (int k = 0; k < step; ++k) word = gather_groups(word, k);
        word &= lowest_of_groups[static_cast<std::size_t>(step)];
    }
    return row;
}

/// The row moved up by `shift` voxels, 0 to 31; what leaves it is lost. Rows are down-sampled in two ways, as they are
/// and moved by half of what becomes one voxel, so that a surface at the edge of a coarse voxel in one is in the middle
/// of another in the other.
template <int length>
RowBits<length> shifted(const RowBits<length>& row, int shift) {
    if (shift == 0) return row;
    // All of this is by 64 bits: what was just stored by 32 could not be loaded at once as more.
    RowPlanes<length> planes = planes_of(row);
    for (std::size_t k = planes.size(); k-- > 0;)
        planes[k] = planes[k] << shift | (k > 0 ? planes[k - 1] >> (64 - shift) : 0);
    RowBits<length> moved;
    std::memcpy(moved.words.data(), planes.data(), sizeof moved);
    return moved;
}

/// The first step from `least` on, at most 5, after which the two rows are alike; `end` where none before that is.
template <int length>
int first_common_step(RowBits<length> a, RowBits<length> b, int least, int end) {
    for (int step = 0; step < end; ++step) {
        std::uint32_t differing = 0;
        for (std::size_t k = 0; k < length; ++k)
            differing |= (a.words[k] ^ b.words[k]) & lowest_of_groups[static_cast<std::size_t>(step)];
        if (step >= least && differing == 0) return step;
        if (step + 1 == end) break;  // a group of 64 would be more than a word
        for (std::size_t k = 0; k < length; ++k) {
            a.words[k] = gather_groups(a.words[k], step);
            b.words[k] = gather_groups(b.words[k], step);
        }
    }
    return end;
}

/// Calls body(integral constant) with the words of a row as a constant: 1, 2, 4 or 8.
template <class Body>
decltype(auto) with_row_length(int words_per_row, const Body& body) {
    switch (words_per_row) {
        case 1:
            return body(std::integral_constant<int, 1>());
        case 2:
            return body(std::integral_constant<int, 2>());
        case 4:
            return body(std::integral_constant<int, 4>());
        default:
            return body(std::integral_constant<int, 8>());
    }
}

}  // namespace sightlines::voxel_rows
