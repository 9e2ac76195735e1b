// What one dispatch of visibility_field_lighting.comp is told, and what it leaves behind.
#ifndef SIGHTLINES_VISIBILITY_FIELD_LIGHTING_DATA_H
#define SIGHTLINES_VISIBILITY_FIELD_LIGHTING_DATA_H

#include "visibility_field_data.h"
#include "weighted_samples_data.h"

#ifdef __cplusplus
#define ADDRESS_OF(Buffer) std::uint64_t
#define ADDRESS_WORDS std::uint64_t
#else
#include "ray_tree_memory.h"
#include "visibility_field_memory.h"
#define ADDRESS_OF(Buffer) Buffer
#define ADDRESS_WORDS uvec2
#endif

SHARED_BEGIN

// The specialization constant 0: bits of what samples may be. Known when the pipeline is made, so that it holds nothing else:
// software devices go through all branches.
const uint samples_weighted = 1u;      // they have weights of their own
const uint samples_of_glossy = 2u;     // surfaces
const uint samples_lit_by_map = 4u;
const uint samples_by_cosine = 8u;     // some are drawn so
const uint samples_by_facets = 16u;
const uint samples_by_map = 32u;

// FieldLightingJob::culling: by the cell's label, by the visibility mask alone, by both masks, or not at all.
const uint cull_by_label = 0u;
const uint cull_by_visible = 1u;
const uint cull_by_both = 2u;
const uint cull_nothing = 3u;

/// The surface under one pixel. 44 bytes, scalar layout.
struct AskingPoint {
    vec3 position;         // m
    vec3 normal;           // unit, geometric; zero: a pixel that asks nothing
    vec3 shading_normal;   // unit
    float turn_cosine;     // of the samples about the shading normal
    float turn_sine;
};

/// What a pixel's samples come to so far. 60 bytes, scalar layout.
struct FieldSums {
    float moment[9];        // of HarmonicMoments: what is open; where `subtracts`, minus what is blocked. Of samples with
                            // weights of their own: the first three, what open ones bring
    uint asked;             // samples above the surface
    uint blocked;           // of these
    uint traced;            // of these
    uint traced_blocked;    // of those
    uint outside;           // 1: the pixel is in no cell that holds masks
    uint subtracts;         // 1: `moment` is taken off the unshadowed irradiance
};

#ifndef __cplusplus
struct PatternDirection {
    vec3 direction;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer DirectionTable { PatternDirection v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer AskingTable { AskingPoint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer SampledTable { SampledSurface v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer FieldSumTable { FieldSums v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer FieldVerdicts { uint v[]; };
#endif

/// What stays the same while a field is asked. 112 bytes, scalar layout. Rays are answered by the tree, or, where the
/// device is asked by ray queries, by `ray_scene`; `triangles` are then those whose holes are in `cutouts`.
struct FieldTables {
    FieldShape shape;
    ADDRESS_OF(Bricks) bricks;
    ADDRESS_OF(Words) mask_numbers;
    ADDRESS_OF(Words) masks;
    ADDRESS_OF(FourWordTable) nodes;
    ADDRESS_OF(FourWordTable) triangles;
    ADDRESS_OF(FourWordTable) cutouts;
    ADDRESS_WORDS ray_scene;
    uint node_count;
    float surface_offset_m;   // rays start so far above their surface
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer FieldTable { FieldTables v[]; };
#endif

/// The light of samples that have weights of their own, and the tables by which a map is drawn. 208 bytes, scalar layout.
struct WeightedLight {
    HarmonicLight harmonics;
    MapShape map;
    ADDRESS_OF(Reals) texels;
    MapShape draws;
    ADDRESS_OF(Reals) rows;
    ADDRESS_OF(Reals) heights;
    ADDRESS_OF(Reals) columns;
    ADDRESS_OF(Reals) densities;
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer WeightedLightTable { WeightedLight v[]; };
#endif

/// The push constants. One invocation a pixel, over a range of samples.
struct FieldLightingJob {
    ADDRESS_OF(FieldTable) field;
    ADDRESS_OF(DirectionTable) directions;   // of all pixels, about +z; not read where samples have weights of their own
    ADDRESS_OF(AskingTable) surfaces;
    ADDRESS_OF(FieldSumTable) sums;
    ADDRESS_OF(SampledTable) sampled;        // a surface a pixel, where they have
    ADDRESS_OF(WeightedLightTable) light;
    ADDRESS_OF(FieldVerdicts) verdicts;      // a bit for each sample, words_per_pixel words for each pixel; zero at first
    uint first_sample;
    uint end_sample;
    uint samples;
    uint words_per_pixel;                    // 0: verdicts are not kept
    uint culling;
    uint subtracts;                          // 1: cells of label 0 start from the unshadowed irradiance
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::AskingPoint) == 44 && sizeof(sightlines::FieldSums) == 60);
static_assert(sizeof(sightlines::WeightedLight) == 208);
static_assert(sizeof(sightlines::FieldTables) == 112 && sizeof(sightlines::FieldLightingJob) == 80);
#endif

#endif
