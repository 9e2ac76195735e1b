#include "techniques/visibility_field/map_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace sightlines::visibility_field {
namespace {

constexpr float even_share = 0.01f;
constexpr ImageSize most{1024, 512};

/// The mean luminance of the map's texels under each texel of the distribution, and of those around it, between which
/// the map is interpolated.
std::vector<double> brightness(const ImageRgb& map, ImageSize size) {
    std::vector<double> all(size.pixels());
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const int top = y * map.size.height / size.height - 1, left = x * map.size.width / size.width - 1;
            const int bottom = (y + 1) * map.size.height / size.height, right = (x + 1) * map.size.width / size.width;
            double sum = 0.0;
            for (int row = top; row <= bottom; ++row)
                for (int column = left; column <= right; ++column)
                    sum += glm::dot(
                        map.at((column + map.size.width) % map.size.width, std::clamp(row, 0, map.size.height - 1)),
                        vec3(0.2126f, 0.7152f, 0.0722f));
            all[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)] =
                sum / ((bottom - top + 1) * (right - left + 1));
        }
    }
    return all;
}

/// Appends running sums of the weights, as shares of their sum; returns the sum.
double accumulate(std::span<const double> weights, std::vector<float>& to) {
    double sum = 0.0, so_far = 0.0;
    for (const double weight : weights) sum += weight;
    to.push_back(0.0f);
    for (const double weight : weights) {
        so_far += weight;
        to.push_back(static_cast<float>(so_far / sum));
    }
    to.back() = 1.0f;
    return sum;
}

/// The interval of the cumulative sums that holds the number, and where in it.
std::size_t find_interval(std::span<const float> sums, float number, float& within) {
    const auto above = std::ranges::upper_bound(sums.first(sums.size() - 1), number);
    const auto index = static_cast<std::size_t>(above - sums.begin()) - 1;
    within = std::clamp((number - sums[index]) / std::max(sums[index + 1] - sums[index], 1.0e-20f), 0.0f, 1.0f);
    return index;
}

}  // namespace

MapDistribution make_distribution(const EnvironmentLight& light) {
    const ImageRgb& map = light.map->radiance;
    MapDistribution made;
    made.size = {std::min(map.size.width, most.width), std::min(map.size.height, most.height)};
    made.world_from_map = turn_about_up(light.turn_deg);
    made.map_from_world = turn_about_up(-light.turn_deg);
    std::vector<double> weights = brightness(map, made.size);
    const auto width = static_cast<std::size_t>(made.size.width);
    double sum = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k)
        sum += weights[k] *= texel_solid_angle(made.size, static_cast<int>(k / width));
    std::vector<double> rows;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double solid_angle = texel_solid_angle(made.size, static_cast<int>(k / width));
        const double even = solid_angle / (4.0 * std::numbers::pi);
        weights[k] = sum > 0.0 ? (1.0 - even_share) * weights[k] / sum + even_share * even : even;
        made.density.push_back(static_cast<float>(weights[k] / solid_angle));
    }
    for (std::size_t row = 0; row < static_cast<std::size_t>(made.size.height); ++row)
        rows.push_back(accumulate(std::span(weights).subspan(row * width, width), made.columns));
    accumulate(rows, made.rows);
    return made;
}

vec3 drawn_direction(const MapDistribution& distribution, vec2 numbers) {
    const double pi = std::numbers::pi;
    const auto width = static_cast<std::size_t>(distribution.size.width);
    float down = 0.0f, across = 0.0f;
    const std::size_t row = find_interval(distribution.rows, numbers.y, down);
    const std::size_t column =
        find_interval(std::span(distribution.columns).subspan(row * (width + 1), width + 1), numbers.x, across);
    // Even by solid angle within the texel: even in height and in azimuth.
    const double upper = std::cos(pi * static_cast<double>(row) / distribution.size.height);
    const double lower = std::cos(pi * static_cast<double>(row + 1) / distribution.size.height);
    const double height = upper + (lower - upper) * down;
    const double ring = std::sqrt(std::max(0.0, 1.0 - height * height));
    const double azimuth = 2.0 * pi * (static_cast<double>(column) + across) / static_cast<double>(width) - pi;
    return distribution.world_from_map * vec3(dvec3(ring * std::sin(azimuth), height, -ring * std::cos(azimuth)));
}

float drawn_density(const MapDistribution& distribution, vec3 direction) {
    const vec2 place = equirectangular_pixel(distribution.size, distribution.map_from_world * direction);
    const int column = std::clamp(static_cast<int>(place.x), 0, distribution.size.width - 1);
    const int row = std::clamp(static_cast<int>(place.y), 0, distribution.size.height - 1);
    return distribution.density[static_cast<std::size_t>(row) * static_cast<std::size_t>(distribution.size.width) +
                                static_cast<std::size_t>(column)];
}

}  // namespace sightlines::visibility_field
