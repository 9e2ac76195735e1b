// The two marching techniques' rows in the catalog.
#include <array>
#include <memory>

#include "techniques/baselines/baselines.h"
#include "techniques/baselines/marching/voxel_grid.h"
#include "techniques/baselines/tiles.h"

namespace sightlines::baselines {
namespace {

using VoxelizationPointer = std::shared_ptr<const Voxelization>;

const Voxelization& voxelization(const Structure& structure) {
    return *std::any_cast<const VoxelizationPointer&>(structure);
}

constexpr std::string_view name_of(March march) { return march == March::voxels ? "voxel_marching" : "row_marching"; }

template <March march>
Structure build(const BuildRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, name_of(march));
    const auto value = [&](std::string_view name) {
        return parameter_value(marching_parameters(), request.parameters, name);
    };
    VoxelOptions options;
    options.resolution = static_cast<int>(value("resolution"));
    options.shape = value("shape") == 0.0 ? VoxelShape::fitted : VoxelShape::cubes;
    options.samples_per_voxel = value("samples_per_voxel");
    options.distances = march == March::rows;
    options.threads = request.threads;
    return VoxelizationPointer(std::make_shared<const Voxelization>(voxelize(*request.scene, options, progress)));
}

template <March march>
RenderResult render(const Structure& structure, const RenderRequest& request, Progress& progress) {
    refuse_vulkan(request.backend, name_of(march));
    return render_by_marching(voxelization(structure), march, request, progress);
}

template <March march>
Trace trace(const Structure& structure, const TraceRequest& request) {
    return trace_march(voxelization(structure), march, request);
}

Statistics statistics(const Structure& structure) {
    const Voxelization& voxels = voxelization(structure);
    const double all = static_cast<double>(voxels.cells.x) * voxels.cells.y * voxels.cells.z;
    Statistics statistics;
    statistics.structure_bytes = voxels.bytes();
    statistics.uncompressed_bytes = voxels.bytes();
    statistics.build_seconds = voxels.build_seconds;
    statistics.values = {{"voxels", all, ""},
                         {"occupied voxels", static_cast<double>(voxels.occupied), ""},
                         {"occupied share", 100.0 * static_cast<double>(voxels.occupied) / all, "%"},
                         {"voxels along x", static_cast<double>(voxels.cells.x), ""},
                         {"voxels along y", static_cast<double>(voxels.cells.y), ""},
                         {"voxels along z", static_cast<double>(voxels.cells.z), ""}};
    return statistics;
}

constexpr std::array<std::string_view, 3> voxel_stages{"fragments", "voxelization", "shadow rays"};
constexpr std::array<std::string_view, 4> row_stages{"fragments", "voxelization", "distances along rows",
                                                     "shadow rays"};

}  // namespace

const Technique& voxel_marching() {
    static const Technique row{
        "voxel_marching",
        "Voxel marching",
        "J. Amanatides, A. Woo: A Fast Voxel Traversal Algorithm for Ray Tracing. Eurographics, 1987; the diagonal "
        "tracing of L. Wang et al., IEEE TVCG, 2017, Table 7",
        "The scene is voxelised once, unrotated; a shadow ray visits every voxel on its way.",
        voxel_stages,
        marching_parameters(),
        build<March::voxels>,
        render<March::voxels>,
        trace<March::voxels>,
        statistics,
        false};
    return row;
}

const Technique& row_marching() {
    static const Technique row{
        "row_marching",
        "Row marching",
        "L. Wang, X. Liang, C. Meng, V. Popescu: Fast Ray-Scene Intersection for Interactive Shadow Rendering with "
        "Thousands of Dynamic Lights. IEEE TVCG, 2017, section 6.2, after Table 7",
        "One voxelization that knows the next occupied voxel along each row; a shadow ray visits every row on its way.",
        row_stages,
        marching_parameters(),
        build<March::rows>,
        render<March::rows>,
        trace<March::rows>,
        statistics,
        false};
    return row;
}

std::vector<Box3> occupied_boxes(const Structure& structure) {
    const Voxelization& voxels = voxelization(structure);
    const vec3 size = 1.0f / voxels.grid.voxels_per_metre;
    std::vector<Box3> boxes;
    for (int z = 0; z < voxels.cells.z; ++z)
        for (int y = 0; y < voxels.cells.y; ++y)
            for (int x = 0; x < voxels.cells.x; ++x) {
                if (!voxels.at({x, y, z})) continue;
                const vec3 corner = voxels.grid.lowest + vec3(x, y, z) * size;
                boxes.push_back({corner, corner + size});
            }
    return boxes;
}

QueryCount count_by_voxel_marching(const Structure& structure, const RenderRequest& request) {
    refuse_vulkan(request.backend, name_of(March::voxels));
    return count_by_marching(voxelization(structure), March::voxels, request);
}

QueryCount count_by_row_marching(const Structure& structure, const RenderRequest& request) {
    refuse_vulkan(request.backend, name_of(March::rows));
    return count_by_marching(voxelization(structure), March::rows, request);
}

}  // namespace sightlines::baselines
