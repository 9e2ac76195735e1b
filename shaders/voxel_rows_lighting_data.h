// What one dispatch of voxel_rows_lighting.comp is told, and what it leaves behind.
#ifndef SIGHTLINES_VOXEL_ROWS_LIGHTING_DATA_H
#define SIGHTLINES_VOXEL_ROWS_LIGHTING_DATA_H

#include "lighting_data.h"
#include "voxel_rows_data.h"

#ifdef __cplusplus
#define ADDRESS_OF(Buffer) std::uint64_t
#else
#define ADDRESS_OF(Buffer) Buffer
#endif

SHARED_BEGIN

/// The surface under one pixel. 36 bytes, scalar layout.
struct SurfacePoint {
    vec3 position;         // m
    vec3 normal;           // unit, geometric; zero: nothing is asked for this pixel
    vec3 shading_normal;   // unit
};

/// What a pixel has gathered from the lights so far. 20 bytes, scalar layout.
struct PixelSums {
    vec3 irradiance;   // W/m^2
    uint asked;
    uint blocked;
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LightTable { LightRecord v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer SurfaceTable { SurfacePoint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer SumTable { PixelSums v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer VerdictTable { uint v[]; };
#endif

/// The push constants: 128 bytes, as many as every device takes. One invocation a pixel, over a range of lights.
struct LightingJob {
    RowShape query;
    uint first_light;                    // a multiple of 32 where verdicts are kept
    ADDRESS_OF(FrameTable) frames;
    ADDRESS_OF(Rows) rows;
    ADDRESS_OF(LightTable) lights;
    ADDRESS_OF(SurfaceTable) surfaces;
    ADDRESS_OF(SumTable) sums;
    ADDRESS_OF(VerdictTable) verdicts;   // a bit for each light, words_per_pixel words for each pixel
    uint end_light;
    uint words_per_pixel;
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::SurfacePoint) == 36 && sizeof(sightlines::PixelSums) == 20);
static_assert(sizeof(sightlines::LightingJob) == 128);
#endif

#endif
