#include "techniques/visibility_field/mask_rows.h"

#include <algorithm>
#include <bit>

namespace sightlines::visibility_field {
namespace {

std::uint64_t mirrored(std::uint64_t row, int size) {
    std::uint64_t result = 0;
    for (int column = 0; column < size; ++column) result |= (row >> column & 1u) << (size - 1 - column);
    return result;
}

}  // namespace

MaskRows dilated(const MaskRows& rows, int size) {
    const auto count = static_cast<std::size_t>(size);
    const std::uint64_t inside = size == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << size) - 1;
    const std::uint64_t last = std::uint64_t{1} << (size - 1);
    MaskRows across{};
    for (std::size_t y = 0; y < count; ++y) {
        // To the left of (0, y) lies (0, size - 1 - y), and likewise on the right.
        const std::uint64_t beyond = rows[count - 1 - y] & (last | 1u);
        across[y] = (rows[y] | rows[y] << 1u | rows[y] >> 1u | beyond) & inside;
    }
    MaskRows result{};
    for (std::size_t y = 0; y < count; ++y) {
        // Above (x, 0) lies (size - 1 - x, 0), and likewise below.
        const std::uint64_t above = y > 0 ? across[y - 1] : mirrored(across[0], size);
        const std::uint64_t below = y + 1 < count ? across[y + 1] : mirrored(across[count - 1], size);
        result[y] = across[y] | above | below;
    }
    return result;
}

MaskRows reduced(const MaskRows& rows, int size, int steps) {
    if (steps == 1) return rows;
    const std::uint64_t parts = (std::uint64_t{1} << steps) - 1;
    MaskRows result{};
    for (int y = 0; y < size; ++y) {
        std::uint64_t row = 0;
        for (int k = 0; k < steps; ++k) row |= rows[static_cast<std::size_t>(y * steps + k)];
        for (int x = 0; x < size; ++x)
            result[static_cast<std::size_t>(y)] |= std::uint64_t{(row >> (x * steps) & parts) != 0} << x;
    }
    return result;
}

int texels_set(const MaskRows& rows) {
    int set = 0;
    for (const std::uint64_t row : rows) set += std::popcount(row);
    return set;
}

void pack(const MaskRows& rows, int size, std::span<std::uint32_t> words) {
    std::ranges::fill(words, 0u);
    int texel = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x, ++texel) {
            const auto bit = static_cast<std::uint32_t>(rows[static_cast<std::size_t>(y)] >> x & 1u);
            words[static_cast<std::size_t>(texel / 32)] |= bit << (texel % 32);
        }
    }
}

}  // namespace sightlines::visibility_field
