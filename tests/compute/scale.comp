#version 460
// out[i] = in[i] * factor, for the tests of the compute layer; the factor is a specialization constant.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;
layout(constant_id = 7) const uint factor = 1u;
layout(constant_id = 8) const bool from_texels = false;
layout(set = 0, binding = 0) uniform usamplerBuffer texels;
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Numbers { uint v[]; };
layout(push_constant, scalar) uniform Push {
    Numbers from;
    Numbers to;
    uint count;
};

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    const uint number = from_texels ? texelFetch(texels, int(i / 4u))[i % 4u] : from.v[i];
    to.v[i] = number * factor;
}
