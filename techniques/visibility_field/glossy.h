// Glossy surfaces (Figure 10), for single directions: shaders/glossy.h. All directions are about +z and point away from
// the surface.
#pragma once

#include "shaders/weighted_samples_data.h"
#include "techniques/base/types.h"

namespace sightlines::visibility_field {

/// What a surface reflects: as a mirror of its facets by `head_on`, the share reflected at right angles, and the rest
/// evenly.
struct Gloss {
    vec3 diffuse{0.0f};   ///< reflectance
    vec3 head_on{0.04f};  ///< reflectance of facets seen head on
    float width = 1.0f;   ///< of the distribution of normals, the square of the roughness
};

/// By the albedo of a SurfaceBuffer, of which a metal has half. Roughness and metalness in [0, 1]; nothing is
/// smoother than 0.05.
Gloss make_gloss(vec3 albedo, float roughness, float metalness);

/// The surface as the kernels want it, seen from a unit direction above it.
GlossySurface glossy_surface(const Gloss& gloss, vec3 to_eye);

/// Light from `to_light` that goes to `to_eye`, per irradiance: 1/sr. Zero where either is below the surface.
vec3 reflected_share(const Gloss& gloss, vec3 to_eye, vec3 to_light);

/// The mirrored direction at a facet's normal that is drawn by two numbers in [0, 1) among those seen. May point below
/// the surface.
vec3 mirrored_sample(float width, vec3 to_eye, vec2 numbers);

/// How densely `mirrored_sample` draws a direction, per sr.
float mirrored_density(float width, vec3 to_eye, vec3 to_light);

/// The share of samples that are worth drawing by `mirrored_sample` rather than by the cosine.
float mirrored_share(const Gloss& gloss, vec3 to_eye);

}  // namespace sightlines::visibility_field
