// The kernels of weighted samples by vectors, for both who draw them into arrays and who sort them out at once.
// Internal to this folder; include shaders/wide.h before it.
#pragma once

#include <bit>

#include "shaders/weighted_samples.h"
#include "techniques/scene/map_sampling.h"
#include "techniques/visibility_field/weighted_samples.h"

#ifndef SIGHTLINES_WIDE_H
#error "shaders/wide.h makes these kernels wide"
#endif

namespace sightlines::visibility_field {

/// The tables as the wide kernels see them.
struct WideTables {
    wide_kernel::Surroundings light;
    wide_kernel::MapDraws draws;

    explicit WideTables(const WeightedTables& tables)
        : light{tables.texels != nullptr, tables.harmonics, {tables.map, {tables.texels}}}, draws{} {
        if (const MapDistribution* from = tables.draws)
            draws = {from->shape,
                     {from->tables->rows.data()},
                     {from->tables->heights.data()},
                     {from->tables->columns.data()},
                     {from->tables->density.data()}};
    }
};

/// Calls `visit(first, drawn, inside)` for each vector of the pixel's samples: the number of its first, its directions,
/// and the lanes that are samples.
template <class Visit>
HWY_INLINE void draw_by_vectors(const WeightedTables& tables, const WideTables& wide_tables, const WeightedPixel& pixel,
                                const Visit& visit) {
    namespace wide = wide_kernel;
    std::uint32_t first = 0;
    const auto draw = [&](std::uint32_t way, std::uint32_t count) HWY_ATTR {
        const wide::Real strata = wide::splat(1.0f / static_cast<float>(count));
        const wide::Real middle = wide::splat(0.5f / static_cast<float>(std::bit_ceil(count)));
        for (std::uint32_t k = 0; k < count; k += static_cast<std::uint32_t>(wide::lanes)) {
            const wide::Real u = wide::load(&tables.ordinal[k]) * strata, v = wide::load(&tables.inverse[k]) + middle;
            const wide::Mask inside{wide::hn::FirstN(wide::RealTag(), count - k)};
            visit(first + k, wide::draw_sample(pixel.surface, wide_tables.draws, way, u, v), inside);
        }
        first += count;
    };
    if (pixel.cosine > 0) draw(wide::drawn_by_cosine, pixel.cosine);
    if (pixel.mirrored > 0) draw(wide::drawn_by_facets, pixel.mirrored);
    if (pixel.map > 0) draw(wide::drawn_by_map, pixel.map);
}

/// Directions side by side, with room for a vector more.
struct Directions {
    std::vector<float> x, y, z;
    std::size_t count = 0;

    explicit Directions(std::size_t most) : x(most + 2 * wide_kernel::lanes), y(x), z(x) {}
    HWY_INLINE void add(wide_kernel::Vec3 direction, wide_kernel::Mask mask) {
        wide_kernel::store_compressed(direction.x, mask, &x[count]);
        wide_kernel::store_compressed(direction.y, mask, &y[count]);
        wide_kernel::store_compressed(direction.z, mask, &z[count]);
        count += static_cast<std::size_t>(std::popcount(wide_kernel::bits_of(mask)));
    }
};

/// What samples of these directions, which leave the surface, bring together.
HWY_INLINE vec3 sum_of_weighed(const WideTables& tables, const SampledSurface& surface, const Directions& directions) {
    namespace wide = wide_kernel;
    wide::Vec3 sum = wide::splat(vec3(0.0f));
    for (std::size_t k = 0; k < directions.count; k += wide::lanes) {
        const wide::Vec3 direction{wide::load(&directions.x[k]), wide::load(&directions.y[k]),
                                   wide::load(&directions.z[k])};
        const wide::Vec3 brings = wide::weighed(surface, tables.light, tables.draws, direction);
        const wide::Mask used{wide::hn::FirstN(wide::RealTag(), directions.count - k)};
        sum.x = sum.x + wide::select(used, brings.x, wide::splat(0.0f));
        sum.y = sum.y + wide::select(used, brings.y, wide::splat(0.0f));
        sum.z = sum.z + wide::select(used, brings.z, wide::splat(0.0f));
    }
    const auto total = [](wide::Real each)
                           HWY_ATTR { return wide::hn::GetLane(wide::hn::SumOfLanes(wide::RealTag(), each.v)); };
    return {total(sum.x), total(sum.y), total(sum.z)};
}

}  // namespace sightlines::visibility_field
