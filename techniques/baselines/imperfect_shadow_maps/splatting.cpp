#include <algorithm>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/shadow_map.h"
#include "techniques/baselines/imperfect_shadow_maps/splatting.h"

namespace sightlines::baselines {
namespace {

namespace wide = wide_kernel;
using wide::Real;
using wide::splat;

/// Sixteen points as they fall on the maps.
struct Splats {
    alignas(64) int map[wide::lanes], first_x[wide::lanes], last_x[wide::lanes], first_y[wide::lanes],
        last_y[wide::lanes];
    alignas(64) float distance[wide::lanes];
};

HWY_INLINE void place_edges(const ShadowMapShape& shape, Real middle, Real half_size, int* first, int* last) {
    wide::store(wide::texel_index(shape, middle - half_size + splat(0.5f)), first);
    wide::store(wide::texel_index(shape, middle + half_size - splat(0.5f)), last);
}

/// Half a splat's width in texels.
HWY_INLINE Real half_width(const ShadowMapShape& shape, const wide::MapPlace& place, Real distance, float side_m,
                           int most_texels) {
    const Real most = splat(0.5f * static_cast<float>(most_texels)), half = splat(0.5f);
    if (shape.directional != 0) return wide::max(wide::min(splat(0.5f * side_m / shape.texel_m), most), half);
    // From the middle of a paraboloid to its rim the texels of an angle double: (1 + r^2) / 2 of the rim's.
    const float per_texel = 2.0f / static_cast<float>(shape.resolution);
    const Real u = wide::fused(place.x, splat(per_texel), splat(-1.0f));
    const Real v = wide::fused(place.y, splat(per_texel), splat(-1.0f));
    const Real per_angle = wide::fused(u, u, wide::fused(v, v, splat(1.0f)));
    const Real texels = splat(0.125f * side_m * static_cast<float>(shape.resolution)) * per_angle / distance;
    return wide::max(wide::min(texels, most), half);
}

HWY_INLINE void project(const PointSamples& samples, std::size_t at, const ShadowMapShape& shape,
                        const SplatOptions& options, Splats& splats) {
    const wide::Vec3 from_light{wide::load(&samples.position[0][at]) - splat(shape.light.x),
                                wide::load(&samples.position[1][at]) - splat(shape.light.y),
                                wide::load(&samples.position[2][at]) - splat(shape.light.z)};
    const bool directional = shape.directional != 0;
    const wide::MapPlace place =
        directional ? wide::orthographic_place(shape, from_light) : wide::paraboloid_place(shape, from_light);
    const Real distance = directional ? splat(2.0f * shape.reach_m) - place.nearness : splat(1.0f) / place.nearness;
    const Real half = half_width(shape, place, distance, options.size * samples.side_m(), options.most_texels);
    wide::store(place.map, splats.map);
    wide::store(distance, splats.distance);
    place_edges(shape, place.x, half, splats.first_x, splats.last_x);
    place_edges(shape, place.y, half, splats.first_y, splats.last_y);
}

void draw(const Splats& splats, std::size_t lane, const ShadowMapShape& shape, float* numbers) {
    float* map = numbers + static_cast<std::ptrdiff_t>(splats.map[lane]) * shape.map_pitch;
    const float distance = splats.distance[lane];
    for (int y = splats.first_y[lane]; y <= splats.last_y[lane]; ++y) {
        float* row = map + static_cast<std::ptrdiff_t>(y) * shape.pitch;
        for (int x = splats.first_x[lane]; x <= splats.last_x[lane]; ++x) row[x] = std::min(row[x], distance);
    }
}

/// Distances become what the look-up wants; what is empty still is 0.
void turn_into_nearness(const ShadowMapShape& shape, std::span<float> numbers) {
    const float farthest = 2.0f * shape.reach_m;
    if (shape.directional != 0)
        for (float& number : numbers) number = number == hole ? 0.0f : farthest - number;
    else
        for (float& number : numbers) number = 1.0f / number;
}

}  // namespace

void draw_imperfect_maps(const PointSamples& samples, std::size_t set, const ShadowMapShape& shape,
                         const SplatOptions& options, std::span<float> numbers, PullPushScratch& scratch) {
    std::ranges::fill(numbers, hole);
    Splats splats;
    const std::size_t start = set * samples.padded();
    for (std::size_t k = 0; k < samples.points; k += wide::lanes) {
        project(samples, start + k, shape, options, splats);
        for (std::size_t lane = 0; lane < std::min(wide::lanes, samples.points - k); ++lane)
            draw(splats, lane, shape, numbers.data());
    }
    const auto per_map = static_cast<std::size_t>(shape.map_pitch);
    for (int map = 0; map < imperfect_maps_of(shape); ++map)
        fill_holes(numbers.subspan(static_cast<std::size_t>(map) * per_map, per_map), shape.resolution, shape.pitch,
                   options.fill_levels, options.tolerance, scratch);
    turn_into_nearness(shape, numbers);
}

}  // namespace sightlines::baselines
