// How the kernel of the ray tree reads its tables. The only place where its compilations differ.
#ifndef SIGHTLINES_RAY_TREE_MEMORY_H
#define SIGHTLINES_RAY_TREE_MEMORY_H

#include "ray_tree_data.h"

#ifdef __cplusplus
#include <bit>
#endif

KERNEL_BEGIN

BUFFER_REF(FourWordTable, uvec4);

/// A tree's tables and its size.
struct RayTreeTables {
    FourWordTable nodes;
    FourWordTable triangles;
    FourWordTable cutouts;
    uint node_count;
};

#ifdef __cplusplus
FN float float_of(uint bits) { return std::bit_cast<float>(bits); }
FN float rounded_down(float number) { return std::floor(number); }
#else
FN float float_of(uint bits) { return uintBitsToFloat(bits); }
FN float rounded_down(float number) { return floor(number); }
#endif

#ifdef TREE_AS_TEXELS
layout(set = 0, binding = 0) uniform usamplerBuffer node_texels;
layout(set = 0, binding = 1) uniform usamplerBuffer triangle_texels;
layout(set = 0, binding = 2) uniform usamplerBuffer cutout_texels;

FN uvec4 node_words(RayTreeTables tree, uint index) { return texelFetch(node_texels, int(index)); }
FN uvec4 triangle_words(RayTreeTables tree, uint index) { return texelFetch(triangle_texels, int(index)); }
FN uvec4 cutout_words(RayTreeTables tree, uint index) { return texelFetch(cutout_texels, int(index)); }
#else
FN uvec4 node_words(RayTreeTables tree, uint index) { return tree.nodes.v[index]; }
FN uvec4 triangle_words(RayTreeTables tree, uint index) { return tree.triangles.v[index]; }
FN uvec4 cutout_words(RayTreeTables tree, uint index) { return tree.cutouts.v[index]; }
#endif

KERNEL_END

#endif
