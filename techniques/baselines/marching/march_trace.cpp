// One ray through the recording compilation of the marching kernels.
#include "shaders/recording.h"  // first: makes the kernels below record

#include "shaders/voxel_march.h"
#include "techniques/baselines/marching/voxel_grid.h"
#include "techniques/baselines/trace_values.h"
#include "techniques/rays/light_records.h"
#include "techniques/trace_boxes.h"

namespace sightlines::baselines {
namespace {

namespace kernel = recording_kernel;

/// Voxels first .. last of a row, or one voxel, as a box in the world.
TraceGeometry voxel_box(const char* name, const VoxelGrid& grid, ivec3 first, int count) {
    const vec3 size = 1.0f / grid.voxels_per_metre;
    return box_geometry(name,
                        {grid.lowest + vec3(first) * size, grid.lowest + vec3(first + ivec3(count, 1, 1)) * size});
}

/// Undoes voxel_number().
ivec3 voxel_of(const VoxelGrid& grid, int number) {
    return {number % grid.stride_y - 1, number % grid.stride_z / grid.stride_y - 1, number / grid.stride_z - 1};
}

/// What the numbers of the steps mean in space.
void add_geometry(std::vector<TraceStep>& steps, const VoxelGrid& grid) {
    for (TraceStep& step : steps) {
        if (const auto number = whole_value(step, "march.voxel")) {
            const ivec3 voxel = voxel_of(grid, *number);
            step.values.push_back({"place", vec3(voxel), "voxels"});
            step.geometry.push_back(voxel_box("voxel", grid, voxel, 1));
        }
        const auto row = whole_value(step, "march.row"), x = whole_value(step, "march.x"),
                   last = whole_value(step, "last");
        if (row && x && last) {
            const ivec3 voxel(std::min(*x, *last), *row % grid.rows_per_layer - 1, *row / grid.rows_per_layer - 1);
            step.values.push_back({"place", vec3(voxel), "voxels"});
            step.geometry.push_back(voxel_box("part of the row", grid, voxel, std::abs(*last - *x) + 1));
        }
    }
}

}  // namespace

Trace trace_march(const Voxelization& voxels, March march, const TraceRequest& request) {
    const VoxelGrid query = make_query(voxels, request.parameters);
    Trace trace;
    const vec3 to_light = kernel::to_light(light_record(request.light), request.position, query.reach_m);
    trace.ray = {request.position, request.position + to_light};
    {
        kernel::Recording recording;
        trace.blocked = march == March::voxels
                            ? kernel::is_blocked_by_voxels(query, {voxels.bits.data()}, request.position,
                                                           request.normal, trace.ray.target, true)
                            : kernel::is_blocked_by_rows(query, {voxels.distances.data()}, request.position,
                                                         request.normal, trace.ray.target, true);
        trace.steps = std::move(recording.steps);
    }
    add_geometry(trace.steps, query);
    return trace;
}

}  // namespace sightlines::baselines
