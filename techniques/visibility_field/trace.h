// One sample of one pixel, step by step.
#pragma once

#include <optional>
#include <string>

#include "techniques/technique.h"
#include "techniques/visibility_field/bake.h"
#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

enum class Fate { below_surface, outside_cells, traced, taken_for_blocked, taken_for_open };

/// A sample as the renderer treats it, and the truth beside it.
struct SampleTrace {
    Trace trace;  ///< the ray, whether it counts as blocked, and the kernel's steps
    Fate fate = Fate::traced;
    ivec3 cell{0};  ///< its place in the grid
    std::uint32_t cell_index = 0;
    std::uint32_t label = 0;
    ivec2 texel{0};  ///< column, row
    bool visible_bit = false, occluded_bit = false;
    bool blocked_in_truth = false;  ///< by Embree
    vec3 adds{0.0f};                ///< to the pixel's irradiance, W/m^2; what is subtracted is negative
    vec3 comes_back{0.0f};          ///< radiance from what it hit, by the second ray

    bool is_wrong() const {
        return (fate == Fate::taken_for_blocked && !blocked_in_truth) ||
               (fate == Fate::taken_for_open && blocked_in_truth);
    }
};

/// A sample by itself.
struct SampleRay {
    vec3 position{0.0f}, normal{0.0f};  ///< of the surface, m and unit, as in SurfaceBuffer
    vec3 direction{0.0f};               ///< unit
    vec3 share{0.0f};                   ///< what it adds to the irradiance where nothing is in the way, W/m^2
};

/// The ray of sample `sample` of a pixel that shows a surface.
SampleRay sample_ray(const EnvironmentRequest& request, std::size_t pixel, int sample);

/// A sample as the renderer treats it, by the recording kernel.
SampleTrace trace_sample(const VisibilityField& field, const EmbreeScene& embree, Culling culling,
                         const SampleRay& ray);

/// Sample `sample` (of the pattern) of the pixel (x, y), which must show a surface, by the recording kernel.
SampleTrace trace_sample(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                         int x, int y, int sample);

/// Of a sample that is blocked: what it hit, the ray that lights that and what of it comes back, as further steps.
/// Nothing where it hit nothing. `request`: its light, how that is drawn, and culling.
void add_second_ray(const VisibilityField& field, const EmbreeScene& embree, const Scene& scene,
                    const EnvironmentRequest& request, std::uint64_t seed, const SampleRay& ray, SampleTrace& traced);

/// For a ray that was discarded wrongly: the point samples of the cell that might have kept it.
struct NearestSamples {
    std::size_t points = 0;  ///< in the cell
    float nearest_m = 0.0f;  ///< from the pixel's surface point to the nearest of them
    SurfacePoint nearest;
    std::size_t facing = 0;  ///< of them, with the ray's direction in front of them
    /// The nearest of the points from which Embree answers the ray's direction as it answers the pixel's: a ray cast
    /// from there in this direction would have kept it.
    std::optional<SurfacePoint> should_have_seen;
    float should_have_seen_m = 0.0f;
};

/// `samples`: of the cell that it was looked up in (samples_in).
NearestSamples nearest_samples(const CellPoints& samples, const EmbreeScene& embree, const SampleTrace& traced);

}  // namespace sightlines::visibility_field
