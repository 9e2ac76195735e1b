// Shadow maps as the looking-up kernels see them: conventional ones, and the imperfect ones of Ritschel 2008.
#ifndef SIGHTLINES_SHADOW_MAP_DATA_H
#define SIGHTLINES_SHADOW_MAP_DATA_H

#include "portability.h"

SHARED_BEGIN

/// What the maps of one light look like. Maps hold nearness: greater is nearer to the light. Point and spot lights have
/// the six faces of a cube (nearness = 1 / depth along the face's axis) or two paraboloids (1 / distance); directional
/// lights have one map over the scene's bounds (nearness = reach - depth, m). Nothing there: 0. 96 bytes, scalar layout.
struct ShadowMapShape {
    vec3 light;             // its position, m; of a directional light: the centre of the bounds
    int resolution;         // texels along each side of a map
    vec3 axis_u;            // of a directional light's map, in texels per metre
    int pitch;              // numbers from one row of texels to the next
    vec3 axis_v;
    int map_pitch;          // numbers from one map of the light to the next
    vec3 axis_depth;        // unit, the way a directional light travels
    float texel_m;          // the size of a directional light's texel
    float normal_offset;    // how far the looked-up point is moved off its surface, in sizes of a texel there
    float depth_bias;       // how much nearer than the point a blocker must be, in sizes of a texel there
    float blur_m;           // what is added to a texel's size: that of a splat; 0 for conventional maps
    int directional;        // 1 for a directional light
    float reach_m;          // of a directional light's depths
    float padding_0;
    float padding_1;
    float padding_2;
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::ShadowMapShape) == 96);
#endif

#endif
