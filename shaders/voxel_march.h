// A shadow ray marched through one voxelization: voxel by voxel (Amanatides and Woo 1987, the "diagonal tracing" of
// Wang 2017, section 6.2), or row by row by the distances to the next occupied voxel of each row (the same section's
// faster opponent).
#ifndef SIGHTLINES_VOXEL_MARCH_H
#define SIGHTLINES_VOXEL_MARCH_H

#include "fetch.h"
#include "lighting.h"
#include "voxel_march_data.h"

KERNEL_BEGIN

/// A segment in voxels of the grid: where it starts, and the way to its end.
struct GridSegment {
    Vec3 start;
    Vec3 extent;
    Mask has_length;   // false: nothing of it lies in the grid, or the offsets leave nothing
};

/// Narrows [enter, leave] (fractions of the segment) to the part with coordinates in [0, cells] along one axis.
FN void narrow_to_cells(float cells, Real start, Real extent, INOUT(Real) enter, INOUT(Real) leave) {
    const Real safe_extent = select(abs(extent) < splat(1.0e-20f), splat(1.0e-20f), extent);
    const Real at_zero = -start / safe_extent;
    const Real at_cells = (splat(cells) - start) / safe_extent;
    enter = max(enter, min(at_zero, at_cells));
    leave = min(leave, max(at_zero, at_cells));
}

/// The part of the segment from the surface to the light that is marched: off the surface along its normal, less the
/// offsets at both ends, inside the grid.
FN GridSegment grid_segment(VoxelGrid grid, Vec3 position, Vec3 normal, Vec3 light) {
    const Vec3 origin = position + normal * splat(grid.normal_offset_m);
    const Vec3 from = origin - splat(grid.lowest);
    const Vec3 way = light - origin;
    GridSegment segment;
    segment.start.x = from.x * splat(grid.voxels_per_metre.x);
    segment.start.y = from.y * splat(grid.voxels_per_metre.y);
    segment.start.z = from.z * splat(grid.voxels_per_metre.z);
    segment.extent.x = way.x * splat(grid.voxels_per_metre.x);
    segment.extent.y = way.y * splat(grid.voxels_per_metre.y);
    segment.extent.z = way.z * splat(grid.voxels_per_metre.z);
    const Real per_voxel = splat(1.0f) / max(sqrt(dot3(segment.extent, segment.extent)), splat(1.0e-6f));
    Real enter = splat(grid.start_offset) * per_voxel;
    Real leave = splat(1.0f) - splat(grid.light_offset) * per_voxel;
    narrow_to_cells(grid.cells_x, segment.start.x, segment.extent.x, enter, leave);
    narrow_to_cells(grid.cells_y, segment.start.y, segment.extent.y, enter, leave);
    narrow_to_cells(grid.cells_z, segment.start.z, segment.extent.z, enter, leave);
    segment.has_length = enter < leave;
    // A march that is not asked still gets a place inside the grid.
    enter = select(segment.has_length, enter, splat(0.0f));
    leave = select(segment.has_length, leave, splat(0.0f));
    segment.start = segment.start + segment.extent * enter;
    segment.extent = segment.extent * (leave - enter);
    NOTE("Algorithm 4, line 6", "The ray runs from the surface, a little off it, to the light; in voxels of the grid.");
    SHOW_SEGMENT("ray", origin, light);
    SHOW(segment.start);
    SHOW(segment.extent);
    return segment;
}

/// The voxel of a coordinate along one axis, kept inside the grid.
FN Int cell_of(float cells, Real coordinate) {
    return to_int(min(max(coordinate, splat(0.0f)), splat(cells - 0.5f)));
}

/// The number of a voxel of the grid.
FN Int voxel_number(VoxelGrid grid, Int x, Int y, Int z) {
    const int margin = 1 + grid.stride_y + grid.stride_z;
    return splat(margin) + x + y * splat(grid.stride_y) + z * splat(grid.stride_z);
}

/// Where along the segment (0 at its start, 1 at its end) it meets the next voxel along an axis; past the end where it
/// does not go that way.
FN Real first_crossing(Real start, Real extent, Int cell) {
    const Real low = start - to_real(cell);
    const Real to_face = select(extent > splat(0.0f), splat(1.0f) - low, low);
    const Real crossing = max(to_face, splat(0.0f)) / max(abs(extent), splat(1.0e-12f));
    return select(abs(extent) > splat(1.0e-12f), crossing, splat(4.0f));
}

/// From one crossing to the next along an axis, as a fraction of the segment.
FN Real crossing_step(Real extent) { return splat(1.0f) / max(abs(extent), splat(1.0e-12f)); }

/// A march on its way: the voxel that it is in, and where it leaves it along each axis.
struct VoxelMarch {
    Int voxel;
    Int stride_x;   // from a voxel to the next, the way the ray goes
    Int stride_y;
    Int stride_z;
    Real next_x;   // where the segment crosses into the next voxel along each axis
    Real next_y;
    Real next_z;
    Real step_x;
    Real step_y;
    Real step_z;
};

FN VoxelMarch begin_voxel_march(VoxelGrid grid, GridSegment segment) {
    const Int x = cell_of(grid.cells_x, segment.start.x);
    const Int y = cell_of(grid.cells_y, segment.start.y);
    const Int z = cell_of(grid.cells_z, segment.start.z);
    VoxelMarch march;
    march.voxel = voxel_number(grid, x, y, z);
    march.stride_x = select(segment.extent.x > splat(0.0f), splat(1), splat(-1));
    march.stride_y = select(segment.extent.y > splat(0.0f), splat(grid.stride_y), splat(-grid.stride_y));
    march.stride_z = select(segment.extent.z > splat(0.0f), splat(grid.stride_z), splat(-grid.stride_z));
    march.next_x = first_crossing(segment.start.x, segment.extent.x, x);
    march.next_y = first_crossing(segment.start.y, segment.extent.y, y);
    march.next_z = first_crossing(segment.start.z, segment.extent.z, z);
    march.step_x = crossing_step(segment.extent.x);
    march.step_y = crossing_step(segment.extent.y);
    march.step_z = crossing_step(segment.extent.z);
    return march;
}

/// Whether the voxel of that number is set in the bits.
FN Mask is_occupied(Words bits, Int voxel) {
    const UInt word = fetch_word(bits, voxel >> 5);
    return (shift_right(word, to_uint(voxel & splat(31))) & splat(1u)) != splat(0u);
}

/// Into the next voxel, where `going`; answers whether the segment gets there.
FN Mask step_voxel(INOUT(VoxelMarch) march, Mask going) {
    const Real next_y_or_z = min(march.next_y, march.next_z);
    const Real nearest = min(march.next_x, next_y_or_z);
    const Mask gets_there = going && !(nearest > splat(1.0f));
    const Mask along_x = !(march.next_x > next_y_or_z);
    const Mask along_y = !along_x && !(march.next_y > march.next_z);
    const Mask along_z = !along_x && !along_y;
    const Int stride = select(along_x, march.stride_x, select(along_y, march.stride_y, march.stride_z));
    march.voxel = select(gets_there, march.voxel + stride, march.voxel);
    march.next_x = select(along_x, march.next_x + march.step_x, march.next_x);
    march.next_y = select(along_y, march.next_y + march.step_y, march.next_y);
    march.next_z = select(along_z, march.next_z + march.step_z, march.next_z);
    return gets_there;
}

/// Whether any voxel from the surface to the light is occupied, for those of `asked`.
FN Mask is_blocked_by_voxels(VoxelGrid grid, Words bits, Vec3 position, Vec3 normal, Vec3 light, Mask asked) {
    const GridSegment segment = grid_segment(grid, position, normal, light);
    VoxelMarch march = begin_voxel_march(grid, segment);
    Mask going = asked && segment.has_length;
    Mask blocked = going && is_occupied(bits, march.voxel);
    NOTE("Amanatides and Woo 1987, initialisation",
         "The voxel of the ray's start is found, and where the ray leaves it.");
    SHOW(march.voxel);
    SHOW(blocked);
    // A blocked lane walks on until all are done: its next voxel need not wait for what this one holds.
    while (any_lane(going && !blocked)) {
        going = step_voxel(march, going);
        const Mask occupied = going && is_occupied(bits, march.voxel);
        NOTE("Wang 2017, section 6.2, diagonal tracing", "One voxel on, across the face that the ray meets first.");
        SHOW(march.voxel);
        SHOW(going);
        SHOW(occupied);
        blocked = blocked || occupied;
    }
    return blocked;
}

/// A march on its way along rows: the row, and where the ray leaves it.
struct RowMarch {
    Int row;        // its number
    Int x;          // the voxel in which the ray enters the row
    Int stride_y;   // from a row to the next, the way the ray goes
    Int stride_z;
    Real next_y;   // where the segment crosses into the next row along y and z
    Real next_z;
    Real step_y;
    Real step_z;
    Real start_x;
    Real extent_x;
    Int table;   // where the distances the ray's way along x begin, in words
};

FN RowMarch begin_row_march(VoxelGrid grid, GridSegment segment) {
    const Int y = cell_of(grid.cells_y, segment.start.y);
    const Int z = cell_of(grid.cells_z, segment.start.z);
    RowMarch march;
    march.row = splat(1 + grid.rows_per_layer) + y + z * splat(grid.rows_per_layer);
    march.x = cell_of(grid.cells_x, segment.start.x);
    march.stride_y = select(segment.extent.y > splat(0.0f), splat(1), splat(-1));
    march.stride_z = select(segment.extent.z > splat(0.0f), splat(grid.rows_per_layer), splat(-grid.rows_per_layer));
    march.next_y = first_crossing(segment.start.y, segment.extent.y, y);
    march.next_z = first_crossing(segment.start.z, segment.extent.z, z);
    march.step_y = crossing_step(segment.extent.y);
    march.step_z = crossing_step(segment.extent.z);
    march.start_x = segment.start.x;
    march.extent_x = segment.extent.x;
    march.table = select(segment.extent.x < splat(0.0f), splat(grid.backward_words), splat(0));
    return march;
}

/// The distance from the ray's voxel to the next occupied one of its row, the ray's way, in voxels; 255: there is none.
FN Int distance_in_row(VoxelGrid grid, Words distances, RowMarch march) {
    const UInt word = fetch_word(distances, march.table + march.row + (march.x >> 2) * splat(grid.rows));
    return to_signed(shift_right(word, to_uint((march.x & splat(3)) << 3)) & splat(255u));
}

/// The voxel of the row in which the ray leaves it.
FN Int last_in_row(VoxelGrid grid, RowMarch march) {
    const Real leaves = min(min(march.next_y, march.next_z), splat(1.0f));
    const Int there = cell_of(grid.cells_x, fused(march.extent_x, leaves, march.start_x));
    // Rounding must not turn the ray round.
    return select(march.extent_x < splat(0.0f), min(there, march.x), max(there, march.x));
}

/// Into the next row, where `going`; answers whether the segment gets there. `x`: where it left this one.
FN Mask step_row(INOUT(RowMarch) march, Int x, Mask going) {
    const Mask gets_there = going && !(min(march.next_y, march.next_z) > splat(1.0f));
    const Mask along_y = !(march.next_y > march.next_z);
    const Int stride = select(along_y, march.stride_y, march.stride_z);
    march.row = select(gets_there, march.row + stride, march.row);
    march.x = x;
    march.next_y = select(along_y, march.next_y + march.step_y, march.next_y);
    march.next_z = select(along_y, march.next_z, march.next_z + march.step_z);
    return gets_there;
}

/// Whether the row holds an occupied voxel between where the ray enters and where it leaves it.
FN Mask is_row_blocked(VoxelGrid grid, Words distances, RowMarch march, Int last) {
    const Int length = max(last - march.x, march.x - last);
    const Int distance = distance_in_row(grid, distances, march);
    SHOW(march.row);
    SHOW(march.x);
    SHOW(last);
    SHOW(distance);
    return !(distance > length) && distance < splat(255);
}

/// Whether any voxel from the surface to the light is occupied, for those of `asked`. `distances`: a byte a voxel,
/// first those along x, then (backward_words on) those against x.
FN Mask is_blocked_by_rows(VoxelGrid grid, Words distances, Vec3 position, Vec3 normal, Vec3 light, Mask asked) {
    const GridSegment segment = grid_segment(grid, position, normal, light);
    RowMarch march = begin_row_march(grid, segment);
    Mask going = asked && segment.has_length;
    Mask blocked = going && !going;
    while (any_lane(going && !blocked)) {
        NOTE("Wang 2017, section 6.2, after Table 7",
             "One row (constant y and z): the voxel where the ray enters it tells how far the next occupied one is.");
        const Int last = last_in_row(grid, march);
        const Mask occupied = going && is_row_blocked(grid, distances, march, last);
        SHOW(occupied);
        blocked = blocked || occupied;
        going = step_row(march, last, going);
    }
    return blocked;
}

KERNEL_END

#endif
