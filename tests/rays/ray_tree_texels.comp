#version 460
// The same with the tables read as texels.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define TREE_AS_TEXELS
#include "tests/rays/ray_tree.glsl"
