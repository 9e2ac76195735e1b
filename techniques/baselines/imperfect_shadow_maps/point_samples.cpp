#include "techniques/baselines/imperfect_shadow_maps/point_samples.h"

#include <algorithm>
#include <cmath>

#include "techniques/base/parallel.h"
#include "techniques/base/random.h"

namespace sightlines::baselines {
namespace {

/// Uniform on the triangle from two uniform numbers.
vec3 point_on_triangle(const Scene& scene, std::size_t triangle, float u, float v) {
    const uvec3 corners = scene.triangles[triangle];
    const float root = std::sqrt(u);
    return (1.0f - root) * scene.positions[corners.x] + root * (1.0f - v) * scene.positions[corners.y] +
           root * v * scene.positions[corners.z];
}

std::vector<double> summed_areas(const Scene& scene) {
    std::vector<double> sums(scene.triangles.size());
    double sum = 0.0;
    for (std::size_t t = 0; t < sums.size(); ++t) {
        const uvec3 corners = scene.triangles[t];
        const dvec3 a(scene.positions[corners.x]), b(scene.positions[corners.y]), c(scene.positions[corners.z]);
        sum += 0.5 * glm::length(glm::cross(b - a, c - a));
        sums[t] = sum;
    }
    return sums;
}

}  // namespace

float PointSamples::side_m() const {
    return points == 0 ? 0.0f : static_cast<float>(std::sqrt(area_m2 / static_cast<double>(points)));
}

PointSamples sample_points(const Scene& scene, std::size_t points, std::size_t sets, std::uint64_t seed, int threads,
                           Progress& progress) {
    const std::vector<double> sums = summed_areas(scene);
    PointSamples samples;
    if (sums.empty() || !(sums.back() > 0.0)) return samples;
    samples.points = points;
    samples.sets = sets;
    samples.area_m2 = sums.back();
    for (auto& axis : samples.position) axis.resize(sets * samples.padded());
    progress.begin("sampling points", static_cast<std::int64_t>(sets));
    parallel_for(static_cast<std::int64_t>(sets), threads, [&](std::int64_t set) {
        const auto stream = static_cast<std::uint32_t>(set);
        std::size_t triangle = 0;
        for (std::size_t k = 0; k < samples.padded(); ++k) {
            const auto counter = static_cast<std::uint32_t>(3 * std::min(k, points - 1));
            const double share = (static_cast<double>(std::min(k, points - 1)) +
                                  static_cast<double>(random_unit(seed, stream, counter))) /
                                 static_cast<double>(points);
            while (triangle + 1 < sums.size() && sums[triangle] <= share * samples.area_m2) ++triangle;
            const vec3 point = point_on_triangle(scene, triangle, random_unit(seed, stream, counter + 1),
                                                 random_unit(seed, stream, counter + 2));
            const std::size_t at = static_cast<std::size_t>(set) * samples.padded() + k;
            for (int axis = 0; axis < 3; ++axis) samples.position[axis][at] = point[axis];
        }
        progress.advance();
    });
    return samples;
}

}  // namespace sightlines::baselines
