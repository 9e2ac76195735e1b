#include "techniques/voxel_rows/voxel_rows.h"

#include <array>
#include <chrono>

#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/voxel_rows/array_cache.h"
#include "techniques/voxel_rows/dictionary.h"
#include "techniques/voxel_rows/hit_effects.h"
#include "techniques/voxel_rows/memory_need.h"
#include "techniques/voxel_rows/moving_rows.h"
#include "techniques/voxel_rows/object_rows.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/vulkan_backend.h"

namespace sightlines::voxel_rows {
namespace {

struct BuiltRows {
    RowArray array;
    std::optional<SurfaceVoxels> surface;         ///< where mirrors are asked for
    Moment moment;                                ///< whose memory the array is, where the scene moves
    std::shared_ptr<const VulkanRows> on_device;  ///< where it was built for Vulkan
    std::shared_ptr<RigidRows> rigid;             ///< where objects are asked beside the array
    std::vector<PlacedObject> placed;             ///< the objects at this moment

    Objects objects() const { return rigid ? Objects{rigid->types, placed} : Objects{}; }
};
using BuiltRowsPointer = std::shared_ptr<const BuiltRows>;

constexpr std::uint64_t cache_limit_bytes = std::uint64_t{4} << 30u;  // ten arrays of the usual size

constexpr std::array<std::string_view, 2> builds{"fragments", "direct"};

constexpr std::array<std::string_view, 2> dictionary_choices{"frequent", "covering"};
constexpr std::array<std::string_view, 2> leftover_rows{"random", "nearest"};
constexpr std::array<std::string_view, 2> index_bits{"20", "32"};

enum class Effect { off, ambient_occlusion, mirror };
constexpr std::array<std::string_view, 3> first_hit_effects{"off", "ambient_occlusion", "mirror"};

enum class Motion { changes, whole, objects, automatic };
constexpr std::array<std::string_view, 4> motions{"changes", "whole", "objects", "automatic"};

constexpr std::array<Parameter, 22> parameters{{
    {"resolution", "Resolution", "voxels", ParameterKind::integer, ParameterAffects::structure, 32, 256, 128, 128,
     "Voxels along each axis of each rotated voxelization; a row holds that many bits."},
    {"angle_step", "Angle step", "deg", ParameterKind::real, ParameterAffects::structure, 1, 6, 2, 2,
     "Between neighbouring directions of the array; memory goes with its inverse square."},
    {"build", "Build", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 0, std::nullopt,
     "Fragments splatted into all directions (Algorithm 6), or each direction voxelised from the triangles (Algorithm "
     "1).",
     builds},
    {"motion", "Scenes that move", "", ParameterKind::choice, ParameterAffects::structure, 0, 3, 3, std::nullopt,
     "At another time: what changes is voxelised again, or the whole scene (the paper, where parts deform), or "
     "nothing: "
     "objects that move rigidly have arrays of their own (Algorithm 5). Automatic: objects, where they are few.",
     motions},
    {"object_resolution", "Object resolution", "voxels", ParameterKind::integer, ParameterAffects::structure, 16, 128,
     32, 32, "Voxels along each axis of the arrays of objects that move rigidly."},
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
    {"first_hits", "First hits", "", ParameterKind::choice, ParameterAffects::structure, 0, 2, 0, std::nullopt,
     "What knowing where rays hit first adds to the picture: surfaces darkened by what is near (ambient occlusion), or "
     "as mirrors.",
     first_hit_effects},
    {"occlusion_rays", "Occlusion rays", "", ParameterKind::integer, ParameterAffects::picture, 1, 256, 16,
     std::nullopt, "For ambient occlusion, from each pixel."},
    {"occlusion_reach", "Occlusion reach", "%", ParameterKind::real, ParameterAffects::picture, 1, 100, 10,
     std::nullopt, "How far a hit still darkens, of the scene's diagonal."},
    {"mirror_share", "Mirror share", "", ParameterKind::real, ParameterAffects::picture, 0, 1, 0.5, std::nullopt,
     "How much of a mirror each surface is."},
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
    require_memory(options.resolution, options.angle_step_deg, available_memory_bytes(), ArrayKind::compressed);
    RowArray array = compress(build_uncompressed(request, options, progress), dictionary, progress);
    try {
        if (!folder.empty()) save_array(folder, key, array, cache_limit_bytes);
    } catch (const EnvironmentError&) {
        // A full disk costs the next start some seconds, and this one nothing.
    }
    return array;
}

Effect effect_of(const ParameterValues& chosen) {
    return static_cast<Effect>(parameter_value(parameters, chosen, "first_hits"));
}

/// How the scene's motion is served: not `automatic`, and `whole` where nothing moves.
Motion motion_of(const BuildRequest& request) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, request.parameters, name); };
    const auto asked = static_cast<Motion>(value("motion"));
    const Scene& scene = *request.scene;
    if (asked == Motion::whole || !anything_moves(scene)) return Motion::whole;
    const bool array_holds_all = effect_of(request.parameters) != Effect::off;  // first hits ask no objects
    if (asked == Motion::objects && moves_rigidly(scene) && !array_holds_all) return Motion::objects;
    if (asked == Motion::automatic && worth_asking_objects(scene) && !array_holds_all) return Motion::objects;
    // Fragments of what moves cannot be added to a dictionary's rows, nor to those of Algorithm 1.
    return value("build") == 0.0 && value("compression") == 0.0 ? Motion::changes : Motion::whole;
}

/// The array of the whole of the request's scene.
RowArray build_array(const BuildRequest& request, const BuildOptions& options, Progress& progress) {
    return parameter_value(parameters, request.parameters, "compression") == 0.0
               ? build_uncompressed(request, options, progress)
               : build_compressed(request, options, progress);
}

void build_changes(const BuildRequest& request, const BuildOptions& options, BuiltRows& built, Progress& progress) {
    std::shared_ptr<MovingRows> shared;
    if (const auto* kept = std::any_cast<std::shared_ptr<MovingRows>>(&request.kept)) shared = *kept;
    if (!shared) {
        require_memory(options.resolution, options.angle_step_deg, available_memory_bytes() / 2);
        shared = build_fixed(*request.scene, options, progress);
    }
    MomentArray now = build_moment(shared, *request.scene, options, progress);
    built.array = std::move(now.array);
    built.moment = std::move(now.moment);
}

/// Algorithm 5: the array of what stands still, and one for each type of object.
std::shared_ptr<RigidRows> build_rigid(const BuildRequest& request, const BuildOptions& options, Progress& progress) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, request.parameters, name); };
    const Scene still = fixed_scene(*request.scene);
    BuildRequest of_still = request;
    of_still.scene = &still;
    auto rigid = std::make_shared<RigidRows>();
    BuildOptions fixed = options;
    if (still.triangles.empty()) {
        // Any array is blank then: the smallest saves the system from giving, and rays from touching, gigabytes of
        // zeros.
        fixed.resolution = 32;
        fixed.angle_step_deg = 6.0;
    }
    rigid->fixed = build_array(of_still, fixed, progress);
    BuildOptions small = options;
    small.resolution = static_cast<int>(value("object_resolution"));
    const std::vector<RigidObject> objects = rigid_objects(*request.scene);
    require_memory(small.resolution, small.angle_step_deg, available_memory_bytes() / objects.size());
    for (const RigidObject& object : objects) {
        rigid->types.push_back(build_object(*request.scene, object, small, value("build") != 0.0, progress));
        rigid->complete = rigid->complete && !rigid->types.back().words.words.empty();
    }
    return rigid;
}

/// The device's copies of what all moments share, made when first asked for.
void give_rigid_to_vulkan(RigidRows& rigid, Progress& progress) {
    const std::lock_guard lock(rigid.device_mutex);
    if (!rigid.fixed_on_device) rigid.fixed_on_device = give_to_vulkan(rigid.fixed, progress);
    if (!rigid.types_on_device) rigid.types_on_device = give_objects_to_vulkan(rigid.types, progress);
}

void build_objects(const BuildRequest& request, const BuildOptions& options, BuiltRows& built, Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    if (const auto* kept = std::any_cast<std::shared_ptr<RigidRows>>(&request.kept)) built.rigid = *kept;
    const bool anew = !built.rigid;
    if (anew) built.rigid = build_rigid(request, options, progress);
    built.array = built.rigid->fixed;
    built.placed = placed_objects(*request.scene);
    if (!anew) built.array.dictionary.seconds = 0.0;
    built.array.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() -
                                built.array.dictionary.seconds;
}

Structure build(const BuildRequest& request, Progress& progress) {
    const BuildOptions options = build_options(request);
    const Motion motion = motion_of(request);
    auto built = std::make_shared<BuiltRows>();
    if (motion == Motion::objects)
        build_objects(request, options, *built, progress);
    else if (motion == Motion::changes)
        build_changes(request, options, *built, progress);
    else
        built->array = build_array(request, options, progress);
    if (effect_of(request.parameters) == Effect::mirror)
        built->surface = voxelize_surface(*request.scene, options.resolution, options.threads, progress);
    if (request.backend == Backend::vulkan) {
        if (built->rigid)
            give_rigid_to_vulkan(*built->rigid, progress);
        else
            built->on_device = give_to_vulkan(built->array, progress);
    }
    return BuiltRowsPointer(built);
}

std::any kept(const Structure& structure) {
    const BuiltRows& built = built_rows(structure);
    if (built.rigid && built.rigid->complete) return built.rigid;
    return built.moment.shared ? std::any(built.moment.shared) : std::any();
}

/// The structure's copies on the device, or those made for this call where it was built for the CPU.
struct OnDevice {
    std::shared_ptr<const VulkanRows> array;
    ObjectsOnDevice objects;
};
OnDevice on_device(const BuiltRows& built, Progress& progress) {
    if (!built.rigid) return {built.on_device ? built.on_device : give_to_vulkan(built.array, progress), {}};
    give_rigid_to_vulkan(*built.rigid, progress);
    return {built.rigid->fixed_on_device, {built.rigid->types_on_device.get(), built.objects()}};
}

/// The picture by the lights alone. `device` holds the structure where the request is for Vulkan.
RenderResult lit(const BuiltRows& built, const RenderRequest& request, const OnDevice& device, Progress& progress) {
    if (request.backend == Backend::cpu) return render_on_cpu(built.array, request, progress, built.objects());
    return render_on_vulkan(*device.array, built.array, request, progress, device.objects);
}

void add_occlusion(const BuiltRows& built, const RenderRequest& request, const HitQuery& query, RenderResult& result,
                   Progress& progress) {
    const auto value = [&](std::string_view name) { return parameter_value(parameters, request.parameters, name); };
    const double reach_m = 0.01 * value("occlusion_reach") * built.array.grid.bounds.diagonal();
    const OcclusionOptions options{static_cast<int>(value("occlusion_rays")), static_cast<float>(reach_m), request.seed,
                                   request.threads};
    const ImageScalar openness = ambient_openness(query, *request.surfaces, options, progress);
    for (std::size_t p = 0; p < openness.pixels.size(); ++p) {
        const vec3 emission = request.surfaces->emission[p];
        result.radiance.pixels[p] = emission + openness.pixels[p] * (result.radiance.pixels[p] - emission);
    }
}

void add_mirrors(const BuiltRows& built, const RenderRequest& request, const HitQuery& query, const OnDevice& device,
                 RenderResult& result, Progress& progress) {
    const auto share = static_cast<float>(parameter_value(parameters, request.parameters, "mirror_share"));
    const SurfaceBuffer mirrored =
        mirrored_surfaces(query, *built.surface, *request.surfaces, request.threads, progress);
    RenderRequest reflected = request;
    reflected.surfaces = &mirrored;
    reflected.keep_verdicts = false;
    reflected.on_region = {};
    const RenderResult seen = lit(built, reflected, device, progress);
    for (std::size_t p = 0; p < seen.radiance.pixels.size(); ++p)
        if (request.surfaces->triangle[p] != no_triangle)
            result.radiance.pixels[p] = glm::mix(result.radiance.pixels[p], seen.radiance.pixels[p], share);
}

RenderResult render(const Structure& structure, const RenderRequest& request, Progress& progress) {
    const BuiltRows& built = built_rows(structure);
    const OnDevice device = request.backend == Backend::vulkan ? on_device(built, progress) : OnDevice{};
    RenderResult result = lit(built, request, device, progress);
    const Effect effect = effect_of(request.parameters);
    if (effect == Effect::off) return result;
    const auto start = std::chrono::steady_clock::now();
    const HitQuery query{built.array, make_query(built.array, request.parameters, {}), device.array.get()};
    if (effect == Effect::ambient_occlusion)
        add_occlusion(built, request, query, result, progress);
    else
        add_mirrors(built, request, query, device, result, progress);
    result.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

Trace trace_structure(const Structure& structure, const TraceRequest& request) {
    const BuiltRows& built = built_rows(structure);
    return trace(built.array, request, built.objects());
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

/// What asking objects beside the array takes.
void add_objects(const BuiltRows& built, std::vector<Statistic>& values) {
    values.push_back({"objects that move", static_cast<double>(built.placed.size()), ""});
    values.push_back({"types of objects", static_cast<double>(built.rigid->types.size()), ""});
    values.push_back({"bytes of the objects' arrays", static_cast<double>(bytes_of(built.rigid->types)), "B"});
}

Statistics statistics(const Structure& structure) {
    const BuiltRows& built = built_rows(structure);
    const RowArray& array = built.array;
    const std::uint64_t object_bytes = bytes_of(built.objects().types);
    Statistics statistics;
    statistics.structure_bytes = array.words.bytes() + object_bytes + (built.surface ? built.surface->bytes() : 0);
    statistics.uncompressed_bytes =
        array.grid.rows() * static_cast<std::size_t>(array.grid.words_per_row) * sizeof(std::uint32_t) + object_bytes;
    statistics.build_seconds = array.build_seconds;
    statistics.compress_seconds = array.dictionary.seconds;
    statistics.values = {{"directions", static_cast<double>(array.grid.frames.size()), ""},
                         {"angle step", 180.0 / array.grid.angles, "deg"},
                         {"rows", static_cast<double>(array.grid.rows()), ""},
                         {"fragments", static_cast<double>(array.fragments), ""}};
    if (built.rigid) add_objects(built, statistics.values);
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

Objects objects(const Structure& structure) { return built_rows(structure).objects(); }

bool is_compressed(const ParameterValues& chosen) { return parameter_value(parameters, chosen, "compression") != 0.0; }

std::vector<std::uint8_t> uncompressed_voxelization(const Scene& scene, const ParameterValues& chosen, int direction,
                                                    int threads, Progress& progress) {
    BuildRequest request{.scene = &scene, .parameters = chosen, .threads = threads};
    Scene still;  // the array leaves out objects that have one of their own
    if (motion_of(request) == Motion::objects) {
        still = fixed_scene(scene);
        request.scene = &still;
    }
    const BuildOptions options = build_options(request);
    const bool directly = parameter_value(parameters, chosen, "build") != 0.0;
    return directly ? voxelize_directly(*request.scene, options, direction)
                    : voxelize_from_fragments(*request.scene, options, direction, progress);
}

QueryCount count_blocked(const Structure& structure, const RenderRequest& request) {
    const BuiltRows& built = built_rows(structure);
    if (request.backend == Backend::cpu) return count_blocked_on_cpu(built.array, request, built.objects());
    Progress progress;
    const OnDevice device = on_device(built, progress);
    return count_blocked_on_vulkan(*device.array, built.array, request, device.objects);
}

}  // namespace sightlines::voxel_rows
