// The kernels' vocabulary for up to 16 rays at once, by Highway. Include before a kernel header to compile it wide.
// Every operation rounds as its scalar counterpart in portability.h does, so that both give the same answers.
#ifndef SIGHTLINES_WIDE_H
#define SIGHTLINES_WIDE_H

#define KERNEL_NAMESPACE wide_kernel

#include <array>
#include <cstddef>
#include <cstring>

// The build fixes the instruction set, so that this compilation and the scalar one fuse and round alike.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/highway.h>

#define FN HWY_INLINE
#include "shaders/portability.h"

namespace sightlines::wide_kernel {

namespace hn = hwy::HWY_NAMESPACE;

using RealTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<RealTag>;
using UIntTag = hn::RebindToUnsigned<RealTag>;
inline constexpr std::size_t lanes = hn::MaxLanes(RealTag());

/// One number for each ray. `v` is the machine's vector.
struct Real {
    hn::Vec<RealTag> v;
};
struct Int {
    hn::Vec<IntTag> v;
};
struct UInt {
    hn::Vec<UIntTag> v;
};
/// One truth for each ray, as the comparison of floats gives it.
struct Mask {
    hn::Mask<RealTag> m;
};
struct Vec3 {
    Real x, y, z;
};
struct FourWords {
    UInt x, y, z, w;
};

HWY_INLINE Real splat(float x) { return {hn::Set(RealTag(), x)}; }
HWY_INLINE Int splat(int x) { return {hn::Set(IntTag(), x)}; }
HWY_INLINE UInt splat(uint x) { return {hn::Set(UIntTag(), x)}; }
HWY_INLINE Vec3 splat(vec3 x) { return {splat(x.x), splat(x.y), splat(x.z)}; }

HWY_INLINE Real operator+(Real a, Real b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Real operator-(Real a, Real b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Real operator*(Real a, Real b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE Real operator/(Real a, Real b) { return {hn::Div(a.v, b.v)}; }
HWY_INLINE Real operator-(Real a) { return {hn::Neg(a.v)}; }
HWY_INLINE Real fused(Real a, Real b, Real c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
HWY_INLINE Real sqrt(Real x) { return {hn::Sqrt(x.v)}; }
HWY_INLINE Real abs(Real x) { return {hn::Abs(x.v)}; }

HWY_INLINE Int operator+(Int a, Int b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Int operator-(Int a, Int b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Int operator*(Int a, Int b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE Int operator&(Int a, Int b) { return {hn::And(a.v, b.v)}; }
HWY_INLINE Int operator|(Int a, Int b) { return {hn::Or(a.v, b.v)}; }
HWY_INLINE Int operator<<(Int a, int bits) { return {hn::ShiftLeftSame(a.v, bits)}; }
HWY_INLINE Int operator>>(Int a, int bits) { return {hn::ShiftRightSame(a.v, bits)}; }
HWY_INLINE UInt operator|(UInt a, UInt b) { return {hn::Or(a.v, b.v)}; }
HWY_INLINE UInt operator&(UInt a, UInt b) { return {hn::And(a.v, b.v)}; }

HWY_INLINE Mask operator<(Real a, Real b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE Mask operator>(Real a, Real b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE Mask operator<(Int a, Int b) { return {hn::RebindMask(RealTag(), hn::Lt(a.v, b.v))}; }
HWY_INLINE Mask operator>(Int a, Int b) { return {hn::RebindMask(RealTag(), hn::Gt(a.v, b.v))}; }
HWY_INLINE Mask operator==(Int a, Int b) { return {hn::RebindMask(RealTag(), hn::Eq(a.v, b.v))}; }
HWY_INLINE Mask operator!=(UInt a, UInt b) { return {hn::RebindMask(RealTag(), hn::Ne(a.v, b.v))}; }
HWY_INLINE Mask operator||(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
HWY_INLINE Mask operator!(Mask a) { return {hn::Not(a.m)}; }
HWY_INLINE Mask operator&&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }

HWY_INLINE Real min(Real a, Real b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE Real max(Real a, Real b) { return {hn::Max(a.v, b.v)}; }
// Of uniform values.
HWY_INLINE float min(float a, float b) { return a < b ? a : b; }
HWY_INLINE float max(float a, float b) { return a > b ? a : b; }
HWY_INLINE Int min(Int a, Int b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE Int max(Int a, Int b) { return {hn::Max(a.v, b.v)}; }
HWY_INLINE Real select(Mask mask, Real a, Real b) { return {hn::IfThenElse(mask.m, a.v, b.v)}; }
HWY_INLINE Int select(Mask mask, Int a, Int b) { return {hn::IfThenElse(hn::RebindMask(IntTag(), mask.m), a.v, b.v)}; }

#if HWY_TARGET <= HWY_AVX3
// Highway's conversion saturates, for four more instructions; kernels convert only what is in range.
HWY_INLINE Int to_int(Real x) { return {hn::Vec<IntTag>{_mm512_cvttps_epi32(x.v.raw)}}; }
#else
HWY_INLINE Int to_int(Real x) { return {hn::ConvertTo(IntTag(), x.v)}; }
#endif
HWY_INLINE Real to_real(Int x) { return {hn::ConvertTo(RealTag(), x.v)}; }
HWY_INLINE Int to_signed(UInt x) { return {hn::BitCast(IntTag(), x.v)}; }
HWY_INLINE UInt to_uint(Int x) { return {hn::BitCast(UIntTag(), x.v)}; }

#if HWY_TARGET <= HWY_AVX2
// The shifts of AVX2 and later already give zero from 32 on.
HWY_INLINE UInt shift_left(UInt x, UInt n) { return {hn::Shl(x.v, n.v)}; }
HWY_INLINE UInt shift_right(UInt x, UInt n) { return {hn::Shr(x.v, n.v)}; }
#else
HWY_INLINE UInt shift_left(UInt x, UInt n) {
    const auto inside = hn::Lt(hn::BitCast(IntTag(), n.v), hn::Set(IntTag(), 32));
    const auto shifted = hn::Shl(x.v, hn::And(n.v, hn::Set(UIntTag(), 31u)));
    return {hn::IfThenElseZero(hn::RebindMask(UIntTag(), inside), shifted)};
}
HWY_INLINE UInt shift_right(UInt x, UInt n) {
    const auto inside = hn::Lt(hn::BitCast(IntTag(), n.v), hn::Set(IntTag(), 32));
    const auto shifted = hn::Shr(x.v, hn::And(n.v, hn::Set(UIntTag(), 31u)));
    return {hn::IfThenElseZero(hn::RebindMask(UIntTag(), inside), shifted)};
}
#endif

HWY_INLINE Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Vec3 operator*(Vec3 a, Real b) { return {a.x * b, a.y * b, a.z * b}; }

HWY_INLINE Real load(const float* from) { return {hn::LoadU(RealTag(), from)}; }
/// The lanes of the mask side by side from `to` on; writes a whole vector, garbage behind them.
HWY_INLINE void store_compressed(Real x, Mask mask, float* to) {
    hn::StoreU(hn::Compress(x.v, mask.m), RealTag(), to);
}
HWY_INLINE void store(Real x, float* to) { hn::StoreU(x.v, RealTag(), to); }
HWY_INLINE void store(Int x, int* to) { hn::StoreU(x.v, IntTag(), to); }
HWY_INLINE void store(UInt x, uint* to) { hn::StoreU(x.v, UIntTag(), to); }

/// Bit i: lane i.
HWY_INLINE std::uint32_t bits_of(Mask mask) {
    alignas(8) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(RealTag(), mask.m, bytes);
    std::uint32_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
}
/// The mask of whose lanes bit i speaks.
HWY_INLINE Mask mask_of(std::uint32_t bits) {
    alignas(8) std::uint8_t bytes[8] = {};
    std::memcpy(bytes, &bits, sizeof bits);
    return {hn::LoadMaskBits(RealTag(), bytes)};
}
HWY_INLINE bool any_lane(Mask mask) { return !hn::AllFalse(RealTag(), mask.m); }

/// A vector of what `word_of(lane)` reads for each lane. Put together in registers where they are that wide: a vector that
/// is loaded from words just stored waits until all of them have left the processor.
template <class WordOf>
HWY_INLINE UInt collected(const WordOf& word_of) {
#if HWY_TARGET <= HWY_AVX3
    const auto four = [&](std::size_t lane) {
        __m128i words = _mm_cvtsi32_si128(static_cast<int>(word_of(lane)));
        words = _mm_insert_epi32(words, static_cast<int>(word_of(lane + 1)), 1);
        words = _mm_insert_epi32(words, static_cast<int>(word_of(lane + 2)), 2);
        return _mm_insert_epi32(words, static_cast<int>(word_of(lane + 3)), 3);
    };
    __m512i all = _mm512_castsi128_si512(four(0));
    all = _mm512_inserti32x4(all, four(4), 1);
    all = _mm512_inserti32x4(all, four(8), 2);
    return {hn::Vec<UIntTag>{_mm512_inserti32x4(all, four(12), 3)}};
#else
    alignas(64) uint words[lanes];
    for (std::size_t lane = 0; lane < lanes; ++lane) words[lane] = word_of(lane);
    return {hn::Load(UIntTag(), words)};
#endif
}

/// words[index * stride] for each ray.
HWY_INLINE UInt gather_words(const uint* words, UInt index, int stride) {
    alignas(64) uint each[lanes];
    hn::Store(index.v, UIntTag(), each);
    return collected([&](std::size_t lane) { return words[static_cast<std::size_t>(each[lane]) * stride]; });
}

/// Number `index`, below 1.7e9, of 20-bit numbers that lie one after the other, for each ray. Reads up to 12 bits behind
/// it.
HWY_INLINE UInt gather_20_bits(const uint* words, UInt index) {
    alignas(64) uint first_byte[lanes];  // index * 5 / 2
    hn::Store(hn::Add(hn::ShiftLeft<1>(index.v), hn::ShiftRight<1>(index.v)), UIntTag(), first_byte);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(words);
    const UInt read = collected([&](std::size_t lane) {
        uint word = 0;
        std::memcpy(&word, bytes + first_byte[lane], sizeof word);
        return word;
    });
    const auto odd = hn::And(index.v, hn::Set(UIntTag(), 1u));
    return {hn::And(hn::Shr(read.v, hn::ShiftLeft<2>(odd)), hn::Set(UIntTag(), 0xfffffu))};
}

#if HWY_TARGET <= HWY_AVX3
/// words[index * stride + 0 .. 3] for each ray: one 128-bit load a ray, transposed by fours. Beats eight gathers, and
/// a loop over the distinct indices, whose branches are unpredictable.
HWY_INLINE FourWords gather_four_words(const uint* words, UInt index, int stride) {
    alignas(64) uint each[lanes];
    hn::Store(index.v, UIntTag(), each);
    const auto from = [&](std::size_t lane) {
        return reinterpret_cast<const __m128i*>(words + static_cast<std::size_t>(each[lane]) * stride);
    };
    const auto every_fourth = [&](std::size_t lane) {
        __m512i four = _mm512_castsi128_si512(_mm_loadu_si128(from(lane)));
        four = _mm512_inserti32x4(four, _mm_loadu_si128(from(lane + 4)), 1);
        four = _mm512_inserti32x4(four, _mm_loadu_si128(from(lane + 8)), 2);
        return _mm512_inserti32x4(four, _mm_loadu_si128(from(lane + 12)), 3);
    };
    const __m512i a = every_fourth(0), b = every_fourth(1), c = every_fourth(2), d = every_fourth(3);
    const __m512i ab_low = _mm512_unpacklo_epi32(a, b), ab_high = _mm512_unpackhi_epi32(a, b);
    const __m512i cd_low = _mm512_unpacklo_epi32(c, d), cd_high = _mm512_unpackhi_epi32(c, d);
    using Words = hn::Vec<UIntTag>;
    return {{Words{_mm512_unpacklo_epi64(ab_low, cd_low)}},
            {Words{_mm512_unpackhi_epi64(ab_low, cd_low)}},
            {Words{_mm512_unpacklo_epi64(ab_high, cd_high)}},
            {Words{_mm512_unpackhi_epi64(ab_high, cd_high)}}};
}
#else
/// words[index * stride + 0 .. 3] for each ray.
HWY_INLINE FourWords gather_four_words(const uint* words, UInt index, int stride) {
    return {gather_words(words, index, stride), gather_words(words + 1, index, stride),
            gather_words(words + 2, index, stride), gather_words(words + 3, index, stride)};
}
#endif

/// Four neighbouring numbers of a table, for each ray.
struct FourReals {
    Real x, y, z, w;
};

/// numbers[index * stride + 0 .. 3] for each ray.
HWY_INLINE FourReals gather_four_floats(const float* numbers, Int index, int stride) {
    const FourWords four = gather_four_words(reinterpret_cast<const uint*>(numbers), to_uint(index), stride);
    const auto real = [](UInt word) { return Real{hn::BitCast(RealTag(), word.v)}; };
    return {real(four.x), real(four.y), real(four.z), real(four.w)};
}

}  // namespace sightlines::wide_kernel

#endif
