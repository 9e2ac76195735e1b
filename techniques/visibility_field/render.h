// Algorithm 2: environment light by rays, of which the field discards those whose answer it knows.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "shaders/harmonic_light_data.h"
#include "techniques/base/image.h"
#include "techniques/base/progress.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/scene/environment_light.h"
#include "techniques/scene/surface_buffer.h"
#include "techniques/technique.h"
#include "techniques/visibility_field/dense_field.h"
#include "techniques/visibility_field/field.h"
#include "techniques/visibility_field/sample_pattern.h"

namespace sightlines::visibility_field {

/// Which rays are traced. `label`: those inside the region that the cell's label names (the paper). `visible`: those
/// inside the visible region, labels or not (Figure 9). `both`: those that some point of the cell saw open and some
/// blocked, or that none looked at; what all agreed on is taken for granted.
enum class Culling { label, visible, both };

/// What the occluded irradiance is subtracted from (equation 11). `analytic`: the irradiance of the harmonics, as in
/// the paper. `sampled`: the mean over the pixel's own samples, so that the picture is that of the same samples without
/// a field.
enum class Unshadowed { analytic, sampled };

/// In which order Embree gets the rays that are traced. `pixel`: those of a pixel one after the other, as on a GPU.
/// `direction`: those of a few hundred pixels sorted by direction, so that a packet's rays go the same way. Answers
/// every ray alike.
enum class RayOrder { pixel, direction };

/// How samples are drawn. `cosine`: as in the paper. `brdf`: as the surface reflects. `map`: where the surroundings are
/// bright. `both`: half of them so, half by the surface.
enum class Sampling { cosine, brdf, map, both };

struct EnvironmentResult;

struct EnvironmentRequest {
    const SurfaceBuffer* surfaces = nullptr;
    const SamplePattern* pattern = nullptr;
    Harmonics light;  ///< turned as it stands
    const DenseField* dense =
        nullptr;  ///< read the cells from here, the field's own in the paper's layout; may be null
    Culling culling = Culling::label;
    Unshadowed unshadowed = Unshadowed::analytic;
    RayOrder order = RayOrder::direction;
    Sampling sampling = Sampling::cosine;
    bool glossy = false;  ///< surfaces reflect by their gloss, else evenly. Cells' labels are then ignored (Figure 10)
    float roughness = 0.0f;                         ///< of all glossy surfaces; 0: each one's own
    const EnvironmentLight* map = nullptr;          ///< what sends light, instead of `light`; may be null
    const MapDistribution* distribution = nullptr;  ///< not null where samples are drawn by the map
    int threads = 0;                                ///< 0: all. Never changes the result
    bool reverse_tiles = false;                     ///< work through the tiles backwards. Never changes the result
    bool keep_verdicts = false;                     ///< also return every sample's answer
    /// Called with each finished part of the picture, from worker threads, one call at a time. May be empty.
    std::function<void(const EnvironmentResult& so_far, PixelRect changed)> on_region = {};
};

/// Whether samples have weights of their own, instead of the paper's that all weigh the same.
inline bool is_weighted(const EnvironmentRequest& request) {
    return request.glossy || request.sampling != Sampling::cosine || request.map != nullptr;
}

/// The request's culling; of glossy surfaces labels are ignored.
inline Culling culling_used(const EnvironmentRequest& request) {
    return request.glossy && request.culling == Culling::label ? Culling::visible : request.culling;
}

/// What became of all samples. A sample that points below its surface counts as blocked without a ray.
struct SampleCounts {
    std::uint64_t samples = 0;
    std::uint64_t below = 0;           ///< point into their own surface
    std::uint64_t traced = 0;          ///< by Embree
    std::uint64_t traced_blocked = 0;  ///< of those
    std::uint64_t outside = 0;         ///< of the traced, from cells without masks
    std::uint64_t discarded() const { return samples - below - traced; }

    bool operator==(const SampleCounts&) const = default;
};

void add(SampleCounts& sum, const SampleCounts& counts);

/// Pictures of the surfaces' size; the background is black and traces nothing.
struct EnvironmentResult {
    ImageRgb irradiance;               ///< W/m^2; of glossy surfaces pi times what they reflect
    ImageRgb radiance;                 ///< emission + albedo / pi * irradiance
    Image<std::uint32_t> rays_traced;  ///< of each pixel, second ones too
    Image<std::uint32_t> rays_asked;   ///< samples of each pixel that are above its surface
    ImageScalar shadow;                ///< share of these that count as blocked
    Verdicts verdicts;  ///< bit k: sample k is above the surface and counts as blocked; empty unless asked for
    SampleCounts counts;
    SampleCounts second_rays;  ///< of indirect light (one_bounce.h): a sample for each surface that was hit
    SampleCounts area_rays;  ///< of local area lights (area_lights.h): a sample that cannot shine here counts as below
    double seconds = 0.0;
    std::string device;
};

/// The kernels' form of a light.
HarmonicLight harmonic_light(const Harmonics& harmonics);

/// Sums of the nine polynomials over some directions of a pixel.
using PixelMoments = std::array<float, 9>;

/// pi / samples times the sum of radiances.
vec3 irradiance_of(const HarmonicLight& light, const PixelMoments& moments, int samples);

/// What a surface sends to the camera under this irradiance: emission + albedo / pi * irradiance; a glossy one's
/// irradiance already is what it reflects, times pi.
vec3 reflected_radiance(const EnvironmentRequest& request, std::size_t pixel, vec3 irradiance);

/// A result of the request's size in which nothing was asked yet, with room for verdicts where they are kept.
EnvironmentResult blank_environment(const EnvironmentRequest& request);

/// Samples of any weight (is_weighted). Without a field (null) every sample above its surface is traced: the reference,
/// by the same code. The hemisphere is that of the shading normal.
EnvironmentResult render_environment(const VisibilityField* field, const EmbreeScene& embree,
                                     const EnvironmentRequest& request, Progress& progress);

/// The same samples, but nothing is traced or shaded: only how many rays would be, and how long finding out takes.
SampleCounts count_samples(const VisibilityField* field, const EnvironmentRequest& request, double& seconds);

/// A ray that the field discarded although Embree answers it otherwise.
struct WrongRay {
    std::uint32_t pixel = 0, sample = 0;
    vec3 direction{0.0f};
    bool taken_for_blocked = false;  ///< else for open
};

struct WrongRays {
    std::uint64_t discarded = 0;  ///< rays that were looked at
    std::uint64_t wrong = 0;
    std::vector<WrongRay> first;  ///< at most as many as asked for, by pixel and sample
};

/// Casts all discarded rays too. Slow: for finding faults.
WrongRays find_wrong_rays(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                          std::size_t most, Progress& progress);

/// How far a picture of irradiance is from another, over the pixels that show a surface and all channels.
struct IrradianceError {
    double mean_absolute = 0.0, rmse = 0.0, max_absolute = 0.0;
    double mean_reference = 0.0;   ///< of the reference
    double mean_unshadowed = 0.0;  ///< of the same surfaces with nothing in the way
    /// Of the mean unshadowed irradiance: what a picture exposed for daylight shows.
    double rmse_percent() const { return mean_unshadowed > 0.0 ? 100.0 * rmse / mean_unshadowed : 0.0; }
    /// Of the mean irradiance, which may be far less.
    double rmse_percent_of_mean() const { return mean_reference > 0.0 ? 100.0 * rmse / mean_reference : 0.0; }
};
IrradianceError compare_irradiance(const EnvironmentResult& ours, const EnvironmentResult& reference,
                                   const EnvironmentRequest& request);

}  // namespace sightlines::visibility_field
