#include "techniques/base/parallel.h"

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

TEST(ParallelFor, VisitsEachIndexOnceWithAnyNumberOfThreads) {
    for (const int threads : {0, 1, 2, 7}) {
        std::vector<std::atomic<int>> visits(1000);
        parallel_for(1000, threads, [&](std::int64_t i) { ++visits[static_cast<std::size_t>(i)]; });
        for (const auto& count : visits) ASSERT_EQ(count, 1);
    }
}

TEST(ParallelFor, DoesNothingForNothing) {
    for (const std::int64_t count : {std::int64_t{0}, std::int64_t{-5}})
        parallel_for(count, 2, [](std::int64_t) { FAIL(); });
}

TEST(ParallelFor, UsesNoMoreThreadsThanAllowed) {
    for (const int threads : {1, 2}) {
        std::mutex lock;
        std::set<std::thread::id> seen;
        std::atomic<int> at_once = 0, most = 0;
        parallel_for(64, threads, [&](std::int64_t) {
            const int now = ++at_once;
            int before = most;
            while (before < now && !most.compare_exchange_weak(before, now)) {}
            {
                const std::lock_guard guard(lock);
                seen.insert(std::this_thread::get_id());
            }
            std::this_thread::yield();
            --at_once;
        });
        EXPECT_LE(most, threads);
        if (threads == 1) {
            EXPECT_EQ(seen.size(), 1u);
        }
    }
}

TEST(ParallelFor, RethrowsWhatABodyThrowsAndStopsTheRest) {
    std::atomic<int> visited = 0;
    const auto work = [&](std::int64_t i) {
        ++visited;
        if (i == 3) throw Cancelled();
        std::this_thread::yield();
    };
    EXPECT_THROW(parallel_for(1000000, 2, work), Cancelled);
    EXPECT_LT(visited, 1000000);
    EXPECT_THROW(parallel_for(10, 1, [](std::int64_t) { throw std::runtime_error("no"); }), std::runtime_error);
}

TEST(ParallelFor, MayBeUsedInsideItself) {
    std::atomic<int> visited = 0;
    parallel_for(8, 2, [&](std::int64_t) { parallel_for(8, 2, [&](std::int64_t) { ++visited; }); });
    EXPECT_EQ(visited, 64);
}

TEST(ThreadCount, IsAsGivenButNeverMoreThanTheMachines) {
    const int processors = thread_count(0);
    EXPECT_GE(processors, 1);
    for (int threads = 1; threads <= processors; ++threads) EXPECT_EQ(thread_count(threads), threads);
    EXPECT_EQ(thread_count(processors + 1), processors);
    EXPECT_EQ(thread_count(100000), processors);
}

}  // namespace
}  // namespace sightlines
