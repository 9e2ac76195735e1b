#version 460
// Algorithm 2 of Xu 2022, the ray tree read as texels: for software devices, which fetch a texel of 16 bytes at once but
// go through an address's words and rays one by one.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#define TREE_AS_TEXELS
#include "visibility_field_lighting.glsl"
