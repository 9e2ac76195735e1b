// A row of bits as a strip of cells, the verdict, and the angle drawn wide enough to see: the flat part of the figure.
#pragma once

#include "visualizers/canvas.h"
#include "visualizers/view_state.h"
#include "visualizers/voxel_row_picture.h"

namespace sightlines {

/// The N bits of the row as cells in `where`: set ones filled, clear ones open, those outside [first, last] small and
/// grey; 0 and 1 are written into cells that are wide enough. s and e stand above, the ray runs along the top with the
/// surface point and the light at its ends, indices stand below. Uses 2.4 text heights above and 1.4 below `where`.
void draw_bit_strip(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, const Rectangle& where,
                    float text_height);

/// "BLOCKED 1 of 55 voxels looked at is set. Embree agrees.", from `at` to the right, in fewer words where `width` is
/// too small; gives the width used.
float draw_verdict(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, vec2 at, float width,
                   float text_height);

/// Ray and twin as a wedge in `where`, opened `by` a round factor where the angle is too small to see, and said so.
void draw_angle_wedge(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, const Rectangle& where,
                      float text_height);

}  // namespace sightlines
