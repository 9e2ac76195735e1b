#include "techniques/voxel_rows/voxel_rows.h"

#include <array>

#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/vulkan_backend.h"

namespace sightlines::voxel_rows {
namespace {

struct BuiltRows {
    RowArray array;
    std::shared_ptr<const VulkanRows> on_device;  ///< where it was built for Vulkan
};
using BuiltRowsPointer = std::shared_ptr<const BuiltRows>;

constexpr std::array<std::string_view, 2> builds{"fragments", "direct"};

constexpr std::array<Parameter, 10> parameters{{
    {"resolution", "Resolution", "voxels", ParameterKind::integer, ParameterAffects::structure, 32, 256, 128, 128,
     "Voxels along each axis of each rotated voxelization; a row holds that many bits."},
    {"angle_step", "Angle step", "deg", ParameterKind::real, ParameterAffects::structure, 1, 6, 2, 2,
     "Between neighbouring directions of the array; memory goes with its inverse square."},
    {"build", "Build", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 0, std::nullopt,
     "Fragments splatted into all directions (Algorithm 6), or each direction voxelised from the triangles (Algorithm "
     "1).",
     builds},
    {"samples_per_voxel", "Samples per voxel", "", ParameterKind::real, ParameterAffects::structure, 0.5, 3, 2,
     std::nullopt, "Surface fragments along each voxel's edge, for the build from fragments."},
    {"coverage", "Coverage", "", ParameterKind::real, ParameterAffects::structure, 0, 1, 0.5, 0.0,
     "Share of a voxel's cross-section that surfaces in it and its neighbour along the row must cover to set it; 0: "
     "any "
     "fragment sets it, as in the paper."},
    {"inset", "Inset", "voxels", ParameterKind::real, ParameterAffects::structure, 0, 1, 0.35, 0.0,
     "How far below the surface of a solid (a one-sided material) its fragments lie, in voxels of the scene's longest "
     "side."},
    {"start_offset", "Start offset along the row", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 8, 1.5,
     std::nullopt, "Voxels left out at the surface, which would otherwise shadow itself."},
    {"normal_offset", "Start offset along the normal", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 4,
     0.4, std::nullopt, "How far off the surface the ray starts, in voxels of the scene's longest side."},
    {"light_offset", "Light-end offset", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 8, 0.5,
     std::nullopt, "Voxels left out at the light."},
    {"subrays", "Rows per ray", "", ParameterKind::integer, ParameterAffects::picture, 1, 2, 1, 1,
     "One row for the whole ray, or one for each half (the paper: 4 % better, 45 % slower)."},
}};

constexpr std::array<std::string_view, 4> stages{"fragments", "rotated voxelizations", "rows", "shadow rays"};

const BuiltRows& built_rows(const Structure& structure) { return *std::any_cast<const BuiltRowsPointer&>(structure); }

Structure build(const BuildRequest& request, Progress& progress) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, request.parameters, name); };
    BuildOptions options;
    options.resolution = static_cast<int>(value("resolution"));
    options.angle_step_deg = value("angle_step");
    options.samples_per_voxel = value("samples_per_voxel");
    options.coverage = value("coverage");
    options.inset = value("inset");
    options.threads = request.threads;
    auto built = std::make_shared<BuiltRows>();
    built->array = value("build") == 0.0 ? build_from_fragments(*request.scene, options, progress)
                                         : build_directly(*request.scene, options, progress);
    if (request.backend == Backend::vulkan) built->on_device = give_to_vulkan(built->array, progress);
    return BuiltRowsPointer(built);
}

/// The structure's copy on the device, or one made for this call where it was built for the CPU.
std::shared_ptr<const VulkanRows> on_device(const BuiltRows& built, Progress& progress) {
    return built.on_device ? built.on_device : give_to_vulkan(built.array, progress);
}

RenderResult render(const Structure& structure, const RenderRequest& request, Progress& progress) {
    const BuiltRows& built = built_rows(structure);
    if (request.backend == Backend::cpu) return render_on_cpu(built.array, request, progress);
    return render_on_vulkan(*on_device(built, progress), built.array, request, progress);
}

Trace trace_structure(const Structure& structure, const TraceRequest& request) {
    return trace(built_rows(structure).array, request);
}

Statistics statistics(const Structure& structure) {
    const RowArray& array = built_rows(structure).array;
    Statistics statistics;
    statistics.structure_bytes = array.words.bytes();
    statistics.uncompressed_bytes = array.words.bytes();
    statistics.build_seconds = array.build_seconds;
    statistics.values = {{"directions", static_cast<double>(array.grid.frames.size()), ""},
                         {"angle step", 180.0 / array.grid.angles, "deg"},
                         {"rows", static_cast<double>(array.grid.rows()), ""},
                         {"fragments", static_cast<double>(array.fragments), ""}};
    return statistics;
}

constexpr Technique row{
    "voxel_rows",
    "Voxel rows",
    "L. Wang, X. Liang, C. Meng, V. Popescu: Fast Ray-Scene Intersection for Interactive Shadow Rendering with "
    "Thousands "
    "of Dynamic Lights. IEEE TVCG, 2017",
    "The scene is voxelised from every direction; a shadow ray is one row of bits, cut to the ray's extent.",
    stages,
    parameters,
    build,
    render,
    trace_structure,
    statistics};

}  // namespace

const Technique& technique() { return row; }

const RowArray& row_array(const Structure& structure) { return built_rows(structure).array; }

QueryCount count_blocked(const Structure& structure, const RenderRequest& request) {
    const BuiltRows& built = built_rows(structure);
    if (request.backend == Backend::cpu) return count_blocked_on_cpu(built.array, request);
    Progress progress;
    return count_blocked_on_vulkan(*on_device(built, progress), built.array, request);
}

}  // namespace sightlines::voxel_rows
