// Samples whose weights differ: by the reflection of glossy surfaces, by a map of the surroundings, or by both (Veach
// and Guibas 1995). Those of the paper, by the cosine, all weigh the same. By vectors: shaders/weighted_samples.h.
#pragma once

#include <vector>

#include "shaders/weighted_samples_data.h"
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

/// A pixel's surface, and how many samples are drawn each way, in this order.
struct WeightedPixel {
    SampledSurface surface{};
    std::uint32_t cosine = 0, mirrored = 0, map = 0;
};
WeightedPixel weighted_pixel(const EnvironmentRequest& request, std::size_t pixel);

/// About what share of even light a glossy pixel reflects; never zero.
vec3 reflecting_colour(const EnvironmentRequest& request, std::size_t pixel);

/// What is the same for all pixels of a picture.
struct WeightedTables {
    std::vector<float> ordinal;  ///< k + 1/2
    std::vector<float> inverse;  ///< the radical inverse of k; as many as samples, and a vector more
    HarmonicLight harmonics{};
    MapShape map{};                          ///< of the map that sends light
    const float* texels = nullptr;           ///< its own; null: the harmonics send light
    const MapDistribution* draws = nullptr;  ///< null where no sample is drawn by the map
};
WeightedTables weighted_tables(const EnvironmentRequest& request);

/// The same as above, with the request's tables made once for many pixels.
std::vector<PixelSample> weighted_samples(const EnvironmentRequest& request, const WeightedTables& tables,
                                          std::size_t pixel);

}  // namespace sightlines::visibility_field
