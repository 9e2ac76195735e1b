// Light of the surroundings by way of one other surface: what a sample of a pixel hits is lit by one ray of its own.
#ifndef SIGHTLINES_ONE_BOUNCE_H
#define SIGHTLINES_ONE_BOUNCE_H

#include "hemisphere.h"

KERNEL_BEGIN

/// The direction in which a surface that was hit looks for light: `about_up` turned from +z to its normal.
FN vec3 second_direction(vec3 shading_normal, vec3 about_up) {
    const vec3 direction = direction_in(frame_about(shading_normal, 1.0f, 0.0f), about_up.x, about_up.y, about_up.z);
    NOTE("Section 6, indirect illumination", "What the blocked sample hit is lit by one ray of its own, drawn at "
                                             "random. Its own cell says whether that ray is traced.");
    SHOW(shading_normal);
    SHOW(direction);
    return direction;
}

/// The radiance that it sends back to the pixel. `light`: what comes from the one ray's direction, which stands for all, times
/// cosine / pi over the density by which it was drawn; the surface reflects albedo of that.
FN vec3 sent_back(vec3 albedo, vec3 light, bool blocked) {
    const vec3 sends = albedo * light * (blocked ? 0.0f : 1.0f);
    NOTE("Section 6, indirect illumination", "Where that ray is open, the surface reflects its share of the surroundings' "
                                             "light to the pixel.");
    SHOW(albedo);
    SHOW(light);
    SHOW(blocked);
    SHOW(sends);
    return sends;
}

KERNEL_END

#endif
