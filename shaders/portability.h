// What lets one kernel header compile four ways: GLSL, scalar C++, recording C++ and wide C++ (DESIGN, "The second
// idea"). Kernels speak the small vocabulary below and nothing else:
//   Real Int UInt Mask Vec3          one ray's numbers (wide: one for each of up to 16 rays)
//   float int uint bool vec3         numbers that are the same for all rays (uniform)
//   splat(x)                         a uniform value as one for each ray
//   select(mask, a, b)               a where the mask holds, else b; both sides are evaluated
//   fused(a, b, c)                   a * b + c; rounded once where the machine can
//   to_int(r) to_real(i)            truncating, exact
//   to_uint(i) to_signed(u)         reinterpreting
//   shift_left(x, n) shift_right(x, n)   zero where n >= 32
//   any_lane(mask)                   whether it holds for any ray: what loops ask
//   NOTE(paper, sentence) SHOW SHOW_BITS SHOW_POINT SHOW_SEGMENT   recorded in recording C++, nothing elsewhere
// GLSL has no variadic macros, hence one SHOW for each value.
#ifndef SIGHTLINES_PORTABILITY_H
#define SIGHTLINES_PORTABILITY_H

#ifdef __cplusplus

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

// A translation unit chooses its compilation by including shaders/wide.h or shaders/recording.h first; scalar else.
#ifndef KERNEL_NAMESPACE
#define KERNEL_NAMESPACE scalar_kernel
#endif

#ifndef FN
#define FN inline
#endif
#define OUT(T) T&
#define INOUT(T) T&
#define BUFFER_REF(Name, T) \
    struct Name {           \
        const T* v;         \
    }
#define KERNEL_BEGIN namespace sightlines::KERNEL_NAMESPACE {
#define KERNEL_END }
#define SHARED_BEGIN namespace sightlines {
#define SHARED_END }

#ifndef NOTE
#define NOTE(paper, sentence)
#define SHOW(value)
#define SHOW_BITS(name, word)
#define SHOW_POINT(place)
#define SHOW_SEGMENT(name, a, b)
#endif

SHARED_BEGIN
using uint = std::uint32_t;
using glm::vec3;

/// a * b + c. Fused only where the hardware does it, so that the scalar and the wide compilation round alike.
inline float fused(float a, float b, float c) {
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
    return std::fma(a, b, c);
#else
    return a * b + c;
#endif
}
SHARED_END

#ifndef SIGHTLINES_WIDE_H
KERNEL_BEGIN
using Real = float;
using Int = int;
using UInt = uint;
using Mask = bool;
using Vec3 = vec3;

template <class T> T splat(T x) { return x; }
inline Real select(Mask mask, Real a, Real b) { return mask ? a : b; }
inline Int select(Mask mask, Int a, Int b) { return mask ? a : b; }
inline UInt select(Mask mask, UInt a, UInt b) { return mask ? a : b; }
inline Real sqrt(Real x) { return std::sqrt(x); }
inline Real abs(Real x) { return std::fabs(x); }
// As the wide compilation's instructions: the second operand where the comparison is false.
inline Real min(Real a, Real b) { return a < b ? a : b; }
inline Real max(Real a, Real b) { return a > b ? a : b; }
inline Int min(Int a, Int b) { return a < b ? a : b; }
inline Int max(Int a, Int b) { return a > b ? a : b; }
inline Int to_int(Real x) { return static_cast<Int>(x); }
inline Real to_real(Int x) { return static_cast<Real>(x); }
inline UInt to_uint(Int x) { return static_cast<UInt>(x); }
inline Int to_signed(UInt x) { return static_cast<Int>(x); }
inline UInt shift_left(UInt x, UInt n) { return n < 32u ? x << n : 0u; }
inline UInt shift_right(UInt x, UInt n) { return n < 32u ? x >> n : 0u; }
inline bool any_lane(Mask mask) { return mask; }
KERNEL_END
#endif

#else  // GLSL

#define FN
#define OUT(T) out T
#define INOUT(T) inout T
#define BUFFER_REF(Name, T)                                                                      \
    layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Name { T v[]; }
#define KERNEL_BEGIN
#define KERNEL_END
#define SHARED_BEGIN
#define SHARED_END
#define NOTE(paper, sentence)
#define SHOW(value)
#define SHOW_BITS(name, word)
#define SHOW_POINT(place)
#define SHOW_SEGMENT(name, a, b)

#define Real float
#define Int int
#define UInt uint
#define Mask bool
#define Vec3 vec3
#define splat(x) (x)
#define select(mask, a, b) ((mask) ? (a) : (b))
#define fused(a, b, c) fma(a, b, c)
#define to_int(x) int(x)
#define to_real(x) float(x)
#define to_uint(x) uint(x)
#define to_signed(x) int(x)
#define any_lane(mask) (mask)

FN UInt shift_left(UInt x, UInt n) { return n < 32u ? x << n : 0u; }
FN UInt shift_right(UInt x, UInt n) { return n < 32u ? x >> n : 0u; }

#endif

#endif
