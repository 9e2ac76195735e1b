// Glossy surfaces (Xu 2022, Figure 10): microfacets with the distribution GGX (Walter 2007), the masking of heights that go
// together (Heitz 2014), and samples of the normals that are seen (Heitz 2018). Directions are about +z.
#ifndef SIGHTLINES_GLOSSY_H
#define SIGHTLINES_GLOSSY_H

#include "angles.h"
#include "weighted_samples_data.h"

KERNEL_BEGIN

FN Real dot_of(vec3 a, Vec3 b) {
    return fused(b.z, splat(a.z), fused(b.y, splat(a.y), b.x * splat(a.x)));
}

/// The share of light that facets at this cosine reflect, between `head_on` and all (Schlick 1994): how far towards all.
FN Real towards_all(Real cosine) {
    const Real missing = min(max(splat(1.0f) - cosine, splat(0.0f)), splat(1.0f));
    const Real squared = missing * missing;
    return squared * squared * missing;
}

/// Smith's function of masking: how many times more facets are hidden than seen from a direction of this height.
FN Real hidden_to_seen(float width, Real height) {
    const Real squared = height * height;
    const Real slope = splat(width * width) * max(splat(1.0f) - squared, splat(0.0f)) / max(squared, splat(1.0e-20f));
    return splat(0.5f) * (sqrt(splat(1.0f) + slope) - splat(1.0f));
}

/// The density of facets' normals, per sr, for normals above the surface.
FN Real normal_density(float width, Vec3 normal) {
    const float w = width * width;
    // Instead of 1 - z * z, which loses all digits near the middle.
    const Real level = fused(normal.y, normal.y, normal.x * normal.x);
    const Real spread = fused(splat(w) * normal.z, normal.z, level);
    return splat(w * 0.318309886f) / (spread * spread);
}

/// The mirrored direction at a facet's normal that is drawn by two numbers in [0, 1) among those seen. May point below
/// the surface.
FN Vec3 mirrored_direction(GlossySurface surface, Real u, Real v) {
    // Of the stretched hemisphere the half disc that is seen is drawn from.
    const Real radius = sqrt(u);
    const SineCosine turn = sine_cosine_of(v);
    const Real x = radius * turn.cosine;
    const Real left = max(fused(-x, x, splat(1.0f)), splat(0.0f));
    const Real y = fused(splat(surface.lean) * radius, turn.sine, splat(1.0f - surface.lean) * sqrt(left));
    const Real height = sqrt(max(fused(-y, y, left), splat(0.0f)));
    const float w = surface.width;
    Vec3 facet;
    facet.x = splat(w) * fused(height, splat(surface.stretched.x), fused(y, splat(surface.up.x), x * splat(surface.side.x)));
    facet.y = splat(w) * fused(height, splat(surface.stretched.y), fused(y, splat(surface.up.y), x * splat(surface.side.y)));
    facet.z = max(fused(height, splat(surface.stretched.z), fused(y, splat(surface.up.z), x * splat(surface.side.z))),
                  splat(1.0e-6f));
    const Real squared = fused(facet.z, facet.z, fused(facet.y, facet.y, facet.x * facet.x));
    const Real twice = splat(2.0f) * dot_of(surface.to_eye, facet) / squared;
    Vec3 direction;
    direction.x = fused(twice, facet.x, splat(-surface.to_eye.x));
    direction.y = fused(twice, facet.y, splat(-surface.to_eye.y));
    direction.z = fused(twice, facet.z, splat(-surface.to_eye.z));
    return direction;
}

/// What goes from a light to the eye, per irradiance, in 1/sr, and how densely `mirrored_direction` draws the light's direction, per
/// sr.
struct Reflection {
    Vec3 share;
    Real density;
};

/// `to_light`: unit, above the surface.
FN Reflection reflection_of(GlossySurface surface, Vec3 to_light) {
    Vec3 half_way;
    half_way.x = to_light.x + splat(surface.to_eye.x);
    half_way.y = to_light.y + splat(surface.to_eye.y);
    half_way.z = to_light.z + splat(surface.to_eye.z);
    const Real squared = fused(half_way.z, half_way.z, fused(half_way.y, half_way.y, half_way.x * half_way.x));
    half_way = half_way * (splat(1.0f) / sqrt(max(squared, splat(1.0e-30f))));
    const Real density = normal_density(surface.width, half_way);
    const Real seen = splat(1.0f) / (splat(1.0f + surface.hidden_from_eye) + hidden_to_seen(surface.width, to_light.z));
    const Real mirrored = density * seen / (splat(4.0f * surface.to_eye.z) * to_light.z);
    const Real facing = towards_all(dot_of(surface.to_eye, half_way));
    // What enters below the facets, and leaves again: by the surface as a whole, or light from the side would grow.
    const Real entering = splat(1.0f) - towards_all(to_light.z);
    const vec3 rest = vec3(1.0f) - surface.head_on;
    Reflection reflection;
    reflection.share.x = fused(fused(splat(rest.x), facing, splat(surface.head_on.x)), mirrored,
                               splat(surface.evenly.x * rest.x) * entering);
    reflection.share.y = fused(fused(splat(rest.y), facing, splat(surface.head_on.y)), mirrored,
                               splat(surface.evenly.y * rest.y) * entering);
    reflection.share.z = fused(fused(splat(rest.z), facing, splat(surface.head_on.z)), mirrored,
                               splat(surface.evenly.z * rest.z) * entering);
    reflection.density = density * splat(1.0f / ((1.0f + surface.hidden_from_eye) * 4.0f * surface.to_eye.z));
    return reflection;
}

KERNEL_END

#endif
