// What the papers compare with, each a technique of its own: Wang 2017, section 6. Their rows in the catalog, and what
// a benchmark asks beyond that.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "techniques/rays/reference.h"
#include "techniques/technique.h"

namespace sightlines::baselines {

const Technique& voxel_marching();
const Technique& row_marching();
const Technique& shadow_maps();
const Technique& imperfect_shadow_maps();
const Technique& ray_tracing();

/// Asks all rays of the request on the CPU and counts them; no shading. The maps of lights are part of the work.
QueryCount count_by_voxel_marching(const Structure& structure, const RenderRequest& request);
QueryCount count_by_row_marching(const Structure& structure, const RenderRequest& request);
QueryCount count_by_shadow_maps(const Structure& structure, const RenderRequest& request);
QueryCount count_by_imperfect_shadow_maps(const Structure& structure, const RenderRequest& request);
QueryCount count_by_ray_tracing(const Structure& structure, const RenderRequest& request);

/// A map that a light's ray was looked up in, for the view inside.
struct LookedUpMap {
    std::string title;            ///< "+X", "front"
    int side = 0;                 ///< texels
    std::vector<float> nearness;  ///< [side][side], as ShadowMapShape says; 0: nothing there
    std::optional<ivec2> asked;   ///< column and row of the ray's texel, where it is in this map
};

/// All maps of the request's light, of which `traced` is the recorded ray: six faces, two paraboloids, or one.
/// Imperfect ones as they are drawn first, without their holes filled, and then as they are looked up. For structures
/// of shadow_maps and imperfect_shadow_maps.
std::vector<LookedUpMap> looked_up_maps(const Structure& structure, const TraceRequest& request, const Trace& traced);
std::vector<LookedUpMap> looked_up_imperfect_maps(const Structure& structure, const TraceRequest& request,
                                                  const Trace& traced);

/// The occupied voxels of a marching technique's structure, as boxes, m.
std::vector<Box3> occupied_boxes(const Structure& structure);

}  // namespace sightlines::baselines
