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
    const auto u = gather_four_floats(&frames.v[0].u.x, direction, sizeof(DirectionFrame) / sizeof(float));
    const auto w = gather_four_floats(&frames.v[0].w.x, direction, sizeof(DirectionFrame) / sizeof(float));
    return {{u[0], u[1], u[2]}, u[3], {w[0], w[1], w[2]}, w[3]};
}

BUFFER_REF(Rows, uint);
FN UInt load_word(Rows rows, RowShape shape, UInt row, int word) {
    return gather_words(rows.v + word, row, shape.words_per_row);
}
FN FourWords load_four_words(Rows rows, RowShape shape, UInt row, int word) {
    return gather_four_words(rows.v + word, row, shape.words_per_row);
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
#endif

KERNEL_END

#endif
