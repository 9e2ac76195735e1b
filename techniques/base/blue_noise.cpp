#include "techniques/base/blue_noise.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "techniques/base/random.h"

namespace sightlines {
namespace {

constexpr double spread = 1.5;          // standard deviation of the Gaussian that says what is near, pixels (Ulichney)
constexpr double first_share = 0.1;     // of the pixels, in the pattern that both passes start from
constexpr float tie_breaker = 1.0e-6f;  // so that equal voids are not filled row by row

/// Some pixels of a tile, and for each pixel how crowded its neighbourhood is.
struct Pattern {
    int side;
    std::vector<float> nearness;  ///< [side * side], of two pixels that differ by (x, y), the tile repeating
    std::vector<bool> holds;
    std::vector<float> crowding;

    Pattern(int side_, std::uint64_t seed)
        : side(side_), nearness(pixels()), holds(pixels(), false), crowding(pixels()) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const double dx = std::min(x, side - x), dy = std::min(y, side - y);
                nearness[place(x, y)] = static_cast<float>(std::exp(-(dx * dx + dy * dy) / (2.0 * spread * spread)));
            }
        }
        for (std::size_t p = 0; p < pixels(); ++p)
            crowding[p] = tie_breaker * random_unit(seed, 1, static_cast<std::uint32_t>(p));
    }
    std::size_t pixels() const { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); }
    std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
    }
    void set(std::size_t pixel, bool on) {
        holds[pixel] = on;
        const float sign = on ? 1.0f : -1.0f;
        const int px = static_cast<int>(pixel) % side, py = static_cast<int>(pixel) / side;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                crowding[place(x, y)] += sign * nearness[place((x - px + side) % side, (y - py + side) % side)];
    }
    std::size_t tightest_cluster() const { return extreme(true, 1.0f); }
    std::size_t largest_void() const { return extreme(false, -1.0f); }

    /// The pixel with `on` of the greatest sign * crowding.
    std::size_t extreme(bool on, float sign) const {
        std::size_t best = pixels();
        for (std::size_t p = 0; p < pixels(); ++p)
            if (holds[p] == on && (best == pixels() || sign * crowding[p] > sign * crowding[best])) best = p;
        return best;
    }
};

/// A tenth of the pixels, at random, then moved from clusters to voids until that changes nothing.
Pattern first_pattern(int side, std::uint64_t seed) {
    Pattern pattern(side, seed);
    const auto count = static_cast<std::size_t>(std::ceil(first_share * static_cast<double>(pattern.pixels())));
    for (std::uint32_t draw = 0, set = 0; set < count; ++draw) {
        const std::size_t pixel = random_u32(seed, 0, draw) % pattern.pixels();
        if (pattern.holds[pixel]) continue;
        pattern.set(pixel, true);
        ++set;
    }
    for (std::size_t move = 0; move < pattern.pixels(); ++move) {
        const std::size_t from = pattern.tightest_cluster();
        pattern.set(from, false);
        const std::size_t to = pattern.largest_void();
        pattern.set(to, true);
        if (from == to) break;
    }
    return pattern;
}

}  // namespace

BlueNoise void_and_cluster(int side, std::uint64_t seed) {
    assert(side >= 4);
    const Pattern first = first_pattern(side, seed);
    BlueNoise noise{side, std::vector<std::uint32_t>(first.pixels())};
    const auto count = static_cast<std::uint32_t>(std::ranges::count(first.holds, true));
    Pattern taken = first;
    for (std::uint32_t rank = count; rank-- > 0;) {
        const std::size_t pixel = taken.tightest_cluster();
        taken.set(pixel, false);
        noise.rank[pixel] = rank;
    }
    Pattern filled = first;
    for (std::uint32_t rank = count; rank < filled.pixels(); ++rank) {
        const std::size_t pixel = filled.largest_void();
        filled.set(pixel, true);
        noise.rank[pixel] = rank;
    }
    return noise;
}

}  // namespace sightlines
