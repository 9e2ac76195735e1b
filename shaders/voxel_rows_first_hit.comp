#version 460
// First hits (Wang 2017, section 7), the rows read by device address: for any device, any size of array.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#include "voxel_rows_first_hit.glsl"
