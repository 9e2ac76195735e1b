// A shadow ray answered by a shadow map: a conventional one (Williams 1978; a cube of them for a point light) or an
// imperfect one (Ritschel 2008; two paraboloids).
#ifndef SIGHTLINES_SHADOW_MAP_H
#define SIGHTLINES_SHADOW_MAP_H

#include "fetch.h"
#include "lighting.h"
#include "shadow_map_data.h"

KERNEL_BEGIN

/// Where a point lies in the maps of a light.
struct MapPlace {
    Int map;         // which of the light's maps
    Real x;          // texels from the map's corner
    Real y;
    Real nearness;   // greater is nearer to the light
};

/// In the one map of a directional light.
FN MapPlace orthographic_place(ShadowMapShape shape, Vec3 from_light) {
    const Real middle = splat(0.5f * float(shape.resolution));
    MapPlace place;
    place.map = splat(0);
    place.x = dot3(splat(shape.axis_u), from_light) + middle;
    place.y = dot3(splat(shape.axis_v), from_light) + middle;
    place.nearness = splat(shape.reach_m) - dot3(splat(shape.axis_depth), from_light);
    return place;
}

/// In the cube of a point light. Face 2 a looks along axis a, face 2 a + 1 against it; x runs along the next axis and
/// y along the one after that, whichever way the face looks.
FN MapPlace cube_place(ShadowMapShape shape, Vec3 from_light) {
    const Real size_x = abs(from_light.x);
    const Real size_y = abs(from_light.y);
    const Real size_z = abs(from_light.z);
    const Mask is_x = !(size_x < size_y) && !(size_x < size_z);
    const Mask is_y = !is_x && !(size_y < size_z);
    const Real major = select(is_x, from_light.x, select(is_y, from_light.y, from_light.z));
    const Real along_x = select(is_x, from_light.y, select(is_y, from_light.z, from_light.x));
    const Real along_y = select(is_x, from_light.z, select(is_y, from_light.x, from_light.y));
    const Real half_size = splat(0.5f * float(shape.resolution));
    MapPlace place;
    place.nearness = splat(1.0f) / max(abs(major), splat(1.0e-12f));
    place.map = select(is_x, splat(0), select(is_y, splat(2), splat(4))) +
                select(major < splat(0.0f), splat(1), splat(0));
    place.x = fused(along_x * place.nearness, half_size, half_size);
    place.y = fused(along_y * place.nearness, half_size, half_size);
    return place;
}

/// In the two paraboloids of a point light: map 0 looks up, map 1 down.
FN MapPlace paraboloid_place(ShadowMapShape shape, Vec3 from_light) {
    const Real distance = max(sqrt(dot3(from_light, from_light)), splat(1.0e-12f));
    const Real scale = splat(0.5f * float(shape.resolution)) / (distance + abs(from_light.y));
    const Real half_size = splat(0.5f * float(shape.resolution));
    MapPlace place;
    place.nearness = splat(1.0f) / distance;
    place.map = select(from_light.y < splat(0.0f), splat(1), splat(0));
    place.x = fused(from_light.x, scale, half_size);
    place.y = fused(from_light.z, scale, half_size);
    return place;
}

/// The texel of a coordinate, kept inside the map.
FN Int texel_index(ShadowMapShape shape, Real coordinate) {
    return to_int(min(max(coordinate, splat(0.0f)), splat(float(shape.resolution) - 0.5f)));
}

/// Whether what the map holds at a place is nearer to the light than `needed`.
FN Mask is_hidden(ShadowMapShape shape, Reals maps, MapPlace place, Real needed) {
    const Int column = texel_index(shape, place.x);
    const Int line = texel_index(shape, place.y);
    const Real held = fetch_real(maps, place.map * splat(shape.map_pitch) + line * splat(shape.pitch) + column);
    NOTE("Williams 1978: compare",
         "The map's texel holds the surface nearest to the light; is it nearer than the point?");
    SHOW(place.map);
    SHOW(column);
    SHOW(line);
    SHOW(held);
    SHOW(needed);
    return held > needed;
}

/// Where a surface point, moved a little off its surface, lies in the cube of a point or spot light.
FN MapPlace looked_up_in_cube(ShadowMapShape shape, Vec3 position, Vec3 normal) {
    const Vec3 from_light = position - splat(shape.light);
    const Real depth = max(max(abs(from_light.x), abs(from_light.y)), abs(from_light.z));
    const Real texel_m = depth * splat(2.0f / float(shape.resolution));
    const MapPlace place = cube_place(shape, from_light + normal * (texel_m * splat(shape.normal_offset)));
    NOTE("Williams 1978: look up",
         "The point, a little off its surface, is seen from the light: a face of the cube, a texel, a depth.");
    SHOW(depth);
    SHOW(texel_m);
    SHOW(place.map);
    SHOW(place.x);
    SHOW(place.y);
    SHOW(place.nearness);
    return place;
}

/// The same in the one map of a directional light.
FN MapPlace looked_up_in_direction(ShadowMapShape shape, Vec3 position, Vec3 normal) {
    const Vec3 point = position + normal * splat(shape.normal_offset * (shape.texel_m + shape.blur_m));
    const MapPlace place = orthographic_place(shape, point - splat(shape.light));
    NOTE("Williams 1978: look up", "The point, a little off its surface, is seen from the light: a texel and a depth.");
    SHOW(place.x);
    SHOW(place.y);
    SHOW(place.nearness);
    return place;
}

FN MapPlace looked_up_place(ShadowMapShape shape, Vec3 position, Vec3 normal) {
    if (shape.directional != 0) return looked_up_in_direction(shape, position, normal);
    return looked_up_in_cube(shape, position, normal);
}

/// Whether the light does not see the surface point: conventional maps.
FN Mask is_in_shadow(ShadowMapShape shape, Reals maps, Vec3 position, Vec3 normal) {
    const MapPlace place = looked_up_place(shape, position, normal);
    if (shape.directional != 0)
        return is_hidden(shape, maps, place, place.nearness + splat(shape.depth_bias * shape.texel_m));
    const float bias = 2.0f * shape.depth_bias / float(shape.resolution);
    return is_hidden(shape, maps, place, place.nearness * splat(1.0f / max(1.0f - bias, 0.01f)));
}

/// Whether the point is hidden from a point or spot light, by its two paraboloids.
FN Mask is_hidden_in_paraboloids(ShadowMapShape shape, Reals maps, Vec3 position, Vec3 normal) {
    const Vec3 from_light = position - splat(shape.light);
    const Real distance = sqrt(dot3(from_light, from_light));
    // In the middle of a paraboloid a texel spans 4 / resolution of the distance, at its rim half of that.
    const Real texel_m = fused(distance, splat(4.0f / float(shape.resolution)), splat(shape.blur_m));
    const Vec3 point = from_light + normal * (texel_m * splat(shape.normal_offset));
    const MapPlace place = paraboloid_place(shape, point);
    NOTE("Ritschel 2008: look up",
         "The point, a little off its surface, is seen from the light: one of two paraboloids, a texel, a distance.");
    SHOW(distance);
    SHOW(texel_m);
    SHOW(place.map);
    SHOW(place.x);
    SHOW(place.y);
    SHOW(place.nearness);
    const Real blocker_distance = splat(1.0f) / place.nearness - texel_m * splat(shape.depth_bias);
    return is_hidden(shape, maps, place, splat(1.0f) / max(blocker_distance, splat(1.0e-12f)));
}

/// Whether the light does not see the surface point: imperfect maps.
FN Mask is_in_imperfect_shadow(ShadowMapShape shape, Reals maps, Vec3 position, Vec3 normal) {
    if (shape.directional == 0) return is_hidden_in_paraboloids(shape, maps, position, normal);
    const MapPlace place = looked_up_in_direction(shape, position, normal);
    const float bias_m = shape.depth_bias * (shape.texel_m + shape.blur_m);
    return is_hidden(shape, maps, place, place.nearness + splat(bias_m));
}

KERNEL_END

#endif
