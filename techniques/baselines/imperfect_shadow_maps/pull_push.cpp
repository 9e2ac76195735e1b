#include "techniques/baselines/imperfect_shadow_maps/pull_push.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace sightlines::baselines {
namespace {

struct Level {
    float* distances;
    int side, pitch;

    float& at(int x, int y) const { return distances[static_cast<std::ptrdiff_t>(y) * pitch + x]; }
};

/// The weighted mean of those that are within the tolerance of the nearest; a hole where all are holes.
float mean_of_near(const std::array<float, 4>& values, const std::array<float, 4>& weights, float tolerance) {
    const float nearest = std::min(std::min(values[0], values[1]), std::min(values[2], values[3]));
    if (nearest == hole) return hole;
    const float farthest = nearest * (1.0f + tolerance);
    float sum = 0.0f, weight = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
        const bool counts = values[k] <= farthest;
        sum += counts ? weights[k] * values[k] : 0.0f;
        weight += counts ? weights[k] : 0.0f;
    }
    return sum / weight;
}

void pull(const Level& fine, const Level& coarse, float tolerance) {
    const int last = fine.side - 1;
    for (int y = 0; y < coarse.side; ++y) {
        const int y0 = 2 * y, y1 = std::min(2 * y + 1, last);
        for (int x = 0; x < coarse.side; ++x) {
            const int x0 = 2 * x, x1 = std::min(2 * x + 1, last);
            coarse.at(x, y) = mean_of_near({fine.at(x0, y0), fine.at(x1, y0), fine.at(x0, y1), fine.at(x1, y1)},
                                           {1.0f, 1.0f, 1.0f, 1.0f}, tolerance);
        }
    }
}

void push(const Level& coarse, const Level& fine, float tolerance) {
    const int last = coarse.side - 1;
    for (int y = 0; y < fine.side; ++y) {
        const int y0 = y / 2, y1 = std::clamp(y % 2 == 0 ? y0 - 1 : y0 + 1, 0, last);
        for (int x = 0; x < fine.side; ++x) {
            if (fine.at(x, y) != hole) continue;
            const int x0 = x / 2, x1 = std::clamp(x % 2 == 0 ? x0 - 1 : x0 + 1, 0, last);
            fine.at(x, y) = mean_of_near({coarse.at(x0, y0), coarse.at(x1, y0), coarse.at(x0, y1), coarse.at(x1, y1)},
                                         {9.0f, 3.0f, 3.0f, 1.0f}, tolerance);
        }
    }
}

}  // namespace

void fill_holes(std::span<float> distances, int resolution, int pitch, int levels, float tolerance,
                PullPushScratch& scratch) {
    std::vector<Level> copies{{distances.data(), resolution, pitch}};
    scratch.levels.resize(std::max(scratch.levels.size(), static_cast<std::size_t>(levels)));
    for (int level = 0; level < levels && copies.back().side > 1; ++level) {
        const int side = (copies.back().side + 1) / 2;
        std::vector<float>& numbers = scratch.levels[static_cast<std::size_t>(level)];
        numbers.resize(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
        copies.push_back({numbers.data(), side, side});
        pull(copies[copies.size() - 2], copies.back(), tolerance * static_cast<float>(1 << level));
    }
    for (std::size_t level = copies.size() - 1; level > 0; --level)
        push(copies[level], copies[level - 1], tolerance * static_cast<float>(1 << (level - 1)));
}

}  // namespace sightlines::baselines
