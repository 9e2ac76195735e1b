// Samples whose weights differ: by the reflection of glossy surfaces, by a map of the surroundings, or by both (Veach
// and Guibas 1995). Those of the paper, by the cosine, all weigh the same.
#pragma once

#include <span>
#include <vector>

#include "techniques/visibility_field/glossy.h"
#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

struct PixelSample {
    vec3 direction{0.0f};  ///< unit; into the surface where the sample does not count
    vec3 adds{0.0f};       ///< to the pixel's irradiance where nothing is in the way, W/m^2. Where surfaces are glossy:
                           ///< to the irradiance of a white surface that looks as this one does
};

/// The request's samples of a pixel that shows a surface: first those by the cosine, then mirrored ones, then the
/// map's. Each weighs its light and the cosine over how densely all ways together draw its direction (the balance
/// heuristic): with surfaces that reflect, times pi and the share that is reflected.
std::vector<PixelSample> weighted_samples(const EnvironmentRequest& request, std::size_t pixel);

/// The picture of such samples, by Embree. `field` may be null.
EnvironmentResult render_weighted(const VisibilityField* field, const EmbreeScene& embree,
                                  const EnvironmentRequest& request, Progress& progress);

/// A pixel and the directions of its samples, not yet weighed: most are blocked, and weighing takes longest.
struct DrawnPixel {
    /// How many samples are drawn each way, in this order.
    struct Ways {
        std::uint32_t cosine = 0, mirrored = 0, map = 0;
    };
    vec3 normal{0.0f};              ///< geometric
    mat3 world_from_surface{1.0f};  ///< its z the shading normal
    vec3 to_eye{0.0f};              ///< about it
    Gloss gloss;
    vec2 shift{0.0f};  ///< of the numbers that samples are drawn by
    Ways ways;
    std::vector<vec3> directions;  ///< as PixelSample's
};
DrawnPixel draw_samples(const EnvironmentRequest& request, std::size_t pixel);

/// Writes what a pixel's samples come to. `blocked`: sample k is in bit k % 32 of word k / 32; samples below their
/// surface are not looked at.
void resolve_weighted(const EnvironmentRequest& request, std::size_t pixel, const DrawnPixel& drawn,
                      std::span<const std::uint32_t> blocked, EnvironmentResult& result);

}  // namespace sightlines::visibility_field
