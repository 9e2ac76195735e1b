#version 460
// A picture in the window: the four corners of a strip, without a vertex buffer.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "window_picture_data.h"

layout(push_constant, scalar) uniform Push { PictureQuad quad; };
layout(location = 0) out vec2 uv;

void main() {
    const vec2 t = vec2(float(gl_VertexIndex & 1), float(gl_VertexIndex >> 1));
    uv = vec2(quad.corner_u, quad.corner_v) + t * vec2(quad.size_u, quad.size_v);
    gl_Position = vec4(vec2(quad.corner_x, quad.corner_y) + t * vec2(quad.size_x, quad.size_y), 0.0, 1.0);
}
