// The ray that a session points at: which pixel's, and to which light.
#pragma once

#include <vector>

#include "app/results.h"
#include "app/session.h"

namespace sightlines {

/// One shadow ray of the picture, or one sample of the environment, which is a directional light here; recorded by the
/// technique and judged by Embree.
struct SelectedRay {
    ivec2 pixel{0};
    std::uint32_t light = 0;
    TraceRequest request;
    Trace trace;
    bool truly_blocked = false;
};

/// The ray that the session selects. A pixel that is not selected becomes the one nearest to the picture's middle that
/// asks any ray; a light that is not, the first that the technique judges wrongly there, else the first that is
/// blocked, else the first. InputError where the selected pixel lies outside or shows the background, or the light does
/// not exist or stands behind the surface.
SelectedRay select_ray(const Session& session, Results& results, Progress& progress);

struct PixelRays;
/// The same, where the pixel's rays are known already.
SelectedRay select_ray(const Session& session, const PixelRays& rays, Results& results, Progress& progress);

/// One light ray of a pixel: our verdict and the true one.
struct RayRow {
    std::uint32_t light = 0;
    bool blocked = false, truly_blocked = false;
    float distance_m = 0.0f;  ///< from the surface to the light; of a directional light, to the end of the scene

    bool wrong() const { return blocked != truly_blocked; }
};

/// All light rays that a pixel asks, by light.
struct PixelRays {
    ivec2 pixel{0};
    std::vector<RayRow> rows;
};

/// Every ray of the pixel that the session selects (the one that select_ray takes), judged by the technique and by
/// Embree. InputError as select_ray.
PixelRays pixel_rays(const Session& session, Results& results, Progress& progress);

/// What a pixel that shows a surface may ask: the session's lights, or the pixel's own samples of the environment as
/// directional lights.
std::vector<Light> pixel_lights(const Session& session, std::size_t pixel, Results& results, Progress& progress);

/// The lights in front of a surface, in order: those that its pixel asks.
std::vector<std::uint32_t> asked_lights(const SurfaceBuffer& surfaces, std::size_t pixel,
                                        const std::vector<Light>& lights);

}  // namespace sightlines
