#include "techniques/base/huge_buffer.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

TEST(HugeBuffer, IsZeroedAlignedAndAsLargeAsAsked) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{1000}, std::size_t{3} << 20u}) {
        const HugeBuffer buffer = allocate_huge(count);
        ASSERT_EQ(buffer.words.size(), count);
        EXPECT_EQ(buffer.bytes(), 4 * count);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.words.data()) % (2u << 20u), 0u);
        EXPECT_TRUE(std::ranges::all_of(buffer.words, [](std::uint32_t word) { return word == 0; }));
        buffer.words.front() = 1;
        buffer.words.back() = 2;
    }
}

TEST(HugeBuffer, StaysAliveAsLongAsACopyDoes) {
    HugeBuffer kept;
    {
        const HugeBuffer made = allocate_huge(100);
        made.words[99] = 7;
        kept = made;
    }
    EXPECT_EQ(kept.words[99], 7u);
}

TEST(HugeBuffer, IsMadeOfOneThatIsSpareWhereThatIsLargeEnough) {
    HugeBuffer reused;
    {
        const HugeBuffer spare = allocate_huge(100);
        spare.words[98] = 7;
        reused = reuse_huge(spare, 99);
        EXPECT_NE(reuse_huge(spare, 101).words.data(), spare.words.data());
    }
    ASSERT_EQ(reused.words.size(), 99u);
    EXPECT_EQ(reused.words[98], 7u);
}

TEST(HugeBuffer, ReportsThatThereIsNotThatMuchMemory) {
    EXPECT_THROW(allocate_huge(std::size_t{1} << 50u), EnvironmentError);
}

TEST(Memory, IsMeasuredInPlausibleBytes) {
    EXPECT_GT(available_memory_bytes(), 1u << 20u);
    EXPECT_GT(peak_memory_bytes(), 1u << 20u);
    EXPECT_LT(peak_memory_bytes(), std::uint64_t{1} << 44u);
}

}  // namespace
}  // namespace sightlines
