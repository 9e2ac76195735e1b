// Threads, by oneTBB. Results must not depend on how many there are: give each index its own output.
#pragma once

#include <cstdint>
#include <functional>

namespace sightlines {

/// Calls body(i) for i in [0, count), on at most `threads` threads (0: as many as the machine has), largest grain 1.
/// An exception (Cancelled too) from a body stops the rest and is rethrown here.
void parallel_for(std::int64_t count, int threads, const std::function<void(std::int64_t)>& body);

/// How many threads such work runs on: `threads`, or the machine's number of processors where that is less or `threads`
/// is 0. More would gain nothing, and TBB would complain on standard error.
int thread_count(int threads);

}  // namespace sightlines
