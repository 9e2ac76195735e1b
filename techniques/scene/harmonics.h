// Environments of low frequency: real spherical harmonics of order 3 (R. Ramamoorthi, P. Hanrahan: An Efficient
// Representation for Irradiance Environment Maps. SIGGRAPH 2001).
#pragma once

#include <array>

#include "techniques/base/types.h"
#include "techniques/scene/environment.h"

namespace sightlines {

/// The coefficients of Y00, Y1-1, Y10, Y11, Y2-2, Y2-1, Y20, Y21, Y22, of radiance, for each channel. Only three bands,
/// so that strong contrasts ring: the sum may be negative.
struct Harmonics {
    std::array<vec3, 9> coefficient{};

    bool operator==(const Harmonics&) const = default;
};

/// The nine functions of a unit direction.
std::array<double, 9> harmonic_functions(dvec3 direction);

/// Integrates the environment against each function, texel by texel.
Harmonics project(const Environment& environment);

/// The same light, turned by `rotation` (a rotation matrix, world from before).
Harmonics rotated(const Harmonics& harmonics, const mat3& rotation);

/// Radiance from a unit direction.
vec3 radiance(const Harmonics& harmonics, vec3 direction);

/// Irradiance of an unshadowed surface with this unit normal, W/m^2 (their equation 11).
vec3 irradiance(const Harmonics& harmonics, vec3 normal);

/// A turn about +Y, degrees, from -Z towards +X.
mat3 turn_about_up(float degrees);

}  // namespace sightlines
