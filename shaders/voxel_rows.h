// A shadow ray answered by one row of bits: Wang 2017, Algorithm 3.
#ifndef SIGHTLINES_VOXEL_ROWS_H
#define SIGHTLINES_VOXEL_ROWS_H

#include "lighting.h"
#include "voxel_rows_data.h"
#include "voxel_rows_memory.h"

KERNEL_BEGIN

/// Where the answer to one ray (or half of it) lies: a row (first of the array, then as it is stored), and the voxels of
/// it that the ray passes.
struct RowSpan {
    UInt row;
    Int first;   // voxels first .. last, inclusive; first > last: nothing to look at
    Int last;
};

/// The angle of (x, y) from the positive x axis for y >= 0, in [0, pi], given `ratio` = min(|x|, y) / max(|x|, y).
/// Abramowitz and Stegun 4.4.49 (error 1e-5 rad: a thousandth of the narrowest half step), so that every backend rounds
/// a direction alike.
FN Real angle_above(Real y, Real x, Real ratio) {
    const Real squared = ratio * ratio;
    Real series = fused(squared, splat(0.0208351f), splat(-0.0851330f));
    series = fused(series, squared, splat(0.1801410f));
    series = fused(series, squared, splat(-0.3302995f));
    series = fused(series, squared, splat(0.9998660f)) * ratio;
    const Real quadrant = select(y > abs(x), splat(1.57079633f) - series, series);
    return select(x < splat(0.0f), splat(3.14159265f) - quadrant, quadrant);
}

/// A direction of the array: its steps of theta and of phi.
struct Direction {
    Int theta;
    Int phi;
};

/// Its place in the table of frames.
FN Int frame_index(RowShape shape, Direction direction) { return direction.theta * splat(shape.angles) + direction.phi; }

FN float steps_per_radian(RowShape shape) { return float(shape.angles) * 0.318309886f; }

/// The direction of the array nearest to a line. Lines have no sign, so theta and phi stay below
/// 180 degrees: d(theta, phi) = cos(phi) Y + sin(phi) (cos(theta) X + sin(theta) Z).
FN Direction discretize_direction(RowShape shape, Vec3 along_line) {
    const Mask flipped = along_line.z < splat(0.0f);
    const Real x = select(flipped, -along_line.x, along_line.x);
    const Real y = select(flipped, -along_line.y, along_line.y);
    const Real z = abs(along_line.z);
    const Real horizontal = sqrt(fused(z, z, x * x));
    // Both ratios by one division: a / b = a d / (b d).
    const Real theta_longer = max(max(abs(x), z), splat(1.0e-18f));
    const Real phi_longer = max(max(abs(y), horizontal), splat(1.0e-18f));
    const Real reciprocal = splat(1.0f) / (theta_longer * phi_longer);
    const Real theta = angle_above(z, x, min(abs(x), z) * phi_longer * reciprocal);
    const Real phi = angle_above(horizontal, y, min(abs(y), horizontal) * theta_longer * reciprocal);
    Int theta_step = to_int(fused(theta, splat(steps_per_radian(shape)), splat(0.5f)));
    Int phi_step = to_int(fused(phi, splat(steps_per_radian(shape)), splat(0.5f)));
    // d(180, phi) = -d(0, 180 - phi), and d(theta, 180) = -d(theta, 0): the same lines.
    const Mask past_theta = theta_step == splat(shape.angles);
    phi_step = select(past_theta, splat(shape.angles) - phi_step, phi_step);
    theta_step = select(past_theta, splat(0), theta_step);
    phi_step = select(phi_step == splat(shape.angles), splat(0), phi_step);
    NOTE("Algorithm 3, line 1", "The ray's direction is rounded to the nearest pair of angles of the array.");
    SHOW(theta);
    SHOW(phi);
    SHOW(theta_step);
    SHOW(phi_step);
    Direction direction;
    direction.theta = theta_step;
    direction.phi = phi_step;
    return direction;
}

/// The voxel coordinate of a point, given from the centre of the bounds, along an axis of a frame.
FN Real along(RowShape shape, Vec3 axis, Vec3 point) {
    const Real middle = splat(0.5f * float(shape.resolution));
    return fused(axis.z, point.z, fused(axis.y, point.y, fused(axis.x, point.x, middle)));
}

/// The same along the level axis v.
FN Real along_level(RowShape shape, Frame frame, Vec3 point) {
    return fused(frame.v_z, point.z, fused(frame.v_x, point.x, splat(0.5f * float(shape.resolution))));
}

/// The index of a coordinate's voxel, kept inside the grid.
FN Int voxel_index(RowShape shape, Real coordinate) {
    return to_int(min(max(coordinate, splat(0.0f)), splat(float(shape.resolution) - 0.5f)));
}

/// Where a row lies in memory, counted in rows. Rays that are asked together want neighbouring directions and rows, so
/// these lie together: in blocks of 2 x 2 directions by 8 x 8 rows (4 KiB at 128 bits).
FN UInt row_index(RowShape shape, Direction direction, Int v, Int w) {
    const int blocks = (shape.resolution + 7) / 8;
    const Int one = splat(1);
    const Int seven = splat(7);
    const Int directions = (direction.theta >> 1) * splat(shape.angles / 2) + (direction.phi >> 1);
    const Int block = (directions * splat(blocks) + (v >> 3)) * splat(blocks) + (w >> 3);
    const Int which_direction = ((direction.theta & one) << 1) | (direction.phi & one);
    return to_uint((block << 8) | (which_direction << 6) | ((v & seven) << 3) | (w & seven));
}

/// The row that holds the midpoint of the segment a b, and the voxels between its ends. `start_offset` and
/// `light_offset` (voxels) are taken off at a and at b.
FN RowSpan locate_span(RowShape shape, Frame frame, Direction direction, Vec3 a, Vec3 b, float start_offset,
                       float light_offset) {
    RowSpan span;
    const Vec3 midpoint = (a + b) * splat(0.5f);
    const Vec3 centre = splat(shape.centre);
    const Int v = voxel_index(shape, along_level(shape, frame, midpoint - centre));
    const Int w = voxel_index(shape, along(shape, frame.w, midpoint - centre));
    span.row = row_index(shape, direction, v, w);
    NOTE("Algorithm 3, line 3", "The row that holds the ray's midpoint stands for the whole ray.");
    SHOW_POINT(midpoint);
    SHOW(v);
    SHOW(w);
    const Real at_a = along(shape, frame.u, a - centre);
    const Real at_b = along(shape, frame.u, b - centre);
    const Mask forward = at_b > at_a;
    const Real low = select(forward, at_a + splat(start_offset), at_b + splat(light_offset));
    const Real high = select(forward, at_b - splat(light_offset), at_a - splat(start_offset));
    // Clamped one voxel outside the row, where the conversion to integers is safe and no bit is left.
    const float row_end = float(shape.resolution);
    span.first = to_int(min(max(low, splat(0.0f)), splat(row_end)));
    span.last = to_int(min(max(high, splat(-1.0f)) + splat(1.0f), splat(row_end))) - splat(1);
    NOTE("Algorithm 3, line 4", "The ray's ends, less the offsets, give the extent [s, e] of voxels along the row.");
    SHOW(at_a);
    SHOW(at_b);
    SHOW(span.first);
    SHOW(span.last);
    return span;
}

/// Which of the stored rows holds a row's bits: itself, or a row of the dictionary where the array is compressed.
FN UInt stored_row(RowShape shape, Rows rows, UInt row) {
    if (shape.index_bits == 0) return row;
    const UInt index = load_index(rows, shape, row);
    NOTE("Algorithm 3, line 3", "The row's index in the dictionary: the array holds only that, the dictionary the bits.");
    SHOW(row);
    SHOW(index);
    return index;
}

/// The bits of one word of a row that lie in first .. last.
FN UInt kept_bits(UInt word, int word_index, Int first, Int last) {
    const int lowest = 32 * word_index;
    const UInt below = to_uint(max(first - splat(lowest), splat(0)));
    const UInt above = to_uint(max(splat(lowest + 31) - last, splat(0)));
    return word & shift_left(splat(0xffffffffu), below) & shift_right(splat(0xffffffffu), above);
}

/// Whether any voxel of the span is set. Its row is a stored one.
FN Mask span_is_blocked(RowShape shape, Rows rows, RowSpan span) {
    UInt clipped = splat(0u);
    NOTE("Algorithm 3, lines 5 to 7", "The row's bits outside the extent are cleared; any bit left blocks the ray.");
    SHOW(span.row);
    if (shape.words_per_row < 4) {
        for (int word = 0; word < shape.words_per_row; ++word) {
            const UInt bits = load_word(rows, shape, span.row, word);
            clipped = clipped | kept_bits(bits, word, span.first, span.last);
            SHOW_BITS("row", bits);
            SHOW_BITS("clipped", kept_bits(bits, word, span.first, span.last));
        }
    }
    for (int word = 0; word + 4 <= shape.words_per_row; word += 4) {
        const FourWords bits = load_four_words(rows, shape, span.row, word);
        const UInt x = kept_bits(bits.x, word, span.first, span.last);
        const UInt y = kept_bits(bits.y, word + 1, span.first, span.last);
        const UInt z = kept_bits(bits.z, word + 2, span.first, span.last);
        const UInt w = kept_bits(bits.w, word + 3, span.first, span.last);
        clipped = clipped | x | y | z | w;
        SHOW_BITS("row", bits.x);
        SHOW_BITS("row", bits.y);
        SHOW_BITS("row", bits.z);
        SHOW_BITS("row", bits.w);
        SHOW_BITS("clipped", x);
        SHOW_BITS("clipped", y);
        SHOW_BITS("clipped", z);
        SHOW_BITS("clipped", w);
    }
    const Mask blocked = clipped != splat(0u);
    SHOW(blocked);
    return blocked;
}

/// Narrows [enter, leave] (fractions of the ray) to the part between the planes centre - half and centre + half.
FN void clip_to_slab(float centre, float half_size, Real start, Real extent, INOUT(Real) enter, INOUT(Real) leave) {
    const Real safe_extent = select(abs(extent) < splat(1.0e-20f), splat(1.0e-20f), extent);
    const Real at_low = (splat(centre - half_size) - start) / safe_extent;
    const Real at_high = (splat(centre + half_size) - start) / safe_extent;
    enter = max(enter, min(at_low, at_high));
    leave = min(leave, max(at_low, at_high));
}

/// The part of the segment a b inside the bounds, so that its midpoint lies in the voxelization.
FN void clip_to_bounds(RowShape shape, INOUT(Vec3) a, INOUT(Vec3) b) {
    const Vec3 along_ray = b - a;
    Real enter = splat(0.0f);
    Real leave = splat(1.0f);
    clip_to_slab(shape.centre.x, shape.half_size.x, a.x, along_ray.x, enter, leave);
    clip_to_slab(shape.centre.y, shape.half_size.y, a.y, along_ray.y, enter, leave);
    clip_to_slab(shape.centre.z, shape.half_size.z, a.z, along_ray.z, enter, leave);
    enter = min(enter, splat(1.0f));
    leave = max(leave, enter);
    b = a + along_ray * leave;
    a = a + along_ray * enter;
}

/// Where the ray starts: off the surface, out of the voxels that the surface itself fills.
FN Vec3 ray_origin(RowShape shape, Vec3 position, Vec3 normal) {
    return position + normal * splat(shape.normal_offset_m);
}

/// Where the answer to part `part` of the ray from a to b lies: to all of it, or, where each half has a row of its own
/// (subrays is 2), to the half at a (0) or at b (1).
FN RowSpan locate_part(RowShape shape, Frame frame, Direction direction, Vec3 a, Vec3 b, int part) {
    if (shape.subrays == 1) return locate_span(shape, frame, direction, a, b, shape.start_offset, shape.light_offset);
    const Vec3 middle = (a + b) * splat(0.5f);
    if (part == 0) return locate_span(shape, frame, direction, a, middle, shape.start_offset, 0.0f);
    return locate_span(shape, frame, direction, middle, b, 0.0f, shape.light_offset);
}

/// Whether anything is in the way of part `part` of the ray.
FN Mask part_is_blocked(RowShape shape, Frame frame, Rows rows, Direction direction, Vec3 a, Vec3 b, int part) {
    RowSpan span = locate_part(shape, frame, direction, a, b, part);
    span.row = stored_row(shape, rows, span.row);
    return span_is_blocked(shape, rows, span);
}

/// Algorithm 3: whether the scene is in the way between `origin` (of ray_origin) and `target`.
FN Mask is_blocked(RowShape shape, FrameTable frames, Rows rows, Vec3 origin, Vec3 target) {
    Vec3 a = origin;
    Vec3 b = target;
    if (shape.clip_to_bounds != 0) clip_to_bounds(shape, a, b);
    NOTE("Algorithm 4, line 6", "The ray runs from the surface, a little off it, to the light.");
    SHOW_SEGMENT("ray", a, b);
    const Direction direction = discretize_direction(shape, b - a);
    NOTE("Algorithm 3, line 2", "The voxelization whose rows run in that direction is chosen.");
    SHOW(direction.theta);
    SHOW(direction.phi);
    const Frame frame = load_frame(frames, frame_index(shape, direction));
    Mask blocked = part_is_blocked(shape, frame, rows, direction, a, b, 0);
    if (shape.subrays == 2) {
        blocked = part_is_blocked(shape, frame, rows, direction, a, b, 1) || blocked;
    }
    return blocked;
}

KERNEL_END

#endif
