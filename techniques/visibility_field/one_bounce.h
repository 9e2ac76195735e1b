// Indirect light (Xu 2022, section 6, as future work): surroundings seen by way of one other surface. What a blocked
// sample hits is lit by one ray of its own, which the masks of the cell that is hit cull as they do a pixel's.
#pragma once

#include <cstdint>
#include <functional>

#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

/// What a sample that met a surface brings from there.
struct SecondRay {
    SurfaceAt surface;     ///< that was hit
    vec3 about_up{0.0f};   ///< its ray's direction, were its shading normal +z
    vec3 direction{0.0f};  ///< unit
    vec3 light{0.0f};  ///< what comes from there, times the cosine over pi and over the density by which it was drawn
};

/// The surface that a ray along `direction` (unit) hit, and its second ray, drawn by a hash of the seed and of the
/// first ray: by the cosine, or where the request draws by a map, one time in two by that (and weighed by the balance
/// heuristic).
SecondRay second_ray(const Scene& scene, const EnvironmentRequest& request, const Hit& hit, vec3 origin, vec3 direction,
                     std::uint64_t seed);

/// The picture that `make` makes of the request, and in its irradiance and radiance what all samples that are blocked
/// bring besides; their second rays are in its pictures and counts. `field` null: every second ray is traced.
EnvironmentResult with_one_bounce(const VisibilityField* field, const EmbreeScene& embree, const Scene& scene,
                                  const EnvironmentRequest& request,
                                  const std::function<EnvironmentResult(const EnvironmentRequest&)>& make,
                                  Progress& progress);

}  // namespace sightlines::visibility_field
