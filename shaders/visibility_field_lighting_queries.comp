#version 460
// Algorithm 2 of Xu 2022, rays answered by the device's own ray queries.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_ray_query : require
#extension GL_EXT_scalar_block_layout : require

#define RAYS_BY_QUERY
#include "visibility_field_lighting.glsl"
