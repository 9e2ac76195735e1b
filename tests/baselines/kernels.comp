#version 460
// The baselines' kernels as GLSL, for the tests: one ray an invocation, all answers as bits of a word.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shaders/ray_triangle.h"
#include "shaders/shadow_map.h"
#include "shaders/voxel_march.h"

layout(local_size_x = 64) in;

struct Ray {
    vec3 position;
    vec3 normal;
    vec3 light;
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Rays { Ray v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Answers { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Grids { VoxelGrid v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Shapes { ShadowMapShape v[]; };

layout(push_constant, scalar) uniform Push {
    Grids grids;
    Words bits;
    Words distances;
    Shapes shapes;    // of a cube, of two paraboloids
    Reals cube;
    Reals paraboloids;
    Rays rays;
    Answers answers;
    uint count;
};

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    const Ray ray = rays.v[i];
    uint answer = 0u;
    if (is_blocked_by_voxels(grids.v[0], bits, ray.position, ray.normal, ray.light, true)) answer |= 1u;
    if (is_blocked_by_rows(grids.v[0], distances, ray.position, ray.normal, ray.light, true)) answer |= 2u;
    if (is_in_shadow(shapes.v[0], cube, ray.position, ray.normal)) answer |= 4u;
    if (is_in_imperfect_shadow(shapes.v[1], paraboloids, ray.position, ray.normal)) answer |= 8u;
    if (meets_triangle(ray.light, ray.position, vec3(0.0f, -9.0f, -9.0f), vec3(0.0f, 9.0f, -9.0f), vec3(0.0f, 0.0f, 9.0f)))
        answer |= 16u;
    answers.v[i] = answer;
}
