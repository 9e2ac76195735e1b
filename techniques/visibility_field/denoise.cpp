#include "techniques/visibility_field/denoise.h"

#include <array>
#include <cmath>

#include "techniques/base/parallel.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::array<float, 5> spline{1.0f / 16.0f, 1.0f / 4.0f, 3.0f / 8.0f, 1.0f / 4.0f, 1.0f / 16.0f};
constexpr float normals_power = 32.0f;
constexpr float largest_slope = 0.1f;  ///< of the way to a neighbour against the pixel's plane
constexpr float largest_difference =
    1.0f;  ///< in brightness, of the brighter one's; halved in each pass, as in the paper

float luminance(vec3 colour) { return glm::dot(colour, vec3(0.2126f, 0.7152f, 0.0722f)); }

float squared(float x) { return x * x; }

/// How much a neighbour counts, in [0, 1].
float likeness(const SurfaceBuffer& surfaces, const ImageRgb& from, std::size_t pixel, std::size_t other,
               float difference) {
    if (pixel == other) return 1.0f;
    const float along = glm::dot(surfaces.shading_normal[pixel], surfaces.shading_normal[other]);
    if (along <= 0.0f) return 0.0f;
    const vec3 way = surfaces.position[other] - surfaces.position[pixel];
    const float length = glm::length(way);
    const float slope = length > 0.0f ? std::fabs(glm::dot(surfaces.normal[pixel], way)) / length : 0.0f;
    const float here = luminance(from.pixels[pixel]), there = luminance(from.pixels[other]);
    const float brighter = std::max({here, there, 1.0e-6f});
    return std::pow(along, normals_power) *
           std::exp(-squared(slope / largest_slope) - squared((here - there) / (brighter * difference)));
}

vec3 smoothed(const SurfaceBuffer& surfaces, const ImageRgb& from, int x, int y, int step, float difference) {
    const ImageSize size = surfaces.size;
    const auto index = [&](int column, int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(column);
    };
    vec3 sum(0.0f);
    float weights = 0.0f;
    for (int v = 0; v < 5; ++v) {
        for (int u = 0; u < 5; ++u) {
            const int column = x + (u - 2) * step, row = y + (v - 2) * step;
            if (column < 0 || row < 0 || column >= size.width || row >= size.height) continue;
            const std::size_t other = index(column, row);
            if (surfaces.triangle[other] == no_triangle) continue;
            const float weight = spline[static_cast<std::size_t>(u)] * spline[static_cast<std::size_t>(v)] *
                                 likeness(surfaces, from, index(x, y), other, difference);
            sum += weight * from.pixels[other];
            weights += weight;
        }
    }
    return sum / weights;
}

}  // namespace

void denoise(const SurfaceBuffer& surfaces, int passes, int threads, ImageRgb& irradiance) {
    const ImageSize size = surfaces.size;
    for (int pass = 0; pass < passes; ++pass) {
        const ImageRgb from = irradiance;
        const int step = 1 << pass;
        const float difference = largest_difference / static_cast<float>(step);
        parallel_for(size.height, threads, [&](std::int64_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < size.width; ++x) {
                const auto pixel =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
                if (surfaces.triangle[pixel] != no_triangle)
                    irradiance.pixels[pixel] = smoothed(surfaces, from, x, y, step, difference);
            }
        });
    }
}

}  // namespace sightlines::visibility_field
