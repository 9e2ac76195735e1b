// The body of ray_tree*.comp.
#include "shaders/ray_tree.h"

layout(local_size_x = 64) in;

struct Ray {
    vec3 origin;
    vec3 direction;
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Rays { Ray v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Answers { uint v[]; };

layout(push_constant, scalar) uniform Push {
    RayTreeTables tree;
    uint count;
    Rays rays;
    Answers answers;
};

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    answers.v[i] = is_blocked_by_tree(tree, rays.v[i].origin, rays.v[i].direction) ? 1u : 0u;
}
