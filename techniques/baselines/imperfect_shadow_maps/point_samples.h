// The scene's surface as points (Ritschel 2008): what the imperfect shadow maps are drawn from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/scene.h"

namespace sightlines::baselines {

/// Sets of points, each of which samples the whole surface; a light draws one set, its neighbours others.
struct PointSamples {
    std::vector<float> position[3];  ///< [sets][points padded to 16], m
    std::size_t points = 0;          ///< of a set
    std::size_t sets = 0;
    double area_m2 = 0.0;  ///< of all triangles

    std::size_t padded() const { return (points + 15) / 16 * 16; }
    /// The side of the square that one point of a set stands for, m.
    float side_m() const;
};

/// `points` points in each of `sets` sets, as many on a triangle as it has of the area. Within a set one point lies in
/// each equal share of the area, in the order of triangles. Without surface there are no points.
PointSamples sample_points(const Scene& scene, std::size_t points, std::size_t sets, std::uint64_t seed, int threads,
                           Progress& progress);

}  // namespace sightlines::baselines
