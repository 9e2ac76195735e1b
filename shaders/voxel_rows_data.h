// The array of rotated voxelizations as the kernels see it (Wang 2017, section 3).
#ifndef SIGHTLINES_VOXEL_ROWS_DATA_H
#define SIGHTLINES_VOXEL_ROWS_DATA_H

#include "portability.h"

SHARED_BEGIN

/// World to voxel coordinates of one direction's voxelization: u along the rows, v and w across them, each in [0, N]
/// over the scene's bounds. coordinate = dot(axis, world point - centre of the bounds) + N / 2. The axis v = (v_x, 0, v_z)
/// is level in every direction. 32 bytes, scalar layout: half a cache line, read for every ray.
struct DirectionFrame {
    vec3 u;
    float v_x;
    vec3 w;
    float v_z;
};

/// What a query must know of the array and of the parameters. 68 bytes, scalar layout.
struct RowShape {
    int resolution;            // N, voxels along each axis
    int angles;                // of theta and of phi
    int words_per_row;         // 1, 2, 4 or 8
    int subrays;               // 1, or 2 where each half of the ray is looked up in a row of its own
    int index_bits;            // 0: the rows themselves; 20 or 32: indices into a dictionary of rows
    int index_start;           // words before the indices: the dictionary
    float start_offset;        // voxels left out along the row at the surface
    float light_offset;        // voxels left out along the row at the light
    int clip_to_bounds;        // 1 where lights may lie outside the bounds
    vec3 centre;               // of the bounds, m
    float reach_m;             // how far directional lights are put away
    vec3 half_size;            // of the bounds, m
    float normal_offset_m;     // how far a ray starts off the surface along its normal
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::DirectionFrame) == 32 && sizeof(sightlines::RowShape) == 68);
#endif

#endif
