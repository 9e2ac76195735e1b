// Directions over the hemisphere about a normal.
#ifndef SIGHTLINES_HEMISPHERE_H
#define SIGHTLINES_HEMISPHERE_H

#include "portability.h"

KERNEL_BEGIN

/// Three unit vectors at right angles. The normal points to the middle of the hemisphere.
struct HemisphereFrame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

/// A frame about a unit normal (Duff 2017), turned about it by the angle of which cosine and sine are given.
FN HemisphereFrame frame_about(vec3 normal, float cosine, float sine) {
    const float side = normal.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (side + normal.z);
    const float b = normal.x * normal.y * a;
    const vec3 tangent = vec3(1.0f + side * normal.x * normal.x * a, side * b, -side * normal.x);
    const vec3 bitangent = vec3(b, side + normal.y * normal.y * a, -normal.y);
    HemisphereFrame frame;
    frame.tangent = tangent * cosine + bitangent * sine;
    frame.bitangent = bitangent * cosine - tangent * sine;
    frame.normal = normal;
    return frame;
}

/// x tangent + y bitangent + z normal.
FN Vec3 direction_in(HemisphereFrame frame, Real x, Real y, Real z) {
    Vec3 direction;
    direction.x = fused(z, splat(frame.normal.x), fused(y, splat(frame.bitangent.x), x * splat(frame.tangent.x)));
    direction.y = fused(z, splat(frame.normal.y), fused(y, splat(frame.bitangent.y), x * splat(frame.tangent.y)));
    direction.z = fused(z, splat(frame.normal.z), fused(y, splat(frame.bitangent.z), x * splat(frame.tangent.z)));
    return direction;
}

/// Whether the direction leaves a surface with this normal to its front.
FN Mask leaves_surface(vec3 normal, Vec3 direction) {
    const Real cosine = fused(direction.z, splat(normal.z),
                              fused(direction.y, splat(normal.y), direction.x * splat(normal.x)));
    return cosine > splat(0.0f);
}

KERNEL_END

#endif
