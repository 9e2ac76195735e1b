#include "techniques/base/parallel.h"

#include <algorithm>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace sightlines {

int thread_count(int threads) {
    const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return threads > 0 ? std::min(threads, processors) : processors;
}

void parallel_for(std::int64_t count, int threads, const std::function<void(std::int64_t)>& body) {
    tbb::task_arena arena(thread_count(threads));
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::int64_t>(0, count, 1),
            [&](const tbb::blocked_range<std::int64_t>& range) {
                for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
            },
            tbb::simple_partitioner{});
    });
}

}  // namespace sightlines
