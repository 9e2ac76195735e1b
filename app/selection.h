// The ray that a session points at: which pixel's, and to which light.
#pragma once

#include <vector>

#include "app/results.h"
#include "app/session.h"

namespace sightlines {

/// One shadow ray of the picture, recorded by the technique and judged by Embree.
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

/// The lights in front of a surface, in order: those that its pixel asks.
std::vector<std::uint32_t> asked_lights(const SurfaceBuffer& surfaces, std::size_t pixel,
                                        const std::vector<Light>& lights);

}  // namespace sightlines
