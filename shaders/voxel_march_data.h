// One unrotated voxelization as the marching kernels see it: what Wang 2017, section 6.2, compares with.
#ifndef SIGHTLINES_VOXEL_MARCH_DATA_H
#define SIGHTLINES_VOXEL_MARCH_DATA_H

#include "portability.h"

SHARED_BEGIN

/// A voxelization in memory, with one layer of empty voxels all around, so that a march may step out of the grid by one
/// voxel. Bits: voxel (x, y, z) is number (x + 1) + stride_y (y + 1) + stride_z (z + 1). Distances: row (y, z) is
/// number (y + 1) + rows_per_layer (z + 1), and voxel x of it is byte x % 4 of word rows (x / 4) + row: rays that cross
/// row after row find them side by side. 80 bytes, scalar layout.
struct VoxelGrid {
    vec3 lowest;             // corner of the grid, m
    float reach_m;           // how far directional lights are put away
    vec3 voxels_per_metre;   // along each axis
    float normal_offset_m;   // how far a ray starts off the surface along its normal
    float cells_x;           // voxels along each axis, whole numbers
    float cells_y;
    float cells_z;
    float start_offset;      // voxels of the ray left out at the surface
    int stride_y;            // numbers from a voxel to its neighbours along y and z
    int stride_z;
    int rows_per_layer;      // numbers from a row to its neighbour along z
    int rows;                // in all
    int backward_words;      // from the distances along x to those against x
    float light_offset;      // voxels of the ray left out at the light
    float padding_0;
    float padding_1;
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::VoxelGrid) == 80);
#endif

#endif
