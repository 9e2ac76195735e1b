// A discrete visibility field as the kernels see it (Xu 2022, section 3.1).
#ifndef SIGHTLINES_VISIBILITY_FIELD_DATA_H
#define SIGHTLINES_VISIBILITY_FIELD_DATA_H

#include "portability.h"

SHARED_BEGIN

/// Bricks are 4 x 4 x 4 cells.
const int brick_side = 4;

/// What a lookup must know of the grid. 48 bytes, scalar layout.
struct FieldShape {
    vec3 origin;          // the grid's lowest corner, m
    float cell_m;         // a cell's side
    int cells_x;
    int cells_y;
    int cells_z;
    int bricks_x;
    int bricks_y;
    int mask_size;        // texels along a side of each octahedral mask
    int words_per_mask;   // a bit a texel, row by row
    float nudge_m;        // a surface point is looked up so far above its surface, so that one in a cell's face has a side
};

/// Which cells of a brick hold masks, and on which side each is decided. Bit x + 4 y + 16 z of the two words. Its cells
/// follow each other from number `first_cell` on. 20 bytes, scalar layout.
struct FieldBrick {
    uint first_cell;
    uint occupied_low;
    uint occupied_high;
    uint label_low;
    uint label_high;
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(sightlines::FieldShape) == 48 && sizeof(sightlines::FieldBrick) == 20);
#endif

#endif
