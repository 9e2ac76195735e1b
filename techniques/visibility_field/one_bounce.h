// Indirect light (Xu 2022, section 6, as future work): surroundings seen by way of one other surface. What a blocked
// sample hits is lit by one ray of its own, which the masks of the cell that is hit cull as they do a pixel's.
#pragma once

#include <cstdint>

#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

/// What a sample that met a surface brings from there.
struct SecondRay {
    SurfaceAt surface;     ///< that was hit
    vec3 about_up{0.0f};   ///< its ray's direction, were its shading normal +z
    vec3 direction{0.0f};  ///< unit
};

/// The surface that a ray along `direction` (unit) hit, and its second ray, drawn by a hash of the seed and of the first
/// ray.
SecondRay second_ray(const Scene& scene, const Hit& hit, vec3 origin, vec3 direction, std::uint64_t seed);

/// The radiance of the request's light from a direction.
vec3 light_from(const EnvironmentRequest& request, vec3 direction);

/// Adds what all samples that `result` has blocked (its verdicts, which it must hold) bring to its irradiance and
/// radiance, and their rays to its pictures and counts of second rays. `field` null: every second ray is traced.
void add_one_bounce(const VisibilityField* field, const EmbreeScene& embree, const Scene& scene,
                    const EnvironmentRequest& request, EnvironmentResult& result, Progress& progress);

}  // namespace sightlines::visibility_field
