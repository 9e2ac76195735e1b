// A tile of blue noise: a threshold for each pixel, neighbours far apart in value, that repeats without a seam.
#pragma once

#include <cstdint>
#include <vector>

namespace sightlines {

/// `rank[y * side + x]`: each of 0 .. side * side - 1 once.
struct BlueNoise {
    int side = 0;
    std::vector<std::uint32_t> rank;

    /// In (0, 1), of the pixel (x, y) of a picture covered with tiles. x and y are at least 0.
    float at(int x, int y) const {
        const auto place = static_cast<std::size_t>((y % side) * side + x % side);
        return (static_cast<float>(rank[place]) + 0.5f) / static_cast<float>(side * side);
    }
};

/// Void and cluster (Ulichney 1993). A pure function of its arguments; `side` is at least 4.
BlueNoise void_and_cluster(int side, std::uint64_t seed);

}  // namespace sightlines
