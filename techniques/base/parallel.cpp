#include "techniques/base/parallel.h"

#include <algorithm>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
// A function object that the library hands to its workers: reading it comes before the sanitizer can be told so.
#define HANDED_OVER __attribute__((no_sanitize("thread")))
#else
#define HANDED_OVER
#endif

namespace sightlines {
namespace {

/// Tells the thread sanitizer what the library guarantees, which it cannot see because the library is not built with
/// it: all bodies run after the fork and before the join.
struct ForkJoin {
#ifdef __SANITIZE_THREAD__
    char begin = 0, end = 0;
    ForkJoin() { __tsan_release(&begin); }
    ~ForkJoin() { __tsan_acquire(&end); }
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;
#endif
};

/// One body of it.
struct Branch {
#ifdef __SANITIZE_THREAD__
    ForkJoin& whole;
    explicit Branch(ForkJoin& whole_) : whole(whole_) { __tsan_acquire(&whole.begin); }
    ~Branch() { __tsan_release(&whole.end); }
    Branch(const Branch&) = delete;
    Branch& operator=(const Branch&) = delete;
#else
    explicit Branch(ForkJoin&) {}
#endif
};

}  // namespace

int thread_count(int threads) {
    const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return threads > 0 ? std::min(threads, processors) : processors;
}

void parallel_for(std::int64_t count, int threads, const std::function<void(std::int64_t)>& body) {
    [[maybe_unused]] ForkJoin whole;
    tbb::task_arena arena(thread_count(threads));
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::int64_t>(0, count, 1),
            [&](const tbb::blocked_range<std::int64_t>& range) HANDED_OVER {
                [[maybe_unused]] const Branch branch(whole);
                for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
            },
            tbb::simple_partitioner{});
    });
}

}  // namespace sightlines
