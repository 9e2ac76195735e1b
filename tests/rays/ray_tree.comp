#version 460
// The traversal of the ray tree as GLSL, for the tests: one ray an invocation, a word for each answer.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "tests/rays/ray_tree.glsl"
