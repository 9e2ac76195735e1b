#include "techniques/voxel_rows/slice_bits.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

// The build fixes the instruction set.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/highway.h>

namespace sightlines::voxel_rows {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
static_assert(std::endian::native == std::endian::little, "masks are stored byte by byte into 64-bit words");

/// Lane by lane. Highway 1.0 compares unsigned bytes for equality only.
template <class Vector>
auto at_least(Vector a, Vector b) {
    return hn::Eq(hn::Max(a, b), a);
}

/// Transposes 64 x 64 bits in place: swaps ever smaller off-diagonal squares (32, 16 ... 1).
void transpose_64(std::array<std::uint64_t, 64>& rows) {
    std::uint64_t mask = 0x00000000ffffffffu;
    for (unsigned width = 32; width != 0; width >>= 1u, mask ^= mask << width) {
        for (unsigned base = 0; base < 64; base += 2 * width) {
            for (unsigned k = base; k < base + width; ++k) {
                const std::uint64_t swapped = ((rows[k] >> width) ^ rows[k + width]) & mask;
                rows[k] ^= swapped << width;
                rows[k + width] ^= swapped;
            }
        }
    }
}

}  // namespace

void SliceCounts::clear() {
    for (int w = 0; w < side; ++w)
        std::memset(&bytes[static_cast<std::size_t>(place_of(0, w))], 0, static_cast<std::size_t>(side));
}

std::uint64_t SliceCounts::sum() const {
    const hn::CappedTag<std::uint8_t, 64> tag;
    const hn::RepartitionToWide<hn::RepartitionToWide<hn::RepartitionToWide<decltype(tag)>>> sums_tag;
    auto sums = hn::Zero(sums_tag);
    for (int w = 0; w < side; ++w)
        for (int u = 0; u < side; u += static_cast<int>(hn::Lanes(tag)))  // whole vectors: 64 divides the side
            sums = hn::Add(sums, hn::SumsOf8(hn::LoadU(tag, &bytes[static_cast<std::size_t>(place_of(u, w))])));
    return hn::GetLane(hn::SumOfLanes(sums_tag, sums));
}

void SliceBits::pack(const SliceCounts& counts, int axis, int needed) {
    const hn::CappedTag<std::uint8_t, 64> tag;
    const int lanes = static_cast<int>(hn::Lanes(tag)), step = axis == 0 ? 1 : counts.pitch;
    const auto least = hn::Set(tag, static_cast<std::uint8_t>(std::min(needed, SliceCounts::most)));
    auto* packed = reinterpret_cast<std::uint8_t*>(rows.data());
    for (int w = 0; w < counts.side; ++w) {
        for (int u = 0; u < counts.side; u += lanes) {
            const std::uint8_t* place = &counts.bytes[static_cast<std::size_t>(counts.place_of(u, w))];
            const auto own = hn::LoadU(tag, place);
            auto set = hn::Ne(own, hn::Zero(tag));
            if (needed > 0) {
                const auto neighbour = hn::Max(hn::LoadU(tag, place - step), hn::LoadU(tag, place + step));
                const auto with_neighbour =
                    hn::And(at_least(own, neighbour), at_least(hn::SaturatedAdd(own, neighbour), least));
                set = hn::And(set, hn::Or(at_least(own, least), with_neighbour));
            }
            packed += hn::StoreMaskBits(tag, set, packed);
        }
    }
}

void SliceBits::transpose_of(const SliceBits& other) {
    std::array<std::uint64_t, 64> square;
    const auto n = static_cast<std::size_t>(blocks);
    for (std::size_t row_block = 0; row_block < n; ++row_block) {
        for (std::size_t column_block = 0; column_block < n; ++column_block) {
            for (std::size_t k = 0; k < 64; ++k) square[k] = other.rows[(row_block * 64 + k) * n + column_block];
            transpose_64(square);
            for (std::size_t k = 0; k < 64; ++k) rows[(column_block * 64 + k) * n + row_block] = square[k];
        }
    }
}

void store_slice(RowArray& array, const RowShape& shape, int direction, int v, const SliceBits& bits) {
    const auto length = static_cast<std::size_t>(shape.words_per_row);
    const scalar_kernel::Direction steps{direction / shape.angles, direction % shape.angles};
    for (int w = 0; w < shape.resolution; ++w) {
        std::uint32_t* row = &array.words.words[scalar_kernel::row_index(shape, steps, v, w) * length];
        const std::uint64_t* from = &bits.rows[static_cast<std::size_t>(w) * bits.blocks];
        if (length == 4) {
            std::memcpy(row, from, 4 * sizeof(std::uint32_t));  // a fixed size: one move, no call
        } else {
            std::memcpy(row, from, length * sizeof(std::uint32_t));
        }
    }
}

}  // namespace sightlines::voxel_rows
