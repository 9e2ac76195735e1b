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
    Real u_offset;
    Vec3 v;
    Real v_offset;
    Vec3 w;
    Real w_offset;
};

FN Frame load_frame(FrameTable frames, Int direction) {
    const auto numbers = load_records<12>(&frames.v[0].u.x, direction);
    Frame frame;
    frame.u = Vec3{numbers[0], numbers[1], numbers[2]};
    frame.u_offset = numbers[3];
    frame.v = Vec3{numbers[4], numbers[5], numbers[6]};
    frame.v_offset = numbers[7];
    frame.w = Vec3{numbers[8], numbers[9], numbers[10]};
    frame.w_offset = numbers[11];
    return frame;
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
    const vec4 u = texelFetch(frame_texels, 3 * direction);
    const vec4 v = texelFetch(frame_texels, 3 * direction + 1);
    const vec4 w = texelFetch(frame_texels, 3 * direction + 2);
    return Frame(u.xyz, u.w, v.xyz, v.w, w.xyz, w.w);
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
