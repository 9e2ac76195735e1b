// A tree of boxes over triangles, as the traversal kernel sees it: three tables of four words each, so that a device
// that reads texels gets one at a time.
#ifndef SIGHTLINES_RAY_TREE_DATA_H
#define SIGHTLINES_RAY_TREE_DATA_H

#include "portability.h"

SHARED_BEGIN

#ifdef __cplusplus
using glm::uvec4;
#endif

// Node n, the tree in depth-first order (words are bits of floats but for the w):
//   2 n       lowest corner of its box, m;  w: the node that follows where the ray misses the box
//   2 n + 1   highest corner;               w: 0, or of a leaf: its first triangle * leaf_scale + how many
// A ray that meets the box goes on with node n + 1, so that no stack is needed.
const uint leaf_scale = 8u;

// Triangle t:
//   3 t .. 3 t + 2   its corners, m;        w of the first: no_cutout, or where its record lies among the cut-outs
const uint no_cutout = 0xffffffffu;

// Cut-outs: what of a triangle is a hole.
//   r, r + 1   of a triangle: texture coordinates a, b; c, where its texture's record lies, 0
//   m, m + 1   of a texture: width, height, wrap along u and v; factor, cutoff, where its alpha starts, 0
//   alpha: 16 bytes in each four words, row by row
const uint wrap_repeats = 0u;
const uint wrap_mirrors = 1u;
const uint wrap_clamps = 2u;

SHARED_END

#endif
