#include "techniques/voxel_rows/slice_bits.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace sightlines::voxel_rows {
namespace {

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

void SliceBits::pack(std::span<const std::uint8_t> bytes, int needed) {
    // Adding 128 - needed to a byte's lower seven bits carries into its top bit where they are at least `needed`.
    constexpr std::uint64_t lower_bits = 0x7f7f7f7f7f7f7f7fu, one_each = 0x0101010101010101u;
    const std::uint64_t carry = one_each * static_cast<std::uint64_t>(128 - std::min(needed, most_needed));
    for (std::size_t word = 0; word < rows.size(); ++word) {
        const std::uint8_t* marks = &bytes[word * 64];
        std::uint64_t packed = 0;
        for (unsigned group = 0; group < 8; ++group) {
            std::uint64_t eight = 0;
            std::memcpy(&eight, marks + 8 * group, sizeof eight);
            eight = ((eight | ((eight & lower_bits) + carry)) >> 7u) & one_each;
            // Eight bytes of 0 or 1 become eight neighbouring bits by one multiplication (no two products meet).
            packed |= ((eight * 0x0102040810204080u) >> 56u) << (8 * group);
        }
        rows[word] = packed;
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
    for (int w = 0; w < shape.resolution; ++w) {
        const std::size_t row =
            scalar_kernel::row_index(shape, {direction / shape.angles, direction % shape.angles}, v, w);
        std::memcpy(&array.words.words[row * length], &bits.rows[static_cast<std::size_t>(w) * bits.blocks],
                    length * sizeof(std::uint32_t));
    }
}

}  // namespace sightlines::voxel_rows
