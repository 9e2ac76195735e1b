// Counter-based random numbers: a hash of (seed, pixel, sample). No state, so any thread and any order give the same.
#pragma once

#include <cstdint>

#include "techniques/base/types.h"

namespace sightlines {

/// The 32-bit PCG output permutation of a linear congruential step (O'Neill 2014; used as a hash, Jarzynski 2020).
constexpr std::uint32_t hash_u32(std::uint32_t value) {
    const std::uint32_t state = value * 747796405u + 2891336453u;
    const std::uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// A hash of a seed, a stream (pixel, light ...) and a sample counter.
constexpr std::uint32_t random_u32(std::uint64_t seed, std::uint32_t stream, std::uint32_t sample) {
    std::uint32_t value = hash_u32(static_cast<std::uint32_t>(seed) ^ 0x9e3779b9u);
    value = hash_u32(value ^ static_cast<std::uint32_t>(seed >> 32u));
    value = hash_u32(value ^ stream);
    return hash_u32(value + sample);
}

/// Uniform in [0, 1), 24 bits.
constexpr float random_unit(std::uint64_t seed, std::uint32_t stream, std::uint32_t sample) {
    return static_cast<float>(random_u32(seed, stream, sample) >> 8u) * 0x1p-24f;
}

/// Uniform on the unit sphere from two uniform numbers (equal-area cylinder projection, Archimedes).
vec3 sphere_direction(float u, float v);

}  // namespace sightlines
