// What the benches report of repeated measurements.
#pragma once

#include <algorithm>
#include <vector>

namespace sightlines {

/// The mean of the middle two of an even number of values; there must be at least one.
inline double median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace sightlines
