// The octahedral map (Cigolle 2014): the sphere of directions unfolded into a square. The upper half (y >= 0) fills the
// diamond in the middle, the lower half the four corners. Without branches, so that the wide compilation keeps all lanes.
#ifndef SIGHTLINES_OCTAHEDRAL_H
#define SIGHTLINES_OCTAHEDRAL_H

#include "portability.h"

KERNEL_BEGIN

/// A place in the square, both in [-1, 1].
struct OctahedralPlace {
    Real u;
    Real v;
};

/// A texel of the square.
struct OctahedralTexel {
    Int column;
    Int row;
};

/// Where a direction lies in the square. It need not have unit length, but must not be zero.
FN OctahedralPlace octahedral_place(Vec3 direction) {
    const Real scale = splat(1.0f) / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    const Real u = direction.x * scale;
    const Real v = direction.z * scale;
    const Real folded_u = splat(1.0f) - abs(v);
    const Real folded_v = splat(1.0f) - abs(u);
    const Mask below = direction.y < splat(0.0f);
    OctahedralPlace place;
    place.u = select(below, select(u < splat(0.0f), -folded_u, folded_u), u);
    place.v = select(below, select(v < splat(0.0f), -folded_v, folded_v), v);
    NOTE("Algorithm 2, line 6", "The ray's direction is projected onto the unit square by the octahedral map.");
    SHOW(direction);
    SHOW(place.u);
    SHOW(place.v);
    return place;
}

/// The texel of a map of size x size that holds a place.
FN OctahedralTexel octahedral_texel(OctahedralPlace place, int size) {
    const Real half_size = splat(0.5f * float(size));
    const Real last = splat(float(size) - 0.5f);
    OctahedralTexel texel;
    texel.column = to_int(min(max(fused(place.u, half_size, half_size), splat(0.0f)), last));
    texel.row = to_int(min(max(fused(place.v, half_size, half_size), splat(0.0f)), last));
    return texel;
}

/// The unit direction that a place stands for.
FN Vec3 octahedral_direction(OctahedralPlace place) {
    const Real height = splat(1.0f) - abs(place.u) - abs(place.v);
    const Real folded = max(-height, splat(0.0f));
    Vec3 direction;
    direction.x = select(place.u < splat(0.0f), place.u + folded, place.u - folded);
    direction.y = height;
    direction.z = select(place.v < splat(0.0f), place.v + folded, place.v - folded);
    const Real squared = fused(direction.z, direction.z, fused(direction.y, direction.y, direction.x * direction.x));
    return direction * (splat(1.0f) / sqrt(squared));
}

KERNEL_END

#endif
