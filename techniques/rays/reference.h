// The same picture by ray tracing, and how far another one is from it.
#pragma once

#include <span>
#include <string_view>

#include "techniques/rays/embree_scene.h"
#include "techniques/technique.h"

namespace sightlines {

/// Every ray of `request` by Embree (request.parameters and backend are not looked at), with verdicts where asked.
RenderResult render_reference(const EmbreeScene& embree, const RenderRequest& request, Progress& progress);

/// How the benchmark asks Embree. All ask the same rays: light in front of the surface, from the light to the surface.
enum class EmbreeVariant { single, packet_8, packet_16, stream };

struct QueryCount {
    std::uint64_t rays = 0, blocked = 0;
    double seconds = 0.0;
};

/// Only asks and counts; no shading. The fastest way we know to use each variant.
QueryCount count_blocked(const EmbreeScene& embree, EmbreeVariant variant, const SurfaceBuffer& surfaces,
                         std::span<const Light> lights, int threads);

struct ErrorMetrics {
    double visibility_percent =
        0.0;  ///< Wang 2017, epsilon_v: share of a pixel's asked rays judged wrongly, mean over pixels
    double shadow_percent = 0.0;  ///< epsilon_s: |difference of shadow values|, mean over pixels
    /// The same as rays of a pixel. Divided by the number of lights they are what the paper's example counts, for which
    /// a light behind the surface is a right answer too; above, only rays that are asked count.
    double wrong_rays = 0.0, uncancelled_rays = 0.0;
    double rmse = 0.0;  ///< of linear radiance, over all channels and pixels
    double max_abs = 0.0;
    ImageScalar visibility_error;  ///< [P] share in [0, 1]; NaN on the background
    ImageScalar shadow_error;      ///< [P] signed, ours minus reference; NaN on the background
};

/// Means are over the pixels that asked at least one ray. Both results must hold verdicts.
ErrorMetrics compare(const RenderResult& ours, const RenderResult& reference);

}  // namespace sightlines
