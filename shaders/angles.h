// Angles as shares of a full turn, by polynomials (after Moshier's Cephes library): the same digits in every compilation,
// and no branches.
#ifndef SIGHTLINES_ANGLES_H
#define SIGHTLINES_ANGLES_H

#include "portability.h"

KERNEL_BEGIN

struct SineCosine {
    Real sine;
    Real cosine;
};

/// Sine and cosine of an angle of `turns` full turns, in [0, 1]; within 2e-7.
FN SineCosine sine_cosine_of(Real turns) {
    // The nearest quarter, and an eighth of a turn at most to either side of it.
    const Int quarter = to_int(fused(turns, splat(4.0f), splat(0.5f)));
    const Real angle = fused(to_real(quarter), splat(-0.25f), turns) * splat(6.28318531f);
    const Real squared = angle * angle;
    const Real for_sine = fused(fused(splat(-1.9515295891e-4f), squared, splat(8.3321608736e-3f)), squared,
                                splat(-1.6666654611e-1f));
    const Real for_cosine = fused(fused(splat(2.443315711809948e-5f), squared, splat(-1.388731625493765e-3f)), squared,
                                  splat(4.166664568298827e-2f));
    const Real sine = fused(for_sine * squared, angle, angle);
    const Real cosine = fused(for_cosine * squared, squared, fused(splat(-0.5f), squared, splat(1.0f)));
    const Mask odd = (quarter & splat(1)) == splat(1);
    const Mask sine_below = (quarter & splat(2)) == splat(2);
    const Mask cosine_below = ((quarter + splat(1)) & splat(2)) == splat(2);
    const Real upright = select(odd, cosine, sine);
    const Real level = select(odd, sine, cosine);
    SineCosine both;
    both.sine = select(sine_below, -upright, upright);
    both.cosine = select(cosine_below, -level, level);
    return both;
}

/// The angle of the point (x, y) about the origin, from +x towards +y, in [-1/2, 1/2] turns; within 1e-7. Not for both zero.
FN Real turns_of(Real y, Real x) {
    const Real along = abs(x);
    const Real across = abs(y);
    const Real larger = max(along, across);
    const Real smaller = min(along, across);
    // Beyond a sixteenth of a turn as seen from an eighth.
    const Mask far = splat(0.414213562f) * larger < smaller;
    const Real slope = select(far, smaller - larger, smaller) / max(select(far, smaller + larger, larger), splat(1.0e-37f));
    const Real squared = slope * slope;
    const Real terms = fused(fused(fused(splat(8.05374449538e-2f), squared, splat(-1.38776856032e-1f)), squared,
                                   splat(1.99777106478e-1f)),
                             squared, splat(-3.33329491539e-1f));
    const Real angle = fused(terms * squared, slope, slope);
    const Real octant = fused(angle, splat(0.159154943f), select(far, splat(0.125f), splat(0.0f)));
    const Real quadrant = select(along < across, splat(0.25f) - octant, octant);
    const Real half_turn = select(x < splat(0.0f), splat(0.5f) - quadrant, quadrant);
    return select(y < splat(0.0f), -half_turn, half_turn);
}

KERNEL_END

#endif
