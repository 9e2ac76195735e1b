#include "techniques/voxel_rows/voxel_rows.h"

#include <array>

#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/voxel_rows/array_cache.h"
#include "techniques/voxel_rows/dictionary.h"
#include "techniques/voxel_rows/memory_need.h"
#include "techniques/voxel_rows/moving_rows.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/vulkan_backend.h"

namespace sightlines::voxel_rows {
namespace {

struct BuiltRows {
    RowArray array;
    Moment moment;                                ///< whose memory the array is, where the scene moves
    std::shared_ptr<const VulkanRows> on_device;  ///< where it was built for Vulkan
};
using BuiltRowsPointer = std::shared_ptr<const BuiltRows>;

constexpr std::uint64_t cache_limit_bytes = std::uint64_t{4} << 30u;  // ten arrays of the usual size

constexpr std::array<std::string_view, 2> builds{"fragments", "direct"};

constexpr std::array<std::string_view, 2> dictionary_choices{"frequent", "covering"};
constexpr std::array<std::string_view, 2> leftover_rows{"random", "nearest"};
constexpr std::array<std::string_view, 2> index_bits{"20", "32"};

constexpr std::array<std::string_view, 2> motions{"changes", "whole"};

constexpr std::array<Parameter, 17> parameters{{
    {"resolution", "Resolution", "voxels", ParameterKind::integer, ParameterAffects::structure, 32, 256, 128, 128,
     "Voxels along each axis of each rotated voxelization; a row holds that many bits."},
    {"angle_step", "Angle step", "deg", ParameterKind::real, ParameterAffects::structure, 1, 6, 2, 2,
     "Between neighbouring directions of the array; memory goes with its inverse square."},
    {"build", "Build", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 0, std::nullopt,
     "Fragments splatted into all directions (Algorithm 6), or each direction voxelised from the triangles (Algorithm "
     "1).",
     builds},
    {"motion", "Scenes that move", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 0, 1,
     "What is voxelised again at another time: only what moves, over what stands still, or the whole scene (as the "
     "paper does). Direct builds and compressed arrays take the whole.",
     motions},
    {"samples_per_voxel", "Samples per voxel", "", ParameterKind::real, ParameterAffects::structure, 0.5, 3, 2,
     std::nullopt, "Surface fragments along each voxel's edge, for the build from fragments."},
    {"coverage", "Coverage", "", ParameterKind::real, ParameterAffects::structure, 0, 1, 0.5, 0.0,
     "Share of a voxel's cross-section that surfaces in it and its neighbour along the row must cover to set it; 0: "
     "any "
     "fragment sets it, as in the paper."},
    {"inset", "Inset", "voxels", ParameterKind::real, ParameterAffects::structure, 0, 1, 0.35, 0.0,
     "How far below the surface of a solid (a one-sided material) its fragments lie, in voxels of the scene's longest "
     "side."},
    {"compression", "Compression", "", ParameterKind::boolean, ParameterAffects::structure, 0, 1, 0, 1,
     "Keep a dictionary of the most frequent rows, and for each row only its index in it (Algorithm 2)."},
    {"dictionary_rows", "Dictionary rows", "", ParameterKind::integer, ParameterAffects::structure, 1024, 4194304,
     1048576, 1048576, "How many rows the dictionary keeps."},
    {"dictionary_choice", "Dictionary choice", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 1, 0,
     "Which rows the dictionary keeps: the most frequent ones, as in the paper, or also rows that stand for many "
     "others down-sampled.",
     dictionary_choices},
    {"compression_steps", "Compression steps", "", ParameterKind::integer, ParameterAffects::structure, 1, 6, 4, 4,
     "A row that is not in the dictionary is looked for down-sampled by 2, by 4 and so on: so many steps, counting the "
     "first, which does not down-sample."},
    {"leftover_rows", "Rows left over", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 1, 0,
     "What a row becomes that no step has matched, and which of several matches it takes: a random one or the most "
     "frequent, as in the paper, or the one that answers the fewest rays differently.",
     leftover_rows},
    {"index_bits", "Index bits", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 0, 0,
     "Of each row's index; dictionaries of more than 1,048,576 rows need 32.", index_bits},
    {"start_offset", "Start offset along the row", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 8, 1.5,
     std::nullopt, "Voxels left out at the surface, which would otherwise shadow itself."},
    {"normal_offset", "Start offset along the normal", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 4,
     0.4, std::nullopt, "How far off the surface the ray starts, in voxels of the scene's longest side."},
    {"light_offset", "Light-end offset", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 8, 0.5,
     std::nullopt, "Voxels left out at the light."},
    {"subrays", "Rows per ray", "", ParameterKind::integer, ParameterAffects::picture, 1, 2, 1, 1,
     "One row for the whole ray, or one for each half (the paper: 4 % better, 45 % slower)."},
}};

constexpr std::array<std::string_view, 5> stages{"fragments", "rotated voxelizations", "dictionary", "rows",
                                                 "shadow rays"};

const BuiltRows& built_rows(const Structure& structure) { return *std::any_cast<const BuiltRowsPointer&>(structure); }

BuildOptions build_options(const BuildRequest& request) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, request.parameters, name); };
    BuildOptions options;
    options.resolution = static_cast<int>(value("resolution"));
    options.angle_step_deg = value("angle_step");
    options.samples_per_voxel = value("samples_per_voxel");
    options.coverage = value("coverage");
    options.inset = value("inset");
    options.threads = request.threads;
    return options;
}

DictionaryOptions dictionary_options(const BuildRequest& request) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, request.parameters, name); };
    DictionaryOptions dictionary;
    dictionary.rows = static_cast<std::uint32_t>(value("dictionary_rows"));
    dictionary.choice = value("dictionary_choice") == 0.0 ? DictionaryChoice::frequent : DictionaryChoice::covering;
    dictionary.steps = static_cast<int>(value("compression_steps"));
    dictionary.leftovers = value("leftover_rows") == 0.0 ? Leftovers::random : Leftovers::nearest;
    dictionary.packed = value("index_bits") == 0.0;
    dictionary.threads = request.threads;
    return dictionary;
}

RowArray build_uncompressed(const BuildRequest& request, const BuildOptions& options, Progress& progress) {
    require_memory(options.resolution, options.angle_step_deg, available_memory_bytes());
    const bool directly = parameter_value(parameters, request.parameters, "build") != 0.0;
    return directly ? build_directly(*request.scene, options, progress)
                    : build_from_fragments(*request.scene, options, progress);
}

/// The array of the whole scene, from the disk where it was kept there.
RowArray build_compressed(const BuildRequest& request, const BuildOptions& options, Progress& progress) {
    const DictionaryOptions dictionary = dictionary_options(request);
    const bool directly = parameter_value(parameters, request.parameters, "build") != 0.0;
    const auto& folder = request.cache_folder;
    const std::string key = folder.empty() ? "" : array_key(*request.scene, options, directly, dictionary);
    if (!folder.empty())
        if (std::optional<RowArray> ready = load_array(folder, key, make_grid(*request.scene, options)))
            return std::move(*ready);
    RowArray array = compress(build_uncompressed(request, options, progress), dictionary, progress);
    try {
        if (!folder.empty()) save_array(folder, key, array, cache_limit_bytes);
    } catch (const EnvironmentError&) {
        // A full disk costs the next start some seconds, and this one nothing.
    }
    return array;
}

Structure build(const BuildRequest& request, Progress& progress) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, request.parameters, name); };
    const BuildOptions options = build_options(request);
    auto built = std::make_shared<BuiltRows>();
    if (value("motion") == 0.0 && value("build") == 0.0 && value("compression") == 0.0 &&
        anything_moves(*request.scene)) {
        std::shared_ptr<MovingRows> shared;
        if (const auto* kept = std::any_cast<std::shared_ptr<MovingRows>>(&request.kept)) shared = *kept;
        if (!shared) {
            require_memory(options.resolution, options.angle_step_deg, available_memory_bytes() / 2);
            shared = build_fixed(*request.scene, options, progress);
        }
        MomentArray now = build_moment(shared, *request.scene, options, progress);
        built->array = std::move(now.array);
        built->moment = std::move(now.moment);
    } else {
        built->array = value("compression") == 0.0 ? build_uncompressed(request, options, progress)
                                                   : build_compressed(request, options, progress);
    }
    if (request.backend == Backend::vulkan) built->on_device = give_to_vulkan(built->array, progress);
    return BuiltRowsPointer(built);
}

std::any kept(const Structure& structure) {
    const BuiltRows& built = built_rows(structure);
    return built.moment.shared ? std::any(built.moment.shared) : std::any();
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

/// How well the dictionary serves the array, and what it costs.
void add_dictionary(const RowArray& array, std::vector<Statistic>& values) {
    const RowDictionary& dictionary = array.dictionary;
    values.push_back({"distinct rows", static_cast<double>(dictionary.distinct_rows), ""});
    values.push_back({"dictionary rows", static_cast<double>(dictionary.rows), ""});
    for (std::size_t step = 0; step < dictionary.rows_mapped.size(); ++step)
        values.push_back({step == 0 ? "rows in the dictionary"
                                    : "rows mapped by step " + std::to_string(step) + ", down-sampled by " +
                                          std::to_string(1u << step),
                          static_cast<double>(dictionary.rows_mapped[step]), ""});
    values.push_back({"rows left over", static_cast<double>(dictionary.rows_left_over), ""});
    values.push_back({"rays answered differently", 100.0 * dictionary.differing_share, "%"});
    for (const int bits : {20, 32})
        values.push_back({"bytes with indices of " + std::to_string(bits) + " bits",
                          static_cast<double>(compressed_bytes(array.grid, dictionary.rows, bits)), "B"});
}

Statistics statistics(const Structure& structure) {
    const RowArray& array = built_rows(structure).array;
    Statistics statistics;
    statistics.structure_bytes = array.words.bytes();
    statistics.uncompressed_bytes =
        array.grid.rows() * static_cast<std::size_t>(array.grid.words_per_row) * sizeof(std::uint32_t);
    statistics.build_seconds = array.build_seconds;
    statistics.compress_seconds = array.dictionary.seconds;
    statistics.values = {{"directions", static_cast<double>(array.grid.frames.size()), ""},
                         {"angle step", 180.0 / array.grid.angles, "deg"},
                         {"rows", static_cast<double>(array.grid.rows()), ""},
                         {"fragments", static_cast<double>(array.fragments), ""}};
    if (array.dictionary.index_bits != 0) add_dictionary(array, statistics.values);
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
    statistics,
    true,
    kept};

}  // namespace

const Technique& technique() { return row; }

const RowArray& row_array(const Structure& structure) { return built_rows(structure).array; }

bool is_compressed(const ParameterValues& chosen) { return parameter_value(parameters, chosen, "compression") != 0.0; }

std::vector<std::uint8_t> uncompressed_voxelization(const Scene& scene, const ParameterValues& chosen, int direction,
                                                    int threads, Progress& progress) {
    BuildRequest request;
    request.parameters = chosen;
    request.threads = threads;
    const BuildOptions options = build_options(request);
    if (parameter_value(parameters, chosen, "build") != 0.0) return voxelize_directly(scene, options, direction);
    return voxelize_from_fragments(scene, options, direction, progress);
}

QueryCount count_blocked(const Structure& structure, const RenderRequest& request) {
    const BuiltRows& built = built_rows(structure);
    if (request.backend == Backend::cpu) return count_blocked_on_cpu(built.array, request);
    Progress progress;
    return count_blocked_on_vulkan(*on_device(built, progress), built.array, request);
}

}  // namespace sightlines::voxel_rows
