// What the window's picture shader is told of one picture.
#ifndef SIGHTLINES_WINDOW_PICTURE_DATA_H
#define SIGHTLINES_WINDOW_PICTURE_DATA_H

#include "portability.h"

SHARED_BEGIN

/// The push constants: 32 bytes, scalar layout.
struct PictureQuad {
    float corner_x, corner_y;   // the first corner in clip space
    float size_x, size_y;       // to the opposite corner
    float corner_u, corner_v;   // the part of the picture that is shown
    float size_u, size_v;
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::PictureQuad) == 32);
#endif

#endif
