// How the kernel of the visibility field reads its bricks and masks. The only place where its compilations differ.
#ifndef SIGHTLINES_VISIBILITY_FIELD_MEMORY_H
#define SIGHTLINES_VISIBILITY_FIELD_MEMORY_H

#include "fetch.h"
#include "visibility_field_data.h"

#ifdef __cplusplus
#include <bit>
#endif

KERNEL_BEGIN

BUFFER_REF(Bricks, FieldBrick);

#ifdef __cplusplus
FN uint bits_set(uint word) { return static_cast<uint>(std::popcount(word)); }
#else
FN uint bits_set(uint word) { return uint(bitCount(word)); }
#endif

#ifdef SIGHTLINES_WIDE_H

/// One mask of one cell. Up to two vectors of words stay in registers, where a lookup is a permutation.
struct CellMask {
    const uint* words;
    int count;
    UInt low;
    UInt high;
};

/// Reads two vectors of words, whatever the mask's length.
FN CellMask load_mask(Words masks, uint start, int words_per_mask) {
    const uint* from = masks.v + start;
    return {from, words_per_mask, {hn::LoadU(UIntTag(), from)}, {hn::LoadU(UIntTag(), from + lanes)}};
}

FN UInt mask_word(CellMask mask, Int index) {
    constexpr int width = static_cast<int>(lanes);
    if (mask.count > 2 * width) return fetch_word({mask.words}, index);
    const auto place = hn::IndicesFromVec(UIntTag(), (index & splat(width - 1)).v);
    const auto low = hn::TableLookupLanes(mask.low.v, place);
    if (mask.count <= width) return {low};
    const auto in_low = hn::RebindMask(UIntTag(), (index < splat(width)).m);
    return {hn::IfThenElse(in_low, low, hn::TableLookupLanes(mask.high.v, place))};
}

#else

/// One mask of one cell.
struct CellMask {
    Words masks;
    uint start;
    int count;
};

FN CellMask load_mask(Words masks, uint start, int words_per_mask) {
    CellMask mask;
    mask.masks = masks;
    mask.start = start;
    mask.count = words_per_mask;
    return mask;
}

FN UInt mask_word(CellMask mask, Int index) { return mask.masks.v[mask.start + uint(index)]; }

#endif

KERNEL_END

#endif
