// Whether a shadow ray meets a triangle (Moeller and Trumbore 1997). Recorded, so that the ray debugger has something
// to show of brute force: what Embree itself does cannot be seen.
#ifndef SIGHTLINES_RAY_TRIANGLE_H
#define SIGHTLINES_RAY_TRIANGLE_H

#include "lighting.h"

KERNEL_BEGIN

FN Vec3 cross3(Vec3 a, Vec3 b) {
    Vec3 result;
    result.x = a.y * b.z - a.z * b.y;
    result.y = a.z * b.x - a.x * b.z;
    result.z = a.x * b.y - a.y * b.x;
    return result;
}

/// Whether the segment from `start` to `end` meets the triangle of the three corners, strictly between its ends.
FN Mask meets_triangle(Vec3 start, Vec3 end, Vec3 corner_a, Vec3 corner_b, Vec3 corner_c) {
    const Vec3 along_ray = end - start;
    const Vec3 edge_b = corner_b - corner_a;
    const Vec3 edge_c = corner_c - corner_a;
    const Vec3 across = cross3(along_ray, edge_c);
    const Real determinant = dot3(edge_b, across);
    NOTE("Moeller and Trumbore 1997, determinant",
         "How squarely the ray meets the triangle; zero where it runs along.");
    SHOW(corner_a);
    SHOW(corner_b);
    SHOW(corner_c);
    SHOW(determinant);
    const Real reciprocal = splat(1.0f) / select(abs(determinant) > splat(0.0f), determinant, splat(1.0e-30f));
    const Vec3 from_corner = start - corner_a;
    const Vec3 sideways = cross3(from_corner, edge_b);
    const Real u = dot3(from_corner, across) * reciprocal;
    const Real v = dot3(along_ray, sideways) * reciprocal;
    const Real share = dot3(edge_c, sideways) * reciprocal;
    const Mask inside = !(u < splat(0.0f)) && !(v < splat(0.0f)) && !(u + v > splat(1.0f));
    const Mask between = share > splat(0.0f) && share < splat(1.0f);
    NOTE("Moeller and Trumbore 1997, intersection",
         "Where the ray meets the triangle's plane: inside it, and between the ends?");
    SHOW(u);
    SHOW(v);
    SHOW(share);
    SHOW(inside);
    SHOW(between);
    return inside && between;
}

KERNEL_END

#endif
