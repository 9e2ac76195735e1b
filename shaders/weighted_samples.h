// Samples whose weights differ, by the reflection of glossy surfaces, by a map of the surroundings, or by both (Veach and
// Guibas 1995): how they are drawn, and what each brings.
#ifndef SIGHTLINES_WEIGHTED_SAMPLES_H
#define SIGHTLINES_WEIGHTED_SAMPLES_H

#include "glossy.h"
#include "harmonic_light.h"
#include "hemisphere.h"
#include "map_light.h"

KERNEL_BEGIN

// By what a sample is drawn.
const uint drawn_by_cosine = 0u;
const uint drawn_by_facets = 1u;
const uint drawn_by_map = 2u;

/// The surroundings: harmonics, or a map.
struct Surroundings {
    bool is_map;
    HarmonicLight harmonics;
    MapLight map;
};

/// A sample's direction, unit, world, and whether it leaves its surface.
struct DrawnSample {
    Vec3 direction;
    Mask above;
};

/// A number moved round by `shift`, below 1 whatever rounding says.
FN Real shifted(Real number, float shift) {
    const Real moved = number + splat(shift);
    return min(select(moved < splat(1.0f), moved, moved - splat(1.0f)), splat(0.99999994f));
}

/// Whether a direction leaves the surface as it is shaded and as it is.
FN Mask leaves_sampled(SampledSurface surface, Vec3 direction) {
    return leaves_surface(surface.up, direction) && leaves_surface(surface.normal, direction);
}

FN HemisphereFrame frame_of(SampledSurface surface) {
    HemisphereFrame frame;
    frame.tangent = surface.tangent;
    frame.bitangent = surface.bitangent;
    frame.normal = surface.up;
    return frame;
}

FN Vec3 cosine_sample(SampledSurface surface, Real u, Real v) {
    const Real radius = sqrt(v);
    const SineCosine turn = sine_cosine_of(u);
    return direction_in(frame_of(surface), radius * turn.cosine, radius * turn.sine,
                        sqrt(max(splat(1.0f) - v, splat(0.0f))));
}

FN Vec3 mirrored_sample(SampledSurface surface, Real u, Real v) {
    const Vec3 local = mirrored_direction(surface.gloss, shifted(u, surface.shift_u), shifted(v, surface.shift_v));
    return direction_in(frame_of(surface), local.x, local.y, local.z);
}

FN Vec3 map_sample(SampledSurface surface, MapDraws draws, Real u, Real v) {
    return direction_by_map(draws, shifted(u, surface.shift_u), shifted(v, surface.shift_v));
}

/// The sample that a point of the unit square stands for. `way`: one of the above. `draws` is only read by the map's way.
FN DrawnSample draw_sample(SampledSurface surface, MapDraws draws, uint way, Real u, Real v) {
    DrawnSample drawn;
    if (way == drawn_by_map)
        drawn.direction = map_sample(surface, draws, u, v);
    else if (way == drawn_by_facets)
        drawn.direction = mirrored_sample(surface, u, v);
    else
        drawn.direction = cosine_sample(surface, u, v);
    drawn.above = leaves_sampled(surface, drawn.direction);
    return drawn;
}

/// Radiance from a unit direction.
FN Vec3 light_from_harmonics(HarmonicLight light, Vec3 direction) {
    HarmonicMoments moments = no_moments();
    add_direction(moments, direction, splat(1.0f));
    Vec3 sum;
    sum.x = splat(light.term[0].x);
    sum.y = splat(light.term[0].y);
    sum.z = splat(light.term[0].z);
    for (int term = 1; term < harmonic_terms; ++term) {
        sum.x = fused(moments.of[term], splat(light.term[term].x), sum.x);
        sum.y = fused(moments.of[term], splat(light.term[term].y), sum.y);
        sum.z = fused(moments.of[term], splat(light.term[term].z), sum.z);
    }
    return sum;
}

/// What a sample of this direction, which leaves the surface, brings where nothing is in the way: its light and the cosine over how
/// densely all ways together draw its direction (the balance heuristic); of a glossy surface times pi and the share that is
/// reflected.
FN Vec3 weighed(SampledSurface surface, Surroundings light, MapDraws draws, Vec3 direction) {
    const float pi = 3.14159265f;
    Vec3 brings;
    if (light.is_map)
        brings = light_from_map(light.map, direction);
    else
        brings = light_from_harmonics(light.harmonics, direction);
    if (surface.weighs_alike != 0u) return brings * splat(pi / surface.all);
    Vec3 local;
    local.x = dot_of(surface.tangent, direction);
    local.y = dot_of(surface.bitangent, direction);
    local.z = dot_of(surface.up, direction);
    Real density = splat(surface.cosine / pi) * local.z;
    if (surface.map > 0.0f) density = fused(splat(surface.map), density_by_map(draws, direction), density);
    if (surface.is_glossy != 0u) {
        const Reflection reflection = reflection_of(surface.gloss, local);
        density = fused(splat(surface.mirrored), reflection.density, density);
        brings.x = brings.x * (reflection.share.x * splat(pi));
        brings.y = brings.y * (reflection.share.y * splat(pi));
        brings.z = brings.z * (reflection.share.z * splat(pi));
    }
    return brings * select(splat(0.0f) < density, local.z / density, splat(0.0f));
}

KERNEL_END

#endif
