#include "techniques/base/parallel_sort.h"

#include <numeric>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/base/random.h"

namespace sightlines {
namespace {

TEST(ParallelSort, PutsAnyNumberOfValuesInOrderOnAnyNumberOfThreads) {
    for (const std::size_t count : {0u, 1u, 2u, 3u, 1000u, 1023u})
        for (const int threads : {0, 1, 2, 3, 8}) {
            std::vector<std::uint64_t> values(count);
            for (std::uint32_t k = 0; k < count; ++k) values[k] = std::uint64_t{random_u32(3, k, 0)} << 32u | k;
            std::vector<std::uint64_t> right = values;
            std::ranges::sort(right, std::greater<>());
            sort_in_parallel(values, threads, std::greater<>());
            ASSERT_EQ(values, right) << count << " values, " << threads << " threads";
        }
}

TEST(ParallelSort, RethrowsWhatTheOrderThrows) {
    std::vector<int> values(1000);
    std::iota(values.begin(), values.end(), 0);
    EXPECT_THROW(sort_in_parallel(values, 2, [](int, int) -> bool { throw Cancelled(); }), Cancelled);
}

}  // namespace
}  // namespace sightlines
