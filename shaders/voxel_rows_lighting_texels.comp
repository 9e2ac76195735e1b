#version 460
// Algorithm 4 of Wang 2017, the rows read as texels: for software devices, which fetch a texel of 16 bytes at once but
// go through an address's words and rays one by one.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

#define ROWS_AS_TEXELS
#include "voxel_rows_lighting.glsl"
