// Sorting on several threads.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "techniques/base/parallel.h"

namespace sightlines {

/// Sorts by `before`, a strict order in which no two values are equal, so that the result is the same for any number of
/// threads. An exception from `before` is rethrown, and leaves the values in any order.
template <class Value, class Before>
void sort_in_parallel(std::vector<Value>& values, int threads, const Before& before) {
    const auto parts = std::bit_ceil(static_cast<std::size_t>(thread_count(threads)));
    const auto start_of = [&](std::size_t part) {
        return values.begin() + static_cast<std::ptrdiff_t>(values.size() * part / parts);
    };
    parallel_for(static_cast<std::int64_t>(parts), threads, [&](std::int64_t index) {
        const auto part = static_cast<std::size_t>(index);
        std::sort(start_of(part), start_of(part + 1), before);
    });
    for (std::size_t sorted = 1; sorted < parts; sorted *= 2)
        parallel_for(static_cast<std::int64_t>(parts / (2 * sorted)), threads, [&](std::int64_t index) {
            const std::size_t part = 2 * sorted * static_cast<std::size_t>(index);
            std::inplace_merge(start_of(part), start_of(part + sorted), start_of(part + 2 * sorted), before);
        });
}

}  // namespace sightlines
