// Two demonstrations of first hits (Wang 2017, section 7: future work): ambient occlusion, which needs to know how far
// the first hit is, and mirrors, which need to know what it looks like.
#pragma once

#include "techniques/base/image.h"
#include "techniques/scene/surface_buffer.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/surface_voxels.h"
#include "techniques/voxel_rows/vulkan_backend.h"

namespace sightlines::voxel_rows {

/// Who is asked for first hits.
struct HitQuery {
    const RowArray& array;
    RowShape shape;                         ///< of make_query, without lights
    const VulkanRows* on_device = nullptr;  ///< the array there; by the CPU where there is none
};

struct OcclusionOptions {
    int rays = 16;         ///< a pixel, cosine-distributed
    float reach_m = 1.0f;  ///< a hit counts 1 - distance / reach
    std::uint64_t seed = 1;
    int threads = 0;
};

/// [P] how open each surface is, 0 to 1; 1 on the background.
ImageScalar ambient_openness(const HitQuery& query, const SurfaceBuffer& surfaces, const OcclusionOptions& options,
                             Progress& progress);

/// The way on of the camera's ray through the pixel, if the surface were a mirror. Unit.
vec3 mirrored_direction(const SurfaceBuffer& surfaces, std::size_t pixel);

/// What each surface would show if it were a mirror: the voxels that the reflected camera rays hit first, as surfaces
/// to be lit like others. no_triangle where they hit nothing.
SurfaceBuffer mirrored_surfaces(const HitQuery& query, const SurfaceVoxels& voxels, const SurfaceBuffer& surfaces,
                                int threads, Progress& progress);

/// A direction about `normal`, with probability proportional to the cosine, of two uniform numbers (Malley's method).
vec3 cosine_direction(vec3 normal, float u, float v);

}  // namespace sightlines::voxel_rows
