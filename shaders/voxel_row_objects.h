// A shadow ray among objects that move rigidly: each type of object has an array of its own, which is asked in the
// frame of each instance. Wang 2017, Algorithm 5, lines 4 to 10.
#ifndef SIGHTLINES_VOXEL_ROW_OBJECTS_H
#define SIGHTLINES_VOXEL_ROW_OBJECTS_H

#include "voxel_rows.h"

#include "voxel_row_objects_data.h"

KERNEL_BEGIN

#ifdef __cplusplus
BUFFER_REF(ObjectTable, ObjectInstance);
FN FrameTable frames_of(ObjectInstance object) { return {reinterpret_cast<const DirectionFrame*>(object.frames)}; }
FN Rows rows_of(ObjectInstance object) { return {reinterpret_cast<const uint*>(object.rows)}; }
#else
FN FrameTable frames_of(ObjectInstance object) { return object.frames; }
FN Rows rows_of(ObjectInstance object) { return object.rows; }
#endif

FN Real object_coordinate(vec3 axis, float shift, Vec3 point) {
    return fused(splat(axis.z), point.z, fused(splat(axis.y), point.y, fused(splat(axis.x), point.x, splat(shift))));
}

/// A point of the world in the object's own frame.
FN Vec3 to_object(ObjectInstance object, Vec3 point) {
    Vec3 own;
    own.x = object_coordinate(object.axis_x, object.shift.x, point);
    own.y = object_coordinate(object.axis_y, object.shift.y, point);
    own.z = object_coordinate(object.axis_z, object.shift.z, point);
    return own;
}

/// Whether the segment a b meets a box, from whose centre both are given: neither an axis of the box nor one across it
/// and the segment parts them. Without a division, because most rays miss most objects.
FN Mask meets_box(Vec3 half_size, Vec3 a, Vec3 b) {
    const Vec3 middle = (a + b) * splat(0.5f);
    const Vec3 reach = (b - a) * splat(0.5f);
    const Real x = abs(reach.x);
    const Real y = abs(reach.y);
    const Real z = abs(reach.z);
    const Mask beside =
        abs(middle.x) > half_size.x + x || abs(middle.y) > half_size.y + y || abs(middle.z) > half_size.z + z;
    const Real across_x = fused(middle.y, reach.z, -(middle.z * reach.y));
    const Real across_y = fused(middle.z, reach.x, -(middle.x * reach.z));
    const Real across_z = fused(middle.x, reach.y, -(middle.y * reach.x));
    const Mask past = abs(across_x) > fused(half_size.y, z, half_size.z * y) ||
                      abs(across_y) > fused(half_size.z, x, half_size.x * z) ||
                      abs(across_z) > fused(half_size.x, y, half_size.y * x);
    return !(beside || past);
}

/// The same for the bounds of an array.
FN Mask meets_bounds(RowShape shape, Vec3 a, Vec3 b) {
    return meets_box(splat(shape.half_size), a - splat(shape.centre), b - splat(shape.centre));
}

/// How far a box in the world reaches along an axis of the object's frame, to each side of its centre.
FN Real width_along(vec3 axis, Vec3 half_size) {
    return fused(abs(splat(axis.z)), half_size.z,
                 fused(abs(splat(axis.y)), half_size.y, abs(splat(axis.x)) * half_size.x));
}

/// Whether any of the rays to `target` from surfaces in a box in the world may meet the object: only where the ray from
/// the box's centre meets the object's bounds made wider by the box. Sorts out most rays before they are looked at.
FN Mask may_meet(ObjectInstance object, Vec3 centre, Vec3 half_size, Vec3 target) {
    const Real off_surface = splat(object.query.normal_offset_m);
    Vec3 wider = half_size;
    wider.x = wider.x + off_surface;
    wider.y = wider.y + off_surface;
    wider.z = wider.z + off_surface;
    Vec3 bounds = splat(object.query.half_size);
    bounds.x = bounds.x + width_along(object.axis_x, wider);
    bounds.y = bounds.y + width_along(object.axis_y, wider);
    bounds.z = bounds.z + width_along(object.axis_z, wider);
    const Vec3 middle = splat(object.query.centre);
    return meets_box(bounds, to_object(object, centre) - middle, to_object(object, target) - middle);
}

/// Cuts the segment a b to what the object's array is asked for: inside its bounds, and away from the ray's ends by the
/// offsets, which count voxels along the row. The ends of a ray are mostly outside the bounds: cut there first, the
/// offsets would take the object's own voxels off. Returns whether anything is left.
FN Mask clip_to_object(RowShape shape, Frame frame, INOUT(Vec3) a, INOUT(Vec3) b) {
    const Vec3 along_ray = b - a;
    const Real voxels = max(abs(dot3(frame.u, along_ray)), splat(1.0e-6f));
    Real enter = splat(shape.start_offset) / voxels;
    Real leave = splat(1.0f) - splat(shape.light_offset) / voxels;
    clip_to_slab(shape.centre.x, shape.half_size.x, a.x, along_ray.x, enter, leave);
    clip_to_slab(shape.centre.y, shape.half_size.y, a.y, along_ray.y, enter, leave);
    clip_to_slab(shape.centre.z, shape.half_size.z, a.z, along_ray.z, enter, leave);
    const Mask left = !(enter > leave);
    b = a + along_ray * leave;
    a = a + along_ray * enter;
    NOTE("Algorithm 5, line 7", "The ray is cut to the object's bounds and, by the offsets, at its own ends.");
    SHOW(enter);
    SHOW(leave);
    SHOW(left);
    SHOW_SEGMENT("ray", a, b);
    return left;
}

/// What locates a cut ray in the object's array: the offsets are taken off already.
FN RowShape shape_of_cut(RowShape shape) {
    RowShape cut = shape;
    cut.start_offset = 0.0f;
    cut.light_offset = 0.0f;
    return cut;
}

/// Algorithm 3 in the object's own frame: whether the object is in the way between a and b.
FN Mask array_blocks(ObjectInstance object, Vec3 a, Vec3 b) {
    const RowShape shape = object.query;
    const Direction direction = discretize_direction(shape, b - a);
    const Frame frame = load_frame(frames_of(object), frame_index(shape, direction));
    const Mask left = clip_to_object(shape, frame, a, b);
    if (!any_lane(left)) return left;
    const RowShape cut = shape_of_cut(shape);
    Mask blocked = part_is_blocked(cut, frame, rows_of(object), direction, a, b, 0);
    if (shape.subrays == 2) {
        blocked = part_is_blocked(cut, frame, rows_of(object), direction, a, b, 1) || blocked;
    }
    return blocked && left;
}

/// Whether the object is in the way from a surface to `target`, all in the world.
FN Mask object_blocks(ObjectInstance object, Vec3 position, Vec3 normal, Vec3 target) {
    const Vec3 a = to_object(object, ray_origin(object.query, position, normal));
    const Vec3 b = to_object(object, target);
    NOTE("Algorithm 5, line 5", "The ray is taken into the object's own frame.");
    SHOW_SEGMENT("ray", a, b);
    const Mask met = meets_bounds(object.query, a, b);
    NOTE("Algorithm 5, line 6", "The array of the object's type is asked where the ray meets its bounds.");
    SHOW(object.type);
    SHOW(met);
    if (!any_lane(met)) return met;
    return array_blocks(object, a, b) && met;
}

/// Algorithm 5, lines 4 to 10: whether any of the objects is in the way of a ray that passes what stands still.
FN Mask objects_block(ObjectTable objects, int count, Vec3 position, Vec3 normal, Vec3 target) {
    Mask blocked = splat(0.0f) > splat(0.0f);
    for (int instance = 0; instance < count; ++instance) {
        NOTE("Algorithm 5, line 4", "Each moving object is asked, one after the other, until one is in the way.");
        SHOW(instance);
        blocked = object_blocks(objects.v[instance], position, normal, target) || blocked;
        if (!any_lane(!blocked)) return blocked;
    }
    return blocked;
}

KERNEL_END

#endif
