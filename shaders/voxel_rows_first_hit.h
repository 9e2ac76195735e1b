// Where a ray first hits, not only whether: the future work of Wang 2017, section 7. A binary search over the row's
// bits between the ray's ends finds the set voxel that is nearest to the ray's start.
#ifndef SIGHTLINES_VOXEL_ROWS_FIRST_HIT_H
#define SIGHTLINES_VOXEL_ROWS_FIRST_HIT_H

#include "voxel_rows.h"

KERNEL_BEGIN

/// What a ray meets first.
struct RowHit {
    Mask hit;
    Real share;  // of the segment, from its start to the middle of the voxel; 1 where nothing is hit
};

/// The voxel of the span that is set and nearest to its lower end (`forward`) or upper end. One must be set. Halves the
/// span until one voxel is left: the logarithm of the resolution, as many row look-ups.
FN Int nearest_set_voxel(RowShape shape, Rows rows, RowSpan span, Mask forward) {
    Int low = span.first;
    Int high = span.last;
    for (int width = shape.resolution; width > 1; width = (width + 1) / 2) {
        const Int middle = (low + high) >> 1;
        RowSpan nearer;
        nearer.row = span.row;
        nearer.first = select(forward, low, middle + splat(1));
        nearer.last = select(forward, middle, high);
        const Mask in_nearer = span_is_blocked(shape, rows, nearer);
        const Int low_forward = select(in_nearer, low, min(middle + splat(1), high));
        const Int high_forward = select(in_nearer, middle, high);
        const Int low_backward = select(in_nearer, min(middle + splat(1), high), low);
        const Int high_backward = select(in_nearer, high, middle);
        low = select(forward, low_forward, low_backward);
        high = select(forward, high_forward, high_backward);
        NOTE("Section 7, binary search",
             "Is a bit set in the half that is nearer to the ray's start? There it goes on, else in the other.");
        SHOW(in_nearer);
        SHOW(low);
        SHOW(high);
    }
    return low;
}

/// Voxels beyond the ray's end that are looked at: a wall on the bounds, where the ray is clipped, may have set the
/// voxel behind it.
const float beyond_end = 1.0f;

/// The first hit between `origin` (of ray_origin) and `target`, by the row that holds the midpoint of what lies inside
/// the bounds.
FN RowHit first_hit(RowShape shape, FrameTable frames, Rows rows, Vec3 origin, Vec3 target) {
    Vec3 a = origin;
    Vec3 b = target;
    clip_to_bounds(shape, a, b);
    const Direction direction = discretize_direction(shape, target - origin);
    const Frame frame = load_frame(frames, frame_index(shape, direction));
    RowSpan span = locate_span(shape, frame, direction, a, b, shape.start_offset, -beyond_end);
    span.row = stored_row(shape, rows, span.row);
    RowHit found;
    found.hit = span_is_blocked(shape, rows, span);
    const Vec3 centre = splat(shape.centre);
    const Real at_origin = along(shape, frame.u, origin - centre);
    const Real extent = along(shape, frame.u, target - centre) - at_origin;
    const Int voxel = nearest_set_voxel(shape, rows, span, extent > splat(0.0f));
    const Real share = (to_real(voxel) + splat(0.5f) - at_origin) / extent;
    found.share = select(found.hit, min(max(share, splat(0.0f)), splat(1.0f)), splat(1.0f));
    NOTE("Section 7, distance", "The voxel's middle along the row, as a part of the ray.");
    SHOW(found.hit);
    SHOW(found.share);
    return found;
}

KERNEL_END

#endif
