#include "techniques/voxel_rows/vulkan_backend.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <numbers>
#include <optional>

#include "shaders/spirv.h"
#include "shaders/voxel_rows_lighting_data.h"
#include "techniques/pixel_groups.h"
#include "techniques/rays/light_records.h"
#include "techniques/refinement.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/vulkan_rows.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::uint32_t workgroup = 64;             ///< local_size_x of the shader
constexpr std::uint32_t mixed_lights = 3;           ///< kind_of_all_lights where the lights differ in kind
constexpr double longest_dispatch_seconds = 0.015;  ///< the window draws on the same device in between
constexpr std::uint32_t light_step = 32;            ///< lights are cut into multiples of a verdict word

/// Where a compressed array's indices begin.
std::uint64_t first_index_byte(const RowShape& shape) {
    return static_cast<std::uint64_t>(shape.index_start) * sizeof(std::uint32_t);
}

/// Whether the device reads the rows as texels of 16 bytes, and indices as texels of a word.
bool fits_as_texels(const VulkanRows& rows) {
    if (rows.shape.words_per_row < 4 || !compute::fits_as_texels(*rows.device, rows.rows.bytes)) return false;
    const std::uint64_t first = first_index_byte(rows.shape);
    return rows.shape.index_bits == 0 ||
           compute::fits_as_texels(*rows.device, rows.rows.bytes - first, sizeof(std::uint32_t), first);
}

const compute::Pipeline& pipeline_for(const VulkanRows& rows, const PipelineKey& key) {
    const std::lock_guard lock(rows.pipelines_mutex);
    if (const auto found = rows.pipelines.find(key); found != rows.pipelines.end()) return found->second;
    const std::array<compute::SpecializationConstant, 8> constants{{
        {0, static_cast<std::uint32_t>(rows.shape.resolution)},
        {1, static_cast<std::uint32_t>(rows.shape.words_per_row)},
        {2, static_cast<std::uint32_t>(key.subrays)},
        {3, static_cast<std::uint32_t>(key.clip)},
        {4, key.shade},
        {5, key.kind_of_all_lights},
        {6, static_cast<std::uint32_t>(rows.shape.index_bits)},
        {7, static_cast<std::uint32_t>(rows.shape.index_start)},
    }};
    const auto words = rows.as_texels ? spirv::voxel_rows_lighting_texels() : spirv::voxel_rows_lighting();
    compute::Pipeline pipeline =
        compute::make_pipeline(rows.device, words, sizeof(LightingJob), constants, rows.as_texels ? texel_buffers : 0);
    return rows.pipelines.emplace(key, std::move(pipeline)).first->second;
}

std::uint32_t kind_of_all(std::span<const LightRecord> lights) {
    if (lights.empty()) return light_point;
    const bool same =
        std::ranges::all_of(lights, [&](const LightRecord& light) { return light.kind == lights[0].kind; });
    return same ? lights[0].kind : mixed_lights;
}

/// The pieces of the picture that are uploaded and resolved together. A GPU needs more pixels to be busy.
std::vector<PixelRect> tiles_of(ImageSize size, compute::DeviceKind kind) {
    const int width = kind == compute::DeviceKind::cpu ? 128 : 512;
    const int height = kind == compute::DeviceKind::cpu ? 64 : 256;
    std::vector<PixelRect> tiles;
    for (int y = 0; y < size.height; y += height)
        for (int x = 0; x < size.width; x += width)
            tiles.push_back({x, y, std::min(width, size.width - x), std::min(height, size.height - y)});
    return tiles;
}

/// Memory and pipeline for asking all lights from one tile after another.
struct TileAsker {
    const VulkanRows& rows;
    const compute::Pipeline& pipeline;
    std::optional<compute::BoundTexels> texels{};
    compute::Buffer lights{};
    compute::Buffer surfaces{}, sums{}, verdicts{};  ///< of one tile, mapped
    LightingJob job{};
    std::optional<ObjectAsker> objects{};  ///< asked after the array
    std::uint32_t light_count = 0;
    double pairs_per_second = 2.0e7;  ///< of the last dispatch; at first a guess low enough for any device

    std::span<PixelSums> tile_sums() const {
        return {reinterpret_cast<PixelSums*>(sums.mapped.data()), sums.bytes / sizeof(PixelSums)};
    }
};

compute::Buffer host_buffer(const VulkanRows& rows, std::uint64_t bytes) {
    return compute::make_buffer(rows.device, std::max<std::uint64_t>(bytes, 16), compute::MemoryPlace::host);
}

std::size_t most_pixels_of_a_tile(const VulkanRows& rows, const RenderRequest& request) {
    std::size_t most_pixels = 0;
    for (const PixelRect& tile : tiles_of(request.surfaces->size, rows.device->info.kind))
        most_pixels =
            std::max(most_pixels, static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height));
    return (most_pixels + workgroup - 1) / workgroup * workgroup;
}

/// Lets the objects be asked too: then the array leaves verdicts, and the objects' pipeline shades.
void add_objects(TileAsker& asker, const ObjectsOnDevice& objects, const RenderRequest& request, bool shade,
                 std::uint32_t kind_of_all_lights, const Progress& progress) {
    asker.objects =
        make_object_asker(objects, request.parameters, shade, kind_of_all_lights, asker.job.query.reach_m, progress);
    ObjectLightingJob& job = asker.objects->job;
    job.lights = asker.job.lights;
    job.surfaces = asker.job.surfaces;
    job.sums = asker.job.sums;
    job.verdicts = asker.job.verdicts;
    job.words_per_pixel = asker.job.words_per_pixel;
}

TileAsker make_asker(const VulkanRows& rows, const RowArray& array, const RenderRequest& request, bool shade,
                     const Progress& progress, const ObjectsOnDevice& objects) {
    const RowShape query = make_query(array, request.parameters, request.lights);
    const std::vector<LightRecord> lights = light_records(request.lights);
    const bool array_shades = shade && objects.empty();
    const PipelineKey key{query.subrays, query.clip_to_bounds, array_shades ? 1u : 0u, kind_of_all(lights)};
    TileAsker asker{rows, pipeline_for(rows, key)};
    asker.texels = bind_rows(rows, asker.pipeline);
    const std::size_t most_pixels = most_pixels_of_a_tile(rows, request);
    asker.light_count = static_cast<std::uint32_t>(lights.size());
    const bool verdicts = (request.keep_verdicts && shade) || !objects.empty();
    const std::uint32_t words_per_pixel = verdicts ? (asker.light_count + 31) / 32 : 0;
    asker.lights = compute::make_buffer(rows.device, std::max<std::uint64_t>(lights.size() * sizeof(LightRecord), 16),
                                        compute::MemoryPlace::device);
    compute::upload(asker.lights, std::as_bytes(std::span(lights)), progress);
    asker.surfaces = host_buffer(rows, most_pixels * sizeof(SurfacePoint));
    asker.sums = host_buffer(rows, most_pixels * sizeof(PixelSums));
    asker.verdicts = host_buffer(rows, most_pixels * words_per_pixel * sizeof(std::uint32_t));
    asker.job = {query,
                 0,
                 rows.frames.address,
                 rows.rows.address,
                 asker.lights.address,
                 asker.surfaces.address,
                 asker.sums.address,
                 asker.verdicts.address,
                 0,
                 words_per_pixel};
    if (!objects.empty()) add_objects(asker, objects, request, shade, key.kind_of_all_lights, progress);
    return asker;
}

/// Copies the surfaces into mapped memory, padded to whole workgroups with pixels that ask nothing.
std::uint32_t place_surfaces(const TileAsker& asker, const PixelGroups& pixels) {
    const std::size_t padded = (pixels.pixel.size() + workgroup - 1) / workgroup * workgroup;
    auto* points = reinterpret_cast<SurfacePoint*>(asker.surfaces.mapped.data());
    for (std::size_t k = 0; k < padded; ++k) {
        const std::size_t from = std::min(k, pixels.pixel.size() - 1);
        for (int axis = 0; axis < 3; ++axis) {
            points[k].position[axis] = pixels.position[axis][from];
            points[k].normal[axis] = k == from ? pixels.normal[axis][from] : 0.0f;
            points[k].shading_normal[axis] = pixels.shading_normal[axis][from];
        }
    }
    return static_cast<std::uint32_t>(padded);
}

/// Asks all lights from the tile's pixels, in dispatches short enough for others to use the device in between. Where
/// the lights are cut does not change the result: each pixel's sums go on where they were left.
void ask_tile(TileAsker& asker, const PixelGroups& pixels, const Progress& progress) {
    const std::uint32_t count = place_surfaces(asker, pixels);
    if (asker.light_count == 0) std::ranges::fill(asker.tile_sums(), PixelSums{});
    asker.job.first_light = 0;
    while (asker.job.first_light < asker.light_count) {
        progress.check();
        const double fitting = asker.pairs_per_second * longest_dispatch_seconds / count;
        const auto step = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, 1.0e6)) / light_step * light_step;
        asker.job.end_light = std::min(asker.job.first_light + std::max(step, light_step), asker.light_count);
        double seconds = compute::dispatch(asker.pipeline, std::as_bytes(std::span(&asker.job, 1)),
                                           {count / workgroup, 1, 1}, asker.texels ? &*asker.texels : nullptr);
        if (asker.objects)
            seconds += ask_objects(*asker.objects, asker.job.first_light, asker.job.end_light, count / workgroup);
        const double pairs = static_cast<double>(count) * (asker.job.end_light - asker.job.first_light);
        asker.pairs_per_second = pairs / std::max(seconds, 1.0e-6);
        asker.job.first_light = asker.job.end_light;
    }
}

/// Puts a tile's sums into the picture.
void resolve(const TileAsker& asker, const PixelGroups& pixels, const SurfaceBuffer& surfaces, RenderResult& result) {
    const std::span<const PixelSums> sums = asker.tile_sums();
    const auto* verdicts = reinterpret_cast<const std::uint32_t*>(asker.verdicts.mapped.data());
    const std::size_t words = result.verdicts.words.empty() ? 0 : asker.job.words_per_pixel;
    for (std::size_t k = 0; k < pixels.pixel.size(); ++k) {
        const std::size_t pixel = pixels.pixel[k];
        if (pixels.pixel[k] == no_triangle) continue;
        const vec3 reflected = surfaces.albedo[pixel] * std::numbers::inv_pi_v<float> * sums[k].irradiance;
        result.radiance.pixels[pixel] = surfaces.emission[pixel] + reflected;
        result.rays_asked.pixels[pixel] = sums[k].asked;
        result.shadow.pixels[pixel] =
            sums[k].asked == 0 ? 0.0f : static_cast<float>(sums[k].blocked) / static_cast<float>(sums[k].asked);
        if (words > 0) std::copy_n(verdicts + k * words, words, &result.verdicts.words[pixel * words]);
    }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::optional<compute::BoundTexels> bind_rows(const VulkanRows& rows, const compute::Pipeline& pipeline) {
    if (!rows.as_texels) return std::nullopt;
    // Something must be bound for the indices where there are none, too.
    const compute::TexelSource indices =
        rows.shape.index_bits == 0 ? compute::TexelSource{&rows.frames, VK_FORMAT_R32_UINT}
                                   : compute::TexelSource{&rows.rows, VK_FORMAT_R32_UINT, first_index_byte(rows.shape)};
    const std::array<compute::TexelSource, texel_buffers> sources{
        {{&rows.frames, VK_FORMAT_R32G32B32A32_SFLOAT}, {&rows.rows, VK_FORMAT_R32G32B32A32_UINT}, indices}};
    return compute::bind_texels(pipeline, sources);
}

std::shared_ptr<const VulkanRows> give_to_vulkan(const RowArray& array, Progress& progress) {
    const auto rows = std::make_shared<VulkanRows>();
    rows->device = compute::open_device();
    rows->shape = make_shape(array);
    rows->words_owner = array.words.owner;
    rows->rows = compute::give_to_device(rows->device, std::as_bytes(array.words.words), progress);
    rows->frames = compute::make_buffer(rows->device, array.grid.frames.size() * sizeof(DirectionFrame),
                                        compute::MemoryPlace::device);
    compute::upload(rows->frames, std::as_bytes(std::span(array.grid.frames)), progress);
    // A software device reads an address word by word and ray by ray, but a texel of 16 bytes at once.
    rows->as_texels = rows->device->info.kind == compute::DeviceKind::cpu && fits_as_texels(*rows);
    return rows;
}

RenderResult render_on_vulkan(const VulkanRows& rows, const RowArray& array, const RenderRequest& request,
                              Progress& progress, const ObjectsOnDevice& objects) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    RenderResult result = blank_result(request);
    std::vector<PixelRect> tiles = tiles_of(surfaces.size, rows.device->info.kind);
    if (request.reverse_tiles) std::ranges::reverse(tiles);
    const std::vector<RefinementPass> passes = refinement_passes(static_cast<bool>(request.on_region));
    progress.begin("asking shadow rays", static_cast<std::int64_t>(tiles.size() * passes.size()));
    const auto start = std::chrono::steady_clock::now();
    TileAsker asker = make_asker(rows, array, request, true, progress, objects);
    for (const RefinementPass& pass : passes) {
        for (const PixelRect& tile : tiles) {
            const PixelGroups pixels = group_pixels(surfaces, tile, pass.stride, pass.skip_stride);
            if (pixels.pixel.size() / pixel_group_size > 0) {
                ask_tile(asker, pixels, progress);
                resolve(asker, pixels, surfaces, result);
            }
            if (request.on_region) {
                fill_blocks(result, *request.surfaces, tile, pass.stride);
                request.on_region(result, tile);
            }
            progress.advance();
        }
    }
    count_rays(result);
    result.seconds = seconds_since(start);
    result.device = rows.device->info.name;
    return result;
}

QueryCount count_blocked_on_vulkan(const VulkanRows& rows, const RowArray& array, const RenderRequest& request,
                                   const ObjectsOnDevice& objects) {
    const auto start = std::chrono::steady_clock::now();
    const Progress progress;
    TileAsker asker = make_asker(rows, array, request, false, progress, objects);
    QueryCount total;
    for (const PixelRect& tile : tiles_of(request.surfaces->size, rows.device->info.kind)) {
        const PixelGroups pixels = group_pixels(*request.surfaces, tile, 1, 0);
        if (pixels.pixel.size() / pixel_group_size == 0) continue;
        ask_tile(asker, pixels, progress);
        for (const PixelSums& sums : asker.tile_sums().first(pixels.pixel.size())) {
            total.rays += sums.asked;
            total.blocked += sums.blocked;
        }
    }
    total.seconds = seconds_since(start);
    return total;
}

}  // namespace sightlines::voxel_rows
