// What one dispatch of voxel_rows_first_hit.comp is told, and what it leaves behind.
#ifndef SIGHTLINES_VOXEL_ROWS_FIRST_HIT_DATA_H
#define SIGHTLINES_VOXEL_ROWS_FIRST_HIT_DATA_H

#include "voxel_rows_data.h"

#ifdef __cplusplus
#define ADDRESS_OF(Buffer) std::uint64_t
#else
#define ADDRESS_OF(Buffer) Buffer
#endif

SHARED_BEGIN

/// A ray that starts on a surface. 36 bytes, scalar layout.
struct HitRay {
    vec3 position;   // m
    vec3 normal;     // unit, of the surface; what it is put off by
    vec3 target;     // m
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer HitRayTable { HitRay v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer ShareTable { float v[]; };
#endif

/// The push constants: 104 bytes. One invocation a ray.
struct FirstHitJob {
    RowShape query;
    uint rays;
    ADDRESS_OF(FrameTable) frames;
    ADDRESS_OF(Rows) rows;
    ADDRESS_OF(HitRayTable) asked;
    ADDRESS_OF(ShareTable) shares;   // RowHit::share for each ray; -1 where nothing is hit
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::HitRay) == 36 && sizeof(sightlines::FirstHitJob) == 104);
#endif

#endif
