// The array of rotated voxelizations as the kernels see it (Wang 2017, section 3).
#ifndef SIGHTLINES_VOXEL_ROWS_DATA_H
#define SIGHTLINES_VOXEL_ROWS_DATA_H

#include "portability.h"

SHARED_BEGIN

/// World to voxel coordinates of one direction's voxelization: u along the rows, v and w across them, each in [0, N]
/// over the scene's bounds. coordinate = dot(axis, world point) + offset. 48 bytes, scalar layout.
struct DirectionFrame {
    vec3 u;
    float u_offset;
    vec3 v;
    float v_offset;
    vec3 w;
    float w_offset;
};

/// What a query must know of the array and of the parameters. 64 bytes, scalar layout.
struct RowShape {
    int resolution;            // N, voxels along each axis
    int angles;                // of theta and of phi
    int words_per_row;         // 1, 2, 4 or 8
    int subrays;               // 1, or 2 where each half of the ray is looked up in a row of its own
    float steps_per_radian;    // angles / pi
    float start_offset;        // voxels left out along the row at the surface
    float light_offset;        // voxels left out along the row at the light
    int clip_to_bounds;        // 1 where lights may lie outside the bounds
    vec3 lowest;               // of the bounds, m
    float reach_m;             // how far directional lights are put away
    vec3 highest;
    float normal_offset_m;     // how far a ray starts off the surface along its normal
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::DirectionFrame) == 48 && sizeof(sightlines::RowShape) == 64);
#endif

#endif
