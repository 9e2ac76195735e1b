// What the papers compare with, each a technique of its own: Wang 2017, section 6. Their rows in the catalog, and what
// a benchmark asks beyond that.
#pragma once

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

}  // namespace sightlines::baselines
