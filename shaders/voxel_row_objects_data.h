// Objects that move rigidly, as the kernels see them (Wang 2017, Algorithm 5), and what one dispatch of
// voxel_row_objects_lighting.comp is told.
#ifndef SIGHTLINES_VOXEL_ROW_OBJECTS_DATA_H
#define SIGHTLINES_VOXEL_ROW_OBJECTS_DATA_H

#include "voxel_rows_lighting_data.h"

SHARED_BEGIN

/// One instance of an object: the array of its type, and where it is now. A coordinate of the object's own frame is
/// dot(axis, world point) + shift. 136 bytes, scalar layout.
struct ObjectInstance {
    ADDRESS_OF(FrameTable) frames;  // of its type's array
    ADDRESS_OF(Rows) rows;
    RowShape query;  // of that array; the normal offset in metres of the world
    vec3 axis_x;
    vec3 axis_y;
    vec3 axis_z;
    vec3 shift;
    uint type;  // which of the arrays
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ObjectTable { ObjectInstance v[]; };
#endif

/// The push constants: one invocation a pixel, over a range of lights. The verdicts already tell what stands still.
struct ObjectLightingJob {
    ADDRESS_OF(ObjectTable) objects;
    ADDRESS_OF(LightTable) lights;
    ADDRESS_OF(SurfaceTable) surfaces;
    ADDRESS_OF(SumTable) sums;
    ADDRESS_OF(VerdictTable) verdicts;  // a bit for each light, words_per_pixel words for each pixel
    uint object_count;
    uint first_light;  // a multiple of 32
    uint end_light;
    uint words_per_pixel;
    float reach_m;  // how far directional lights are put away
    uint padding;
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::ObjectInstance) == 136 && sizeof(sightlines::ObjectLightingJob) == 64);
#endif

#endif
