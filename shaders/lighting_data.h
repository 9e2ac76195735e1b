// A light as the kernels see it.
#ifndef SIGHTLINES_LIGHTING_DATA_H
#define SIGHTLINES_LIGHTING_DATA_H

#include "portability.h"

SHARED_BEGIN

const uint light_point = 0u;
const uint light_spot = 1u;
const uint light_directional = 2u;
const uint light_surface = 3u;

/// 48 bytes, scalar layout.
struct LightRecord {
    vec3 position;        // m; a directional light: unused
    uint kind;            // light_point, light_spot, light_directional, light_surface
    vec3 intensity;       // W/sr; a directional light: W/m^2
    float cosine_outer;   // of a spot's half angles; a surface: the square of its nearest distance, m^2
    vec3 direction;       // unit, the way the light travels; a surface: its normal
    float cosine_inner;
};

SHARED_END

#endif
