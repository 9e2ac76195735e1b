// Light of surfaces that shine by themselves: which segments towards them are traced, and what each brings.
#ifndef SIGHTLINES_AREA_LIGHT_H
#define SIGHTLINES_AREA_LIGHT_H

#include "visibility_field.h"

KERNEL_BEGIN

/// Whether a segment from a surface to a point of a light must be traced. `faces`: each is in front of the other; `seen`,
/// `hidden`: some segment between points of the surface's cell and of this part of the lights was open, some was blocked.
FN Decision decide_segment(Mask faces, Mask seen, Mask hidden) {
    Decision decision;
    decision.trace = faces && ((seen && hidden) || !(seen || hidden));
    decision.blocked = !faces || (hidden && !seen);
    decision.open = faces && seen && !hidden;
    NOTE("Section 6, local area lights", "The cell's masks tell of the environment, not of what ends before it. So the cell "
                                         "keeps two bits for each part of the lights: some segment to it was open, some "
                                         "was blocked. It is traced where both hold, or none.");
    SHOW(faces);
    SHOW(seen);
    SHOW(hidden);
    SHOW(decision.trace);
    SHOW(decision.blocked);
    SHOW(decision.open);
    return decision;
}

/// The most irradiance that one point brings, for its radiance: a quarter of what light all around brings.
const float largest_weight = 0.7853982f;

/// What a light's point adds to the irradiance of a surface that it shines on. The cosines are from the normals to the
/// segment; `per_m2`: how densely points are drawn. Bounded: one of few points very near the surface would stand for far
/// more light than there can be. The more points there are, the nearer they come before they meet the bound.
FN vec3 segment_adds(vec3 radiance, float cosine_here, float cosine_there, float distance_m, float per_m2) {
    const float weight = min(cosine_here * cosine_there / (distance_m * distance_m * per_m2), largest_weight);
    const vec3 adds = radiance * weight;
    NOTE("Section 6, local area lights", "Where nothing is in the way the point brings its radiance, by both cosines and the "
                                         "square of the distance, over how densely such points are drawn; "
                                         "but not more than a quarter of what light all around would.");
    SHOW(radiance);
    SHOW(cosine_here);
    SHOW(cosine_there);
    SHOW(distance_m);
    SHOW(adds);
    return adds;
}

KERNEL_END

#endif
