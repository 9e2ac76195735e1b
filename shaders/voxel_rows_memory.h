// How the kernel of the voxel rows reads its tables. The only place where its compilations differ.
#ifndef SIGHTLINES_VOXEL_ROWS_MEMORY_H
#define SIGHTLINES_VOXEL_ROWS_MEMORY_H

#include "voxel_rows_data.h"

KERNEL_BEGIN

BUFFER_REF(FrameTable, DirectionFrame);

#ifdef SIGHTLINES_WIDE_H

/// A frame for each ray.
struct Frame {
    Vec3 u;
    Real v_x;
    Vec3 w;
    Real v_z;
};

FN Frame load_frame(FrameTable frames, Int direction) {
    const FourReals u = gather_four_floats(&frames.v[0].u.x, direction, sizeof(DirectionFrame) / sizeof(float));
    const FourReals w = gather_four_floats(&frames.v[0].w.x, direction, sizeof(DirectionFrame) / sizeof(float));
    return {{u.x, u.y, u.z}, u.w, {w.x, w.y, w.z}, w.w};
}

BUFFER_REF(Rows, uint);
FN UInt load_word(Rows rows, RowShape shape, UInt row, int word) {
    return gather_words(rows.v + word, row, shape.words_per_row);
}
FN FourWords load_four_words(Rows rows, RowShape shape, UInt row, int word) {
    return gather_four_words(rows.v + word, row, shape.words_per_row);
}
FN UInt load_index(Rows rows, RowShape shape, UInt row) {
    const uint* indices = rows.v + shape.index_start;
    return shape.index_bits == 32 ? gather_words(indices, row, 1) : gather_20_bits(indices, row);
}

#else

/// Four neighbouring words of a row.
struct FourWords {
    UInt x;
    UInt y;
    UInt z;
    UInt w;
};

#ifdef __cplusplus

using Frame = DirectionFrame;
FN Frame load_frame(FrameTable frames, Int direction) { return frames.v[direction]; }

BUFFER_REF(Rows, uint);
FN UInt load_word(Rows rows, RowShape shape, UInt row, int word) {
    return rows.v[static_cast<std::size_t>(row) * shape.words_per_row + word];
}
FN FourWords load_four_words(Rows rows, RowShape shape, UInt row, int word) {
    const uint* from = rows.v + static_cast<std::size_t>(row) * shape.words_per_row + word;
    return {from[0], from[1], from[2], from[3]};
}

#else

#define Frame DirectionFrame

#ifdef ROWS_AS_TEXELS
layout(set = 0, binding = 0) uniform samplerBuffer frame_texels;
layout(set = 0, binding = 1) uniform usamplerBuffer row_texels;
layout(set = 0, binding = 2) uniform usamplerBuffer index_texels;   // a word each; read where rows are compressed

FN Frame load_frame(FrameTable frames, Int direction) {
    const vec4 u = texelFetch(frame_texels, 2 * direction);
    const vec4 w = texelFetch(frame_texels, 2 * direction + 1);
    return Frame(u.xyz, u.w, w.xyz, w.w);
}
#else
FN Frame load_frame(FrameTable frames, Int direction) { return frames.v[direction]; }
#endif

// Rows are read by fours where they are that long; the index then stays below 2^31.
BUFFER_REF(Rows, uint);
BUFFER_REF(RowsByFour, FourWords);
FN UInt load_word(Rows rows, RowShape shape, UInt row, int word) {
    return rows.v[row * uint(shape.words_per_row) + uint(word)];
}
FN FourWords load_four_words(Rows rows, RowShape shape, UInt row, int word) {
    const uint four = row * uint(shape.words_per_row / 4) + uint(word / 4);
#ifdef ROWS_AS_TEXELS
    const uvec4 words = texelFetch(row_texels, int(four));
    return FourWords(words.x, words.y, words.z, words.w);
#else
    return RowsByFour(rows).v[four];
#endif
}

#endif

/// A word of those behind the dictionary.
FN uint load_index_word(Rows rows, RowShape shape, uint word) {
#ifdef ROWS_AS_TEXELS
    return texelFetch(index_texels, int(word)).x;
#else
    return rows.v[uint(shape.index_start) + word];
#endif
}

/// The row's index in the dictionary. Of 20 bits there are 8 in 5 words.
FN UInt load_index(Rows rows, RowShape shape, UInt row) {
    if (shape.index_bits == 32) return load_index_word(rows, shape, row);
    const uint bit = (row & 7u) * 20u;
    const uint shift = bit & 31u;
    const uint word = (row >> 3) * 5u + (bit >> 5);
    const uint low = load_index_word(rows, shape, word) >> shift;
    const uint high = shift > 12u ? load_index_word(rows, shape, word + 1u) : 0u;
    return (low | shift_left(high, 32u - shift)) & 0xfffffu;
}
#endif

KERNEL_END

#endif
