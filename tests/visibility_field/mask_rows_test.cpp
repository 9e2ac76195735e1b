// Masks while they are made: dilation by what it is for, and packing.
#include "techniques/visibility_field/mask_rows.h"

#include <gtest/gtest.h>

#include "shaders/octahedral.h"
#include "techniques/base/random.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

bool is_set(const MaskRows& rows, kernel::OctahedralTexel texel) {
    return (rows[static_cast<std::size_t>(texel.row)] >> texel.column & 1u) != 0;
}

MaskRows single(kernel::OctahedralTexel texel) {
    MaskRows rows{};
    rows[static_cast<std::size_t>(texel.row)] = std::uint64_t{1} << texel.column;
    return rows;
}

kernel::OctahedralTexel texel_of(vec3 direction, int size) {
    return kernel::octahedral_texel(kernel::octahedral_place(direction), size);
}

TEST(MaskRows, DilationReachesWhateverTouchesATexelOnTheSphere) {
    for (const int size : {8, 18, 63, 64}) {
        int crossings = 0;
        for (std::uint32_t k = 0; k < 20'000; ++k) {
            const vec3 direction = sphere_direction(random_unit(31, k, 0), random_unit(31, k, 1));
            const vec3 aside = sphere_direction(random_unit(32, k, 0), random_unit(32, k, 1));
            const kernel::OctahedralTexel from = texel_of(direction, size);
            const kernel::OctahedralTexel to =
                texel_of(glm::normalize(direction + 0.2f / static_cast<float>(size) * aside), size);
            ASSERT_TRUE(is_set(dilated(single(from), size), to))
                << size << ": " << from.column << " " << from.row << " to " << to.column << " " << to.row;
            crossings += std::abs(from.column - to.column) > 1 || std::abs(from.row - to.row) > 1;
        }
        EXPECT_GT(crossings, 10) << size;  // across the square's edges
    }
}

TEST(MaskRows, DilationTakesTheEightNeighboursAndNoMore) {
    for (const int size : {8, 18, 64}) {
        EXPECT_EQ(texels_set(dilated(single({3, 4}), size)), 9);
        for (int row = 0; row < size; ++row) {
            for (int column = 0; column < size; ++column) {
                const int set = texels_set(dilated(single({column, row}), size));
                ASSERT_TRUE(set >= 6 && set <= 9) << size << ": " << column << " " << row << ": " << set;
            }
        }
    }
}

TEST(MaskRows, DilatingAMergedMaskIsMergingDilatedOnes) {
    for (const int size : {8, 18, 64}) {
        MaskRows merged{}, dilated_each{};
        for (std::uint32_t k = 0; k < 30; ++k) {
            const auto place = [&](std::uint32_t axis) {
                return static_cast<int>(random_u32(33, k, axis) % static_cast<std::uint32_t>(size));
            };
            const MaskRows one = single({place(0), place(1)});
            const MaskRows grown = dilated(one, size);
            for (std::size_t y = 0; y < merged.size(); ++y) {
                merged[y] |= one[y];
                dilated_each[y] |= grown[y];
            }
        }
        EXPECT_EQ(dilated(merged, size), dilated_each);
    }
}

TEST(MaskRows, DilatingPartsByAWholeTexelIsDilatingTexels) {
    constexpr int size = 18, steps = 3;
    for (std::uint32_t k = 0; k < 200; ++k) {
        MaskRows parts{};
        for (std::uint32_t set = 0; set < 1 + k % 5; ++set)
            parts[random_u32(34, k, 2 * set) % (size * steps)] |= std::uint64_t{1}
                                                                  << random_u32(34, k, 2 * set + 1) % (size * steps);
        MaskRows grown = parts;
        for (int step = 0; step < steps; ++step) grown = dilated(grown, size * steps);
        ASSERT_EQ(reduced(grown, size, steps), dilated(reduced(parts, size, steps), size));
    }
}

TEST(MaskRows, ATexelIsSetWhereAnyOfItsPartsIs) {
    MaskRows parts{};
    parts[0] = 0b100;
    parts[5] = std::uint64_t{1} << 53;
    const MaskRows texels = reduced(parts, 18, 3);
    EXPECT_EQ(texels[0], 1u);
    EXPECT_EQ(texels[1], std::uint64_t{1} << 17);
    EXPECT_EQ(texels_set(texels), 2);
}

TEST(MaskRows, ArePackedRowAfterRow) {
    MaskRows rows{};
    rows[0] = 1;
    rows[1] = std::uint64_t{1} << 17;
    rows[17] = std::uint64_t{1} << 17;
    std::vector<std::uint32_t> words(11, 0xffffffffu);
    pack(rows, 18, words);
    for (int texel = 0; texel < 352; ++texel) {
        const bool set = (words[static_cast<std::size_t>(texel / 32)] >> (texel % 32) & 1u) != 0;
        EXPECT_EQ(set, texel == 0 || texel == 35 || texel == 323) << texel;
    }
}

}  // namespace
}  // namespace sightlines::visibility_field
