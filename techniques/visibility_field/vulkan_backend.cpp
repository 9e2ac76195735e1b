#include "techniques/visibility_field/vulkan_backend.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>

#include "shaders/spirv.h"
#include "shaders/visibility_field_lighting_data.h"
#include "techniques/base/parallel.h"
#include "techniques/compute/buffer.h"
#include "techniques/compute/dispatch.h"
#include "techniques/compute/ray_scene.h"
#include "techniques/pixel_groups.h"
#include "techniques/rays/open_rays.h"
#include "techniques/scene/map_sampling.h"
#include "techniques/visibility_field/weighted_samples.h"

namespace sightlines::visibility_field {

/// The shader, for samples of one kind.
struct FieldPipeline {
    compute::Pipeline pipeline;
    std::optional<compute::BoundTexels> texels{};  ///< where the tree is read as texels
};

struct FieldOnDevice {
    std::shared_ptr<const compute::Device> device;
    compute::Buffer bricks, mask_numbers, masks;
    compute::Buffer nodes, triangles, cutouts;     ///< the tree's, or no nodes and the triangles that have holes
    std::optional<compute::RayScene> ray_scene{};  ///< where rays are answered by ray queries
    compute::Buffer tables;                        ///< FieldTables
    bool has_field = false;
    mutable std::mutex pipelines_mutex;
    mutable std::map<std::uint32_t, FieldPipeline> pipelines;  ///< by kind_of_samples
};

namespace {

constexpr std::uint32_t workgroup = 64;             ///< local_size_x of the shader
constexpr double longest_dispatch_seconds = 0.015;  ///< the window draws on the same device in between

template <class T>
compute::Buffer on_device(const std::shared_ptr<const compute::Device>& device, const std::vector<T>& values,
                          const Progress& progress) {
    const std::uint64_t bytes = std::max<std::uint64_t>(values.size() * sizeof(T), 16);
    compute::Buffer buffer = compute::make_buffer(device, bytes, compute::MemoryPlace::device);
    compute::upload(buffer, std::as_bytes(std::span(values)), progress);
    return buffer;
}

/// A software device reads an address word by word and ray by ray, but a texel of 16 bytes at once.
bool reads_texels(const FieldOnDevice& field) {
    const std::uint64_t largest = std::max({field.nodes.bytes, field.triangles.bytes, field.cutouts.bytes});
    return field.device->info.kind == compute::DeviceKind::cpu && !field.ray_scene &&
           compute::fits_as_texels(*field.device, largest);
}

/// `kind`: the shader's specialization constant.
FieldPipeline make_pipeline(const FieldOnDevice& field, std::uint32_t kind) {
    const bool texels = reads_texels(field);
    const auto shader = field.ray_scene ? spirv::visibility_field_lighting_queries()
                        : texels        ? spirv::visibility_field_lighting_texels()
                                        : spirv::visibility_field_lighting();
    const compute::SpecializationConstant constant{0, kind};
    FieldPipeline made{compute::make_pipeline(field.device, shader, sizeof(FieldLightingJob), std::span(&constant, 1),
                                              texels ? 3 : 0)};
    if (!texels) return made;
    const std::array<compute::TexelSource, 3> sources{{{&field.nodes, VK_FORMAT_R32G32B32A32_UINT},
                                                       {&field.triangles, VK_FORMAT_R32G32B32A32_UINT},
                                                       {&field.cutouts, VK_FORMAT_R32G32B32A32_UINT}}};
    made.texels = compute::bind_texels(made.pipeline, sources);
    return made;
}

const FieldPipeline& pipeline_for(const FieldOnDevice& field, std::uint32_t kind) {
    const std::lock_guard lock(field.pipelines_mutex);
    const auto found = field.pipelines.find(kind);
    return found != field.pipelines.end() ? found->second
                                          : field.pipelines.emplace(kind, make_pipeline(field, kind)).first->second;
}

/// What the shader must know of the request's samples; 0 where all weigh the same.
std::uint32_t kind_of_samples(const EnvironmentRequest& request) {
    if (!is_weighted(request)) return 0;
    std::uint32_t kind = samples_weighted;
    if (request.glossy) kind |= samples_of_glossy;
    if (request.map != nullptr) kind |= samples_lit_by_map;
    if (request.sampling != Sampling::map) kind |= samples_by_cosine;
    if (request.glossy && (request.sampling == Sampling::brdf || request.sampling == Sampling::both))
        kind |= samples_by_facets;
    if (request.sampling == Sampling::map || request.sampling == Sampling::both) kind |= samples_by_map;
    return kind;
}

/// The pieces of the picture that are uploaded and resolved together. A GPU needs more pixels to be busy.
std::vector<PixelRect> tiles_of(ImageSize size, compute::DeviceKind kind) {
    const int width = kind == compute::DeviceKind::cpu ? 64 : 512, height = kind == compute::DeviceKind::cpu ? 32 : 256;
    std::vector<PixelRect> tiles;
    for (int y = 0; y < size.height; y += height)
        for (int x = 0; x < size.width; x += width)
            tiles.push_back({x, y, std::min(width, size.width - x), std::min(height, size.height - y)});
    return tiles;
}

std::uint32_t culling_number(const FieldOnDevice& field, Culling culling) {
    if (!field.has_field) return cull_nothing;
    return culling == Culling::label ? cull_by_label : culling == Culling::visible ? cull_by_visible : cull_by_both;
}

/// Memory for asking one tile after another.
struct TileAsker {
    const FieldOnDevice& field;
    const EnvironmentRequest& request;
    const FieldPipeline& pipeline;
    HarmonicLight light{};
    compute::Buffer directions{};                               ///< of all pixels
    compute::Buffer surfaces{}, sampled{}, sums{}, verdicts{};  ///< of one tile; mapped
    std::vector<compute::Buffer> light_tables{};                ///< of samples that have weights of their own
    FieldLightingJob job{};
    double pairs_per_second = 2.0e6;  ///< of the last dispatch; at first a guess low enough for any device

    std::span<FieldSums> tile_sums() const {
        return {reinterpret_cast<FieldSums*>(sums.mapped.data()), sums.bytes / sizeof(FieldSums)};
    }
    std::span<std::uint32_t> tile_verdicts() const {
        return {reinterpret_cast<std::uint32_t*>(verdicts.mapped.data()), verdicts.bytes / sizeof(std::uint32_t)};
    }
};

compute::Buffer host_buffer(const FieldOnDevice& field, std::uint64_t bytes) {
    return compute::make_buffer(field.device, std::max<std::uint64_t>(bytes, 16), compute::MemoryPlace::host);
}

/// Gives the device what sends the light, and how a map is drawn.
void give_light(TileAsker& asker, const Progress& progress) {
    const WeightedTables tables = weighted_tables(asker.request);
    const auto give = [&](std::span<const float> numbers) {
        compute::Buffer& buffer = asker.light_tables.emplace_back(compute::make_buffer(
            asker.field.device, std::max<std::uint64_t>(numbers.size_bytes(), 16), compute::MemoryPlace::device));
        compute::upload(buffer, std::as_bytes(numbers), progress);
        return buffer.address;
    };
    WeightedLight light{};
    light.harmonics = tables.harmonics;
    light.map = tables.map;
    const std::size_t texels = static_cast<std::size_t>(tables.map.width) * static_cast<std::size_t>(tables.map.height);
    light.texels = give({tables.texels, 3 * texels});
    const MapTables none;
    const MapTables& draws = tables.draws != nullptr ? *tables.draws->tables : none;
    if (tables.draws != nullptr) light.draws = tables.draws->shape;
    light.rows = give(draws.rows);
    light.heights = give(draws.heights);
    light.columns = give(draws.columns);
    light.densities = give(draws.density);
    asker.light_tables.push_back(on_device(asker.field.device, std::vector<WeightedLight>{light}, progress));
    asker.job.light = asker.light_tables.back().address;
}

TileAsker make_asker(const FieldOnDevice& field, const EnvironmentRequest& request, std::size_t most_pixels,
                     const Progress& progress) {
    const SamplePattern& pattern = *request.pattern;
    const auto samples = static_cast<std::uint32_t>(pattern.samples);
    const bool weighted = is_weighted(request);
    const std::uint32_t words = request.keep_verdicts ? (samples + 31) / 32 : 0;
    const std::size_t padded = (most_pixels + workgroup - 1) / workgroup * workgroup;
    TileAsker asker{field, request, pipeline_for(field, kind_of_samples(request)), harmonic_light(request.light)};
    std::vector<vec3> directions;
    for (std::size_t k = 0; k < samples; ++k) directions.emplace_back(pattern.x[k], pattern.y[k], pattern.z[k]);
    asker.directions = on_device(field.device, directions, progress);
    asker.sampled = host_buffer(field, weighted ? padded * sizeof(SampledSurface) : 0);
    if (weighted) give_light(asker, progress);
    asker.surfaces = host_buffer(field, padded * sizeof(AskingPoint));
    asker.sums = host_buffer(field, padded * sizeof(FieldSums));
    asker.verdicts = host_buffer(field, padded * words * sizeof(std::uint32_t));
    asker.job.field = field.tables.address;
    asker.job.directions = asker.directions.address;
    asker.job.sampled = asker.sampled.address;
    asker.job.surfaces = asker.surfaces.address;
    asker.job.sums = asker.sums.address;
    asker.job.verdicts = asker.verdicts.address;
    asker.job.samples = samples;
    asker.job.words_per_pixel = words;
    asker.job.culling = culling_number(field, culling_used(request));
    asker.job.subtracts = request.unshadowed == Unshadowed::analytic && !weighted ? 1 : 0;
    return asker;
}

/// Copies the surfaces into mapped memory, padded to whole workgroups with pixels that ask nothing.
std::uint32_t place_surfaces(const TileAsker& asker, const PixelGroups& pixels) {
    const SamplePattern& pattern = *asker.request.pattern;
    const int width = asker.request.surfaces->size.width;
    const std::size_t padded = (pixels.pixel.size() + workgroup - 1) / workgroup * workgroup;
    auto* points = reinterpret_cast<AskingPoint*>(asker.surfaces.mapped.data());
    for (std::size_t k = 0; k < padded; ++k) {
        points[k] = {};
        if (k >= pixels.pixel.size() || pixels.pixel[k] == no_triangle) continue;
        const auto pixel = static_cast<int>(pixels.pixel[k]);
        const vec2 turn = pattern.turns[pattern.tile_place(pixel % width, pixel / width)];
        for (int axis = 0; axis < 3; ++axis) {
            points[k].position[axis] = pixels.position[axis][k];
            points[k].normal[axis] = pixels.normal[axis][k];
            points[k].shading_normal[axis] = pixels.shading_normal[axis][k];
        }
        points[k].turn_cosine = turn.x;
        points[k].turn_sine = turn.y;
    }
    return static_cast<std::uint32_t>(padded);
}

/// What the samples that have weights of their own are drawn about.
void place_sampled(const TileAsker& asker, const PixelGroups& pixels) {
    auto* sampled = reinterpret_cast<SampledSurface*>(asker.sampled.mapped.data());
    for (std::size_t k = 0; k < pixels.pixel.size(); ++k)
        if (pixels.pixel[k] != no_triangle) sampled[k] = weighted_pixel(asker.request, pixels.pixel[k]).surface;
}

/// Asks all samples of the tile's pixels, in dispatches short enough for others to use the device in between. Where the
/// samples are cut does not change the result: each pixel's sums go on where they were left.
void ask_tile(TileAsker& asker, const PixelGroups& pixels, const Progress& progress) {
    const std::uint32_t count = place_surfaces(asker, pixels);
    std::ranges::fill(asker.tile_verdicts(), 0u);
    if (is_weighted(asker.request)) place_sampled(asker, pixels);
    const FieldPipeline& pipeline = asker.pipeline;
    asker.job.first_sample = 0;
    while (asker.job.first_sample < asker.job.samples) {
        progress.check();
        const double fitting = asker.pairs_per_second * longest_dispatch_seconds / count;
        const auto step = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, 4096.0));
        asker.job.end_sample = std::min(asker.job.first_sample + step, asker.job.samples);
        const double seconds =
            compute::dispatch(pipeline.pipeline, std::as_bytes(std::span(&asker.job, 1)), {count / workgroup, 1, 1},
                              pipeline.texels ? &*pipeline.texels : nullptr);
        const double pairs = static_cast<double>(count) * (asker.job.end_sample - asker.job.first_sample);
        asker.pairs_per_second = pairs / std::max(seconds, 1.0e-6);
        asker.job.first_sample = asker.job.end_sample;
    }
}

void count(const FieldSums& sums, std::uint32_t samples, SampleCounts& counts) {
    counts.samples += samples;
    counts.below += samples - sums.asked;
    counts.traced += sums.traced;
    counts.traced_blocked += sums.traced_blocked;
    if (sums.outside != 0) counts.outside += sums.traced;
}

/// Puts a tile's sums into the picture.
void resolve(const TileAsker& asker, const PixelGroups& pixels, EnvironmentResult& result) {
    const SurfaceBuffer& surfaces = *asker.request.surfaces;
    const std::size_t words = asker.job.words_per_pixel;
    for (std::size_t k = 0; k < pixels.pixel.size(); ++k) {
        if (pixels.pixel[k] == no_triangle) continue;
        const std::size_t pixel = pixels.pixel[k];
        const FieldSums& sums = asker.tile_sums()[k];
        count(sums, asker.job.samples, result.counts);
        result.rays_traced.pixels[pixel] = sums.traced;
        PixelMoments moments;
        std::ranges::copy(sums.moment, moments.begin());
        vec3 irradiance = is_weighted(asker.request)
                              ? vec3(moments[0], moments[1], moments[2])
                              : irradiance_of(asker.light, moments, asker.request.pattern->samples);
        if (sums.subtracts != 0)
            irradiance += sightlines::irradiance(asker.request.light, surfaces.shading_normal[pixel]);
        result.irradiance.pixels[pixel] = irradiance;
        result.radiance.pixels[pixel] = reflected_radiance(asker.request, pixel, irradiance);
        result.rays_asked.pixels[pixel] = sums.asked;
        result.shadow.pixels[pixel] =
            static_cast<float>(sums.blocked) / static_cast<float>(std::max<std::uint32_t>(sums.asked, 1));
        if (words > 0)
            std::ranges::copy(asker.tile_verdicts().subspan(k * words, words), &result.verdicts.words[pixel * words]);
    }
}

std::uint64_t bytes_of(const std::vector<uvec4>& table) { return table.size() * sizeof(uvec4); }

compute::Buffer triangles_on_device(const std::shared_ptr<const compute::Device>& device,
                                    const std::vector<uvec4>& corners, const Progress& progress) {
    compute::Buffer buffer = compute::make_buffer(device, std::max<std::uint64_t>(bytes_of(corners), 16),
                                                  compute::MemoryPlace::device, compute::holds_triangles);
    compute::upload(buffer, std::as_bytes(std::span(corners)), progress);
    return buffer;
}

/// The driver's own structure over the triangles. Those with holes stay, to be looked up.
void give_ray_scene(FieldOnDevice& field, const TriangleTables& tables, Progress& progress) {
    progress.begin("building the device's own ray structure", 1);
    const compute::Buffer opaque = triangles_on_device(field.device, tables.opaque, progress);
    field.triangles = triangles_on_device(field.device, tables.masked, progress);
    const auto list = [](const compute::Buffer& corners, const std::vector<uvec4>& words, bool is_opaque) {
        return compute::TriangleList{&corners, sizeof(uvec4), static_cast<std::uint32_t>(words.size() / 3), is_opaque};
    };
    const std::array<compute::TriangleList, 2> lists{list(opaque, tables.opaque, true),
                                                     list(field.triangles, tables.masked, false)};
    progress.check();
    field.ray_scene = compute::build_ray_scene(field.device, lists);
    field.cutouts = on_device(field.device, tables.cutouts, progress);
    progress.advance();
}

/// What answers rays. Returns the number of the tree's nodes.
std::uint32_t give_rays(FieldOnDevice& field, const EmbreeScene& embree, int threads, DeviceRays wanted,
                        Progress& progress) {
    if (wanted == DeviceRays::queries && triangle_count(embree) <= field.device->most_query_triangles &&
        field.device->info.queries_rays) {
        give_ray_scene(field, list_triangles(embree), progress);
        field.nodes = on_device(field.device, std::vector<uvec4>(), progress);
        return 0;
    }
    const RayTree tree = build_ray_tree(embree, threads, progress);
    field.nodes = on_device(field.device, tree.nodes, progress);
    field.triangles = on_device(field.device, tree.triangles, progress);
    field.cutouts = on_device(field.device, tree.cutouts, progress);
    return tree.node_count();
}

}  // namespace

DeviceRays device_rays_wanted(compute::DeviceKind kind) {
    const char* asked = std::getenv("SIGHTLINES_RAY_QUERIES");
    const std::string_view said = asked != nullptr ? asked : "";
    const bool queries = said == "1" || (said != "0" && kind != compute::DeviceKind::cpu);
    return queries ? DeviceRays::queries : DeviceRays::tree;
}

DeviceRaysUsed rays_used(const FieldOnDevice& field) {
    const std::uint64_t tables = field.nodes.bytes + field.triangles.bytes + field.cutouts.bytes;
    if (!field.ray_scene) return {DeviceRays::tree, tables};
    return {DeviceRays::queries, tables + field.ray_scene->bytes()};
}

std::shared_ptr<const FieldOnDevice> give_to_vulkan(const VisibilityField* field, const EmbreeScene& embree,
                                                    int threads, Progress& progress, std::optional<DeviceRays> wanted) {
    auto made = std::make_shared<FieldOnDevice>();
    made->device = compute::open_device();
    const std::uint32_t nodes =
        give_rays(*made, embree, threads, wanted.value_or(device_rays_wanted(made->device->info.kind)), progress);
    made->has_field = field != nullptr;
    const VisibilityField nothing;
    const VisibilityField& given = field != nullptr ? *field : nothing;
    made->bricks = on_device(made->device, given.bricks, progress);
    made->mask_numbers = on_device(made->device, given.mask_numbers, progress);
    made->masks = on_device(made->device, given.masks, progress);
    const FieldTables tables{given.shape,
                             made->bricks.address,
                             made->mask_numbers.address,
                             made->masks.address,
                             made->nodes.address,
                             made->triangles.address,
                             made->cutouts.address,
                             made->ray_scene ? made->ray_scene->address() : 0,
                             nodes,
                             lift_m(embree)};
    made->tables = on_device(made->device, std::vector<FieldTables>{tables}, progress);
    pipeline_for(*made, 0);
    return made;
}

EnvironmentResult render_on_vulkan(const FieldOnDevice& field, const EnvironmentRequest& request, Progress& progress) {
    const ImageSize size = request.surfaces->size;
    EnvironmentResult result = blank_environment(request);
    std::vector<PixelRect> tiles = tiles_of(size, field.device->info.kind);
    if (request.reverse_tiles) std::ranges::reverse(tiles);
    std::size_t most_pixels = 0;
    for (const PixelRect& tile : tiles)
        most_pixels =
            std::max(most_pixels, static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height));
    progress.begin("asking the environment", static_cast<std::int64_t>(tiles.size()));
    const auto start = std::chrono::steady_clock::now();
    TileAsker asker = make_asker(field, request, most_pixels + pixel_group_size, progress);
    for (const PixelRect& tile : tiles) {
        const PixelGroups pixels = group_pixels(*request.surfaces, tile, 1, 0);
        if (!pixels.pixel.empty()) {
            ask_tile(asker, pixels, progress);
            resolve(asker, pixels, result);
        }
        if (request.on_region) request.on_region(result, tile);
        progress.advance();
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.device = field.device->info.name + (field.ray_scene ? ", ray queries" : ", ray tree");
    return result;
}

}  // namespace sightlines::visibility_field
