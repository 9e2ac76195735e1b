#include "techniques/voxel_rows/slice_bits.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

// The build fixes the instruction set.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/cache_control.h>
#include <hwy/highway.h>

namespace sightlines::voxel_rows {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
static_assert(std::endian::native == std::endian::little, "masks are stored byte by byte into 64-bit words");

using ByteTag = hn::CappedTag<std::uint8_t, 64>;
using WordTag = hn::CappedTag<std::uint64_t, 8>;

/// Lane by lane. Highway 1.0 compares unsigned bytes for equality only.
template <class Vector>
auto at_least(Vector a, Vector b) {
    return hn::Eq(hn::Max(a, b), a);
}

/// Which voxels are set, by what they hold and what the fuller neighbour does.
template <class Vector>
auto is_set(Vector own, Vector neighbour, Vector needed) {
    const auto together = hn::SaturatedAdd(own, hn::IfThenElseZero(at_least(own, neighbour), neighbour));
    return at_least(together, needed);
}

/// Swaps the squares right of the diagonal with those below it: the `width` high bits of each 2 `width` of a row in the
/// upper half with the low bits of its partner, `width` rows below. `low` marks the low bits.
template <class Vector>
void swap_squares(Vector& upper, Vector& lower, Vector low, int width) {
    const auto swapped = hn::And(hn::Xor(hn::ShiftRightSame(upper, width), lower), low);
    upper = hn::Xor(upper, hn::ShiftLeftSame(swapped, width));
    lower = hn::Xor(lower, swapped);
}

/// The same where the partners are lanes of one vector, `width` apart.
template <class Vector>
Vector swap_squares_within(Vector rows, Vector low, int width) {
    const WordTag tag;
    const auto lane = hn::Iota(tag, 0);
    const auto partner = hn::TableLookupLanes(
        rows, hn::IndicesFromVec(tag, hn::Xor(lane, hn::Set(tag, static_cast<std::uint64_t>(width)))));
    const auto is_upper = hn::TestBit(lane, hn::Set(tag, static_cast<std::uint64_t>(width)));
    const auto upper = hn::OrAnd(hn::And(rows, low), hn::ShiftLeftSame(partner, width), hn::Not(low));
    const auto lower = hn::OrAnd(hn::AndNot(low, rows), hn::ShiftRightSame(partner, width), low);
    return hn::IfThenElse(is_upper, lower, upper);
}

/// Transposes 64 x 64 bits: swaps ever smaller squares off the diagonal (32, 16 ... 1).
void transpose_64(const std::uint64_t* from, std::uint64_t* to) {
    const WordTag tag;
    const int lanes = static_cast<int>(hn::Lanes(tag));
    std::uint64_t low_bits = 0x00000000ffffffffu;
    for (int width = 32; width != 0; width /= 2, low_bits ^= low_bits << width) {
        const auto low = hn::Set(tag, low_bits);
        for (int base = 0; base < 64; base += std::max(2 * width, lanes)) {
            for (int k = base; k < base + std::max(width, lanes); k += lanes) {
                auto upper = hn::Load(tag, from + k);
                if (width < lanes) {
                    hn::Store(swap_squares_within(upper, low, width), tag, to + k);
                } else {
                    auto lower = hn::Load(tag, from + k + width);
                    swap_squares(upper, lower, low, width);
                    hn::Store(upper, tag, to + k);
                    hn::Store(lower, tag, to + k + width);
                }
            }
        }
        from = to;
    }
}

}  // namespace

std::uint64_t take_bits(SliceCounts& counts, Needed needed, SliceBits& along_u, SliceBits& along_w) {
    const ByteTag tag;
    const hn::RepartitionToWide<hn::RepartitionToWide<hn::RepartitionToWide<ByteTag>>> sums_tag;
    const int lanes = static_cast<int>(hn::Lanes(tag)), side = counts.side, pitch = counts.pitch;
    const auto needed_u = hn::Set(tag, static_cast<std::uint8_t>(std::clamp(needed.along_u, 1, SliceCounts::most)));
    const auto needed_w = hn::Set(tag, static_cast<std::uint8_t>(std::clamp(needed.along_w, 1, SliceCounts::most)));
    auto* const packed_u = reinterpret_cast<std::uint8_t*>(along_u.words.data());
    auto* const packed_w = reinterpret_cast<std::uint8_t*>(along_w.words.data());
    auto sums = hn::Zero(sums_tag);
    for (int w = 0; w < side; ++w) {
        std::uint8_t* const row = &counts.bytes[static_cast<std::size_t>(counts.place_of(0, w))];
        for (int u = 0; u < side; u += lanes) {
            const auto own = hn::Load(tag, row + u);
            const auto beside = hn::Max(hn::LoadU(tag, row + u - 1), hn::LoadU(tag, row + u + 1));
            const auto above_or_below = hn::Max(hn::Load(tag, row + u - pitch), hn::Load(tag, row + u + pitch));
            const int at = (u / 64 * side + w) * 8 + u % 64 / 8;
            hn::StoreMaskBits(tag, is_set(own, beside, needed_u), packed_u + at);
            hn::StoreMaskBits(tag, is_set(own, above_or_below, needed_w), packed_w + at);
            sums = hn::Add(sums, hn::SumsOf8(own));
        }
        // A row is emptied when the next one has seen it.
        for (int u = 0; u < side && w > 0; u += lanes) hn::Store(hn::Zero(tag), tag, row + u - pitch);
    }
    std::uint8_t* const last_row = &counts.bytes[static_cast<std::size_t>(counts.place_of(0, side - 1))];
    for (int u = 0; u < side; u += lanes) hn::Store(hn::Zero(tag), tag, last_row + u);
    return hn::GetLane(hn::SumOfLanes(sums_tag, sums));
}

void transpose(const SliceBits& bits, SliceBits& transposed) {
    for (int row = 0; row < bits.side; row += 64)
        for (int column = 0; column < bits.side; column += 64)
            transpose_64(&bits.words[static_cast<std::size_t>(column / 64 * bits.side + row)],
                         &transposed.words[static_cast<std::size_t>(row / 64 * bits.side + column)]);
}

namespace {

/// Eight rows from `w` on, one after the other: rows of 64 bits and more as they are, shorter ones cut off.
template <int words_per_row>
void collect_eight(const SliceBits& bits, int w, std::uint32_t* rows) {
    const int blocks = std::min((words_per_row + 1) / 2, bits.side / 64);  // 129 to 192 voxels: 6 of 8 words
    constexpr std::size_t bytes = std::min(words_per_row, 2) * sizeof(std::uint32_t);
    for (int k = 0; k < 8; ++k)
        for (int block = 0; block < blocks; ++block)
            std::memcpy(rows + k * words_per_row + 2 * block,
                        &bits.words[static_cast<std::size_t>(block * bits.side + w + k)], bytes);
}

/// Eight rows lie together in memory. They are written around the cache where they replace others: nothing here reads
/// them again.
template <int words_per_row>
void store_rows(RowArray& array, const RowShape& shape, scalar_kernel::Direction steps, int v, const SliceBits& bits,
                Storing storing) {
    constexpr std::size_t words = std::size_t{8} * words_per_row;
    const hn::CappedTag<std::uint32_t, std::min<std::size_t>(words, 16)> tag;
    alignas(64) std::array<std::uint32_t, words> rows{};
    for (int w = 0; w < shape.resolution; w += 8) {
        collect_eight<words_per_row>(bits, w, rows.data());
        std::uint32_t* const to = &array.words.words[scalar_kernel::row_index(shape, steps, v, w) * words_per_row];
        for (std::size_t k = 0; k < words; k += hn::Lanes(tag)) {
            const auto row = hn::Load(tag, &rows[k]);
            if (storing == Storing::replace)
                hn::Stream(row, tag, to + k);
            else
                hn::Store(hn::Or(row, hn::Load(tag, to + k)), tag, to + k);
        }
    }
}

}  // namespace

void unpack_slice(const SliceBits& bits, int resolution, int v, std::span<std::uint8_t> occupied) {
    const auto n = static_cast<std::size_t>(resolution), side = static_cast<std::size_t>(bits.side);
    for (std::size_t w = 0; w < n; ++w)
        for (std::size_t u = 0; u < n; ++u)
            occupied[(w * n + static_cast<std::size_t>(v)) * n + u] =
                static_cast<std::uint8_t>(bits.words[u / 64 * side + w] >> (u % 64) & 1u);
}

void store_slice(RowArray& array, const RowShape& shape, int direction, int v, const SliceBits& bits, Storing storing) {
    const scalar_kernel::Direction steps{direction / shape.angles, direction % shape.angles};
    switch (shape.words_per_row) {
        case 1:
            return store_rows<1>(array, shape, steps, v, bits, storing);
        case 2:
            return store_rows<2>(array, shape, steps, v, bits, storing);
        case 4:
            return store_rows<4>(array, shape, steps, v, bits, storing);
        default:
            return store_rows<8>(array, shape, steps, v, bits, storing);
    }
}

void finish_storing() { hwy::FlushStream(); }

}  // namespace sightlines::voxel_rows
