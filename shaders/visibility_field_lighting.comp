#version 460
// Algorithm 2 of Xu 2022, the ray tree read by device address: for any device, any size of scene.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#include "visibility_field_lighting.glsl"
