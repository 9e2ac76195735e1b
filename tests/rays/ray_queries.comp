#version 460
// The device's own ray queries, for the tests: one ray an invocation, a word for each answer.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_ray_query : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define RAYS_BY_QUERY
#include "tests/rays/ray_tree.glsl"
