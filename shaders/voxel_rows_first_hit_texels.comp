#version 460
// First hits (Wang 2017, section 7), the rows read as texels: for software devices, as voxel_rows_lighting_texels.comp.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#define ROWS_AS_TEXELS
#include "voxel_rows_first_hit.glsl"
