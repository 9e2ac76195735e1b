// What a distant light of low frequency sends from a direction.
#ifndef SIGHTLINES_HARMONIC_LIGHT_H
#define SIGHTLINES_HARMONIC_LIGHT_H

#include "harmonic_light_data.h"

KERNEL_BEGIN

/// The nine polynomials of HarmonicLight at a direction, or sums of them over several.
struct HarmonicMoments {
    Real of[9];
};

/// Adds the polynomials of a unit direction where `weight` is 1, nothing where it is 0.
FN void add_direction(INOUT(HarmonicMoments) moments, Vec3 direction, Real weight) {
    const Real x = direction.x * weight;
    const Real y = direction.y * weight;
    const Real z = direction.z * weight;
    moments.of[0] = moments.of[0] + weight;
    moments.of[1] = moments.of[1] + x;
    moments.of[2] = moments.of[2] + y;
    moments.of[3] = moments.of[3] + z;
    moments.of[4] = fused(x, direction.y, moments.of[4]);
    moments.of[5] = fused(y, direction.z, moments.of[5]);
    moments.of[6] = fused(z, direction.x, moments.of[6]);
    moments.of[7] = fused(z * splat(3.0f), direction.z, moments.of[7] - weight);
    moments.of[8] = fused(x, direction.x, fused(-y, direction.y, moments.of[8]));
}

/// No direction yet.
FN HarmonicMoments no_moments() {
    HarmonicMoments moments;
    for (int term = 0; term < harmonic_terms; ++term) moments.of[term] = splat(0.0f);
    return moments;
}

KERNEL_END

#endif
