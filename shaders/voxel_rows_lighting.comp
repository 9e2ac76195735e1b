#version 460
// Algorithm 4 of Wang 2017, the rows read by device address: for any device, any size of array.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "voxel_rows_lighting.glsl"
