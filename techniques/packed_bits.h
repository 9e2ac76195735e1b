// Answers of packed rays, spread back to the pixels that asked.
#pragma once

#include <cstdint>

#ifdef __BMI2__
#include <immintrin.h>
#endif

namespace sightlines {

/// The lowest bits of `packed` at the places of the mask's set bits.
[[gnu::always_inline]] inline std::uint32_t deposit_bits(std::uint32_t packed, std::uint32_t mask) {
#ifdef __BMI2__
    return _pdep_u32(packed, mask);
#else
    std::uint32_t spread = 0;
    for (; mask != 0; mask &= mask - 1, packed >>= 1u)
        if (packed & 1u) spread |= mask & (~mask + 1u);
    return spread;
#endif
}

}  // namespace sightlines
