// An equirectangular map of the surroundings: what it sends from a direction, and directions drawn where it is bright (2-D
// inversion of the cumulative distribution; Pharr, Jakob, Humphreys: Physically Based Rendering).
#ifndef SIGHTLINES_MAP_LIGHT_H
#define SIGHTLINES_MAP_LIGHT_H

#include "angles.h"
#include "fetch.h"
#include "weighted_samples_data.h"

KERNEL_BEGIN

/// A map and its texels, [height][width][3].
struct MapLight {
    MapShape shape;
    Reals texels;
};

/// The tables by which a map is drawn.
struct MapDraws {
    MapShape shape;
    Reals rows;       // [height + 1], cumulative, from 0 to 1
    Reals heights;    // [height + 1], of the rows' edges above the middle of the sphere
    Reals columns;    // [height][width + 1], cumulative within a row, from 0 to 1
    Reals densities;  // [height][width], per sr
};

/// A place in the map, both from 0 to 1.
struct EnvironmentPlace {
    Real across;
    Real down;
};

FN EnvironmentPlace map_place(MapShape map, Vec3 direction) {
    const Real x = fused(splat(-map.turn_sine), direction.z, splat(map.turn_cosine) * direction.x);
    const Real z = fused(splat(map.turn_cosine), direction.z, splat(map.turn_sine) * direction.x);
    const Real ring = sqrt(fused(z, z, x * x));
    EnvironmentPlace place;
    place.across = turns_of(x, -z) + splat(0.5f);
    place.down = splat(2.0f) * turns_of(ring, direction.y);
    return place;
}

/// Radiance from a unit direction, bilinear.
FN Vec3 light_from_map(MapLight map, Vec3 direction) {
    const EnvironmentPlace place = map_place(map.shape, direction);
    const int width = map.shape.width;
    const int height = map.shape.height;
    // One more, so that what is cut off is never negative.
    const Real right_of = fused(place.across, splat(float(width)), splat(0.5f));
    const Real below = fused(place.down, splat(float(height)), splat(0.5f));
    const Int column = to_int(right_of);
    const Int row = to_int(below);
    const Real blend_across = right_of - to_real(column);
    const Real blend_down = below - to_real(row);
    const Int left = select(column < splat(1), splat(width - 1), min(column, splat(width)) - splat(1));
    const Int right = select(column > splat(width - 1), splat(0), column);
    const Int upper = min(max(row - splat(1), splat(0)), splat(height - 1)) * splat(width);
    const Int lower = min(row, splat(height - 1)) * splat(width);
    const Int upper_left = (upper + left) * splat(3);
    const Int upper_right = (upper + right) * splat(3);
    const Int lower_left = (lower + left) * splat(3);
    const Int lower_right = (lower + right) * splat(3);
    const Real lower_share = blend_down;
    const Real upper_share = splat(1.0f) - blend_down;
    const Real a = upper_share * (splat(1.0f) - blend_across);
    const Real b = upper_share * blend_across;
    const Real c = lower_share * (splat(1.0f) - blend_across);
    const Real d = lower_share * blend_across;
    Vec3 light;
    light.x = fused(d, fetch_real(map.texels, lower_right),
                    fused(c, fetch_real(map.texels, lower_left),
                          fused(b, fetch_real(map.texels, upper_right), a * fetch_real(map.texels, upper_left))));
    light.y = fused(d, fetch_real(map.texels, lower_right + splat(1)),
                    fused(c, fetch_real(map.texels, lower_left + splat(1)),
                          fused(b, fetch_real(map.texels, upper_right + splat(1)),
                                a * fetch_real(map.texels, upper_left + splat(1)))));
    light.z = fused(d, fetch_real(map.texels, lower_right + splat(2)),
                    fused(c, fetch_real(map.texels, lower_left + splat(2)),
                          fused(b, fetch_real(map.texels, upper_right + splat(2)),
                                a * fetch_real(map.texels, upper_left + splat(2)))));
    return light;
}

/// Which of `count` intervals between cumulative sums holds a number below 1. The sums lie from `first` on.
FN Int interval_of(Reals sums, Int first, int count, int first_step, Real number) {
    Int interval = splat(0);
    for (int size = first_step; size > 0; size = size / 2) {
        const Int next = min(interval + splat(size), splat(count));
        interval = select(number < fetch_real(sums, first + next), interval, next);
    }
    return interval;
}

/// Where in its interval the number lies, from 0 to 1.
FN Real place_within(Reals sums, Int interval, Real number) {
    const Real start = fetch_real(sums, interval);
    const Real size = max(fetch_real(sums, interval + splat(1)) - start, splat(1.0e-20f));
    return min(max((number - start) / size, splat(0.0f)), splat(1.0f));
}

/// The direction that is drawn by two numbers in [0, 1): even by solid angle within a texel.
FN Vec3 direction_by_map(MapDraws draws, Real u, Real v) {
    const MapShape map = draws.shape;
    const Int row = interval_of(draws.rows, splat(0), map.height, map.first_row_step, v);
    const Real down = place_within(draws.rows, row, v);
    const Int first = row * splat(map.width + 1);
    const Int column = interval_of(draws.columns, first, map.width, map.first_column_step, u);
    const Real across = place_within(draws.columns, first + column, u);
    const Real upper = fetch_real(draws.heights, row);
    const Real height = fused(fetch_real(draws.heights, row + splat(1)) - upper, down, upper);
    const Real ring = sqrt(max((splat(1.0f) - height) * (splat(1.0f) + height), splat(0.0f)));
    const SineCosine turn = sine_cosine_of((to_real(column) + across) / splat(float(map.width)));
    const Real x = -(ring * turn.sine);
    const Real z = ring * turn.cosine;
    Vec3 direction;
    direction.x = fused(splat(map.turn_sine), z, splat(map.turn_cosine) * x);
    direction.y = height;
    direction.z = fused(splat(map.turn_cosine), z, splat(-map.turn_sine) * x);
    return direction;
}

/// How densely `direction_by_map` draws a unit direction, per sr.
FN Real density_by_map(MapDraws draws, Vec3 direction) {
    const EnvironmentPlace place = map_place(draws.shape, direction);
    const int width = draws.shape.width;
    const int height = draws.shape.height;
    const Int column = min(max(to_int(place.across * splat(float(width))), splat(0)), splat(width - 1));
    const Int row = min(max(to_int(place.down * splat(float(height))), splat(0)), splat(height - 1));
    return fetch_real(draws.densities, row * splat(width) + column);
}

KERNEL_END

#endif
