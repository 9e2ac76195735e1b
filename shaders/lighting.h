// Which rays are asked, and what a light gives to a surface that sees it. Shared by the reference and every technique,
// so that they differ in nothing but visibility.
#ifndef SIGHTLINES_LIGHTING_H
#define SIGHTLINES_LIGHTING_H

#include "lighting_data.h"

KERNEL_BEGIN

FN Real dot3(Vec3 a, Vec3 b) { return fused(a.z, b.z, fused(a.y, b.y, a.x * b.x)); }

/// From the surface towards the light, m; its end is where the shadow ray ends. `reach_m`: how far a directional light
/// is put away, at least the scene's diagonal.
FN Vec3 to_light(LightRecord light, Vec3 position, float reach_m) {
    if (light.kind == light_directional) return splat(light.direction * -reach_m);
    return splat(light.position) - position;
}

/// Where the shadow ray ends: the light itself, or far along a directional light.
FN Vec3 light_end(LightRecord light, Vec3 position, float reach_m) {
    if (light.kind == light_directional) return position - splat(light.direction * reach_m);
    return splat(light.position);
}

/// The ray is asked where the light is in front of the surface; otherwise the surface itself is in the way.
FN Mask is_asked(Vec3 normal, Vec3 to_the_light) { return dot3(normal, to_the_light) > splat(0.0f); }

/// Irradiance from the light where nothing is in the way, divided by the light's intensity: cosine over squared
/// distance, a spot's falloff and a surface's cosine included. W/m^2 for 1 W/sr. The distance is kept above a millimetre, and
/// above a surface light's own nearest distance.
FN Real irradiance_per_intensity(LightRecord light, Vec3 normal, Vec3 to_the_light) {
    const Real squared_distance = max(dot3(to_the_light, to_the_light), splat(1.0e-6f));
    const Real distance = sqrt(squared_distance);
    const Real cosine = max(dot3(normal, to_the_light) / distance, splat(0.0f));
    if (light.kind == light_directional) return cosine;
    const Real point = cosine / squared_distance;
    if (light.kind == light_point) return point;
    const Real cosine_off_axis = -dot3(splat(light.direction), to_the_light) / distance;
    if (light.kind == light_surface) {
        const Real kept_away = max(squared_distance, splat(light.cosine_outer));
        return cosine * max(cosine_off_axis, splat(0.0f)) / kept_away;
    }
    const Real width = splat(max(light.cosine_inner - light.cosine_outer, 1.0e-4f));
    const Real inside = min(max((cosine_off_axis - splat(light.cosine_outer)) / width, splat(0.0f)), splat(1.0f));
    return point * inside * inside;
}

KERNEL_END

#endif
