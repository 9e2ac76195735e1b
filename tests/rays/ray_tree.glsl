// The body of ray_tree*.comp and ray_queries.comp.
#include "shaders/ray_tree.h"

#ifdef RAYS_BY_QUERY
#include "shaders/ray_query.glsl"
#endif

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
#ifdef RAYS_BY_QUERY
    uvec2 ray_scene;
#endif
};

bool is_blocked(Ray ray) {
#ifdef RAYS_BY_QUERY
    return is_blocked_by_query(tree, ray_scene, ray.origin, ray.direction);
#else
    return is_blocked_by_tree(tree, ray.origin, ray.direction);
#endif
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    answers.v[i] = is_blocked(rays.v[i]) ? 1u : 0u;
}
