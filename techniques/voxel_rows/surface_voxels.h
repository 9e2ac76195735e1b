// What first hits are coloured with: the scene voxelised once, not rotated, with the colour and the normal of the
// surface in each voxel (Wang 2017, section 7: future work).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/scene.h"

namespace sightlines::voxel_rows {

/// 8 bytes a voxel, [N^3], x fastest, then y, then z; N cells along the longest side of the box, cubes.
struct SurfaceVoxels {
    Box3 bounds;  ///< m
    ivec3 cells{0};
    float cell_m = 0.0f;
    std::vector<glm::u8vec4> colours;  ///< linear albedo, 8 bits; w: 0 where no surface is
    std::vector<glm::i8vec4> normals;  ///< unit, 7 bits and sign

    std::uint64_t bytes() const { return colours.size() * (sizeof(glm::u8vec4) + sizeof(glm::i8vec4)); }
};

/// Mean colour and mean normal, by area, of what lies in each voxel.
SurfaceVoxels voxelize_surface(const Scene& scene, int resolution, int threads, Progress& progress);

/// The surface at a point: of its voxel or, where that is empty, of the nearest one next to it.
struct VoxelSurface {
    vec3 albedo{0.0f};
    vec3 normal{0.0f};  ///< unit; may point away from whoever looks
};
std::optional<VoxelSurface> surface_at(const SurfaceVoxels& voxels, vec3 point);

}  // namespace sightlines::voxel_rows
