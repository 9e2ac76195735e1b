// One unrotated voxelization: bits, and for marching by rows the distances to the next occupied voxel of each row.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shaders/voxel_march.h"
#include "techniques/rays/reference.h"
#include "techniques/technique.h"

namespace sightlines::baselines {

enum class VoxelShape { fitted, cubes };

struct VoxelOptions {
    int resolution = 128;  ///< voxels along the longest side (cubes) or along every side (fitted)
    VoxelShape shape = VoxelShape::fitted;
    double samples_per_voxel = 2.0;  ///< of the surface, along each axis
    bool distances = false;          ///< also those of the rows
    int threads = 0;
};

struct Voxelization {
    VoxelGrid grid;                        ///< offsets are left at zero
    ivec3 cells{1};                        ///< voxels along each axis
    Box3 box;                              ///< of the grid, m
    float reach_m = 1.0f;                  ///< how far directional lights are put away
    std::vector<std::uint32_t> bits;       ///< in the order of voxel_number(), the layer of empty voxels included
    std::vector<std::uint32_t> distances;  ///< bytes; along x, then against x (VoxelGrid::backward_words); or empty
    std::size_t occupied = 0;
    double build_seconds = 0.0;

    bool at(ivec3 voxel) const;
    std::size_t bytes() const { return (bits.size() + distances.size()) * sizeof(std::uint32_t); }
};

/// Any sample of the surface sets the voxel that it lies in (the paper's rule). A scene without triangles gives a grid
/// without occupied voxels. EnvironmentError where the memory is not there.
Voxelization voxelize(const Scene& scene, const VoxelOptions& options, Progress& progress);

/// For each voxel of a row the number of voxels to the next occupied one, itself included (0); 255: none. A voxel that
/// is exactly 255 away (the far end of a row of 256) counts as 254 away. `step` 1: towards greater x, -1: towards less.
void row_distances(const std::vector<bool>& occupied, int step, std::span<std::uint8_t> distances);

/// The grid with the offsets that the parameters ask for.
VoxelGrid make_query(const Voxelization& voxels, const ParameterValues& parameters);

/// The parameters that both marching techniques have.
std::span<const Parameter> marching_parameters();

/// By the scalar kernel. The segment starts on the surface with this normal; all offsets are applied.
bool is_blocked_by_voxels(const Voxelization& voxels, const VoxelGrid& query, const Segment& segment, vec3 normal);
bool is_blocked_by_rows(const Voxelization& voxels, const VoxelGrid& query, const Segment& segment, vec3 normal);

enum class March { voxels, rows };

/// The same for many rays by the wide kernel; answers[k] is 0 or 1. Sizes are equal.
void are_blocked(const Voxelization& voxels, const VoxelGrid& query, March march, std::span<const Segment> segments,
                 std::span<const vec3> normals, std::span<std::uint8_t> answers);

RenderResult render_by_marching(const Voxelization& voxels, March march, const RenderRequest& request,
                                Progress& progress);
QueryCount count_by_marching(const Voxelization& voxels, March march, const RenderRequest& request);
Trace trace_march(const Voxelization& voxels, March march, const TraceRequest& request);

}  // namespace sightlines::baselines
