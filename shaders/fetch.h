// Reading single words and numbers of a table, one for each ray. The only place where the compilations of the
// baselines' kernels differ.
#ifndef SIGHTLINES_FETCH_H
#define SIGHTLINES_FETCH_H

#include "portability.h"

KERNEL_BEGIN

BUFFER_REF(Words, uint);
BUFFER_REF(Reals, float);

#ifdef SIGHTLINES_WIDE_H
FN UInt fetch_word(Words words, Int index) { return {hn::GatherIndex(UIntTag(), words.v, index.v)}; }
FN Real fetch_real(Reals reals, Int index) { return {hn::GatherIndex(RealTag(), reals.v, index.v)}; }
#else
FN UInt fetch_word(Words words, Int index) { return words.v[index]; }
FN Real fetch_real(Reals reals, Int index) { return reals.v[index]; }
#endif

KERNEL_END

#endif
