// What the kernels of samples that have weights of their own are told of a surface and of a map.
#ifndef SIGHTLINES_WEIGHTED_SAMPLES_DATA_H
#define SIGHTLINES_WEIGHTED_SAMPLES_DATA_H

#include "harmonic_light_data.h"

SHARED_BEGIN

/// What a surface reflects to an eye: as a mirror of its facets, whose normals follow GGX, and the rest evenly. Directions are
/// about +z and leave the surface. 96 bytes, scalar layout.
struct GlossySurface {
    vec3 to_eye;
    vec3 head_on;           // reflectance of facets seen head on
    vec3 evenly;            // what reaches the eye from below the facets, per irradiance that enters: 1/sr
    vec3 stretched;         // to_eye where the surface is stretched so that its facets become a hemisphere
    vec3 side;              // two directions that are at right angles to it and to each other
    vec3 up;
    float lean;             // the share of the hemisphere's disc on the eye's side
    float width;            // of the distribution, the square of the roughness
    float hidden_from_eye;  // how many times more facets are hidden than seen
    float padding[3];
};

/// A pixel's surface, and how many samples are drawn each way: by the cosine, by its facets, by the map. 176 bytes, scalar layout.
struct SampledSurface {
    GlossySurface gloss;
    vec3 tangent;      // unit and at right angles, with
    vec3 bitangent;
    vec3 up;           // the shading normal
    vec3 normal;       // geometric
    float cosine;
    float mirrored;
    float map;
    float shift_u;     // of the numbers that samples are drawn by, in [0, 1)
    float shift_v;
    float all;         // samples
    uint is_glossy;    // 0: reflects everything evenly
    uint weighs_alike; // 1: all samples bring their light times pi over their number
};

/// An equirectangular map's texels, or the table of shares by which they are drawn. 28 bytes, scalar layout.
struct MapShape {
    int width;
    int height;
    int first_column_step;  // the greatest power of two that is not more than `width`
    int first_row_step;
    float turn_cosine;      // from the world to the map: about +Y
    float turn_sine;
    float padding;
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::GlossySurface) == 96 && sizeof(sightlines::SampledSurface) == 176);
static_assert(sizeof(sightlines::MapShape) == 28);
#endif

#endif
