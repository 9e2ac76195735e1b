// A distant light of low frequency as the kernels see it: spherical harmonics of order 3 (Ramamoorthi and Hanrahan 2001).
#ifndef SIGHTLINES_HARMONIC_LIGHT_DATA_H
#define SIGHTLINES_HARMONIC_LIGHT_DATA_H

#include "portability.h"

SHARED_BEGIN

const int harmonic_terms = 9;

/// The factors of 1, x, y, z, xy, yz, zx, 3zz - 1 and xx - yy of a unit direction: coefficients of the real spherical
/// harmonics times their normalisation. 108 bytes, scalar layout.
struct HarmonicLight {
    vec3 term[9];
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::HarmonicLight) == 108);
#endif

#endif
