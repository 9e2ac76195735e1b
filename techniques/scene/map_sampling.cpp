#include "techniques/scene/map_sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "shaders/map_light.h"
#include "techniques/scene/environment.h"
#include "techniques/scene/harmonics.h"

namespace sightlines {
namespace {

constexpr float even_share = 0.01f;
constexpr ImageSize most{1024, 512};

/// The sum of a row of luminances over the texels under each column of the distribution, and one to either side.
void add_row(std::span<const vec3> row, int columns, std::vector<double>& luminance, std::vector<double>& to) {
    const int width = static_cast<int>(row.size());
    // The ends meet.
    for (int x = -1; x <= width; ++x)
        luminance[static_cast<std::size_t>(x + 1)] =
            glm::dot(row[static_cast<std::size_t>((x + width) % width)], vec3(0.2126f, 0.7152f, 0.0722f));
    for (int x = 0; x < columns; ++x) {
        const int left = x * width / columns - 1, right = (x + 1) * width / columns;
        for (int column = left; column <= right; ++column)
            to[static_cast<std::size_t>(x)] += luminance[static_cast<std::size_t>(column + 1)];
    }
}

/// The mean luminance of the map's texels under each texel of the distribution, and of those around it, between which
/// the map is interpolated.
std::vector<double> brightness(const ImageRgb& map, ImageSize size) {
    const auto width = static_cast<std::size_t>(map.size.width), columns = static_cast<std::size_t>(size.width);
    std::vector<double> all, sums(columns), luminance(width + 2);
    all.reserve(size.pixels());
    for (int y = 0; y < size.height; ++y) {
        const int top = y * map.size.height / size.height - 1, bottom = (y + 1) * map.size.height / size.height;
        std::ranges::fill(sums, 0.0);
        for (int row = top; row <= bottom; ++row) {
            const auto inside = static_cast<std::size_t>(std::clamp(row, 0, map.size.height - 1));
            add_row(std::span(map.pixels).subspan(inside * width, width), size.width, luminance, sums);
        }
        for (int x = 0; x < size.width; ++x) {
            const int across = (x + 1) * map.size.width / size.width - x * map.size.width / size.width + 2;
            all.push_back(sums[static_cast<std::size_t>(x)] / (across * (bottom - top + 1)));
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

scalar_kernel::MapDraws draws_of(const MapDistribution& distribution) {
    const MapTables& tables = *distribution.tables;
    return {distribution.shape,
            {tables.rows.data()},
            {tables.heights.data()},
            {tables.columns.data()},
            {tables.density.data()}};
}

}  // namespace

MapDistribution make_distribution(const ImageRgb& map) {
    MapTables made;
    made.size = {std::min(map.size.width, most.width), std::min(map.size.height, most.height)};
    made.density.reserve(made.size.pixels());
    made.columns.reserve(made.size.pixels() + static_cast<std::size_t>(made.size.height));
    for (int row = 0; row <= made.size.height; ++row)
        made.heights.push_back(static_cast<float>(std::cos(std::numbers::pi * row / made.size.height)));
    std::vector<double> weights = brightness(map, made.size);
    const auto width = static_cast<std::size_t>(made.size.width);
    std::vector<double> rows, solid_angle;
    for (int row = 0; row < made.size.height; ++row) solid_angle.push_back(texel_solid_angle(made.size, row));
    double sum = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] *= solid_angle[k / width];
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double even = solid_angle[k / width] / (4.0 * std::numbers::pi);
        weights[k] = sum > 0.0 ? (1.0 - even_share) * weights[k] / sum + even_share * even : even;
        made.density.push_back(static_cast<float>(weights[k] / solid_angle[k / width]));
    }
    for (std::size_t row = 0; row < static_cast<std::size_t>(made.size.height); ++row)
        rows.push_back(accumulate(std::span(weights).subspan(row * width, width), made.columns));
    accumulate(rows, made.rows);
    const MapShape shape = map_shape(made.size, 0.0f);
    return {std::make_shared<const MapTables>(std::move(made)), shape};
}

MapDistribution turned(const MapDistribution& distribution, float turn_deg) {
    return {distribution.tables, map_shape(distribution.tables->size, turn_deg)};
}

MapShape map_shape(ImageSize size, float turn_deg) {
    const mat3 map_from_world = turn_about_up(-turn_deg);
    return {size.width,
            size.height,
            static_cast<int>(std::bit_floor(static_cast<unsigned>(size.width))),
            static_cast<int>(std::bit_floor(static_cast<unsigned>(size.height))),
            map_from_world[0][0],
            map_from_world[0][2],
            0.0f};
}

vec3 drawn_direction(const MapDistribution& distribution, vec2 numbers) {
    return scalar_kernel::direction_by_map(draws_of(distribution), numbers.x, numbers.y);
}

float drawn_density(const MapDistribution& distribution, vec3 direction) {
    return scalar_kernel::density_by_map(draws_of(distribution), direction);
}

}  // namespace sightlines
