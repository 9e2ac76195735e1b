// Algorithm 4 on the CPU, by the wide compilation of the kernel. Lights outside, pixels inside: for one light the
// rays of neighbouring pixels want neighbouring rows. Each group of rays is located and its rows are prefetched some
// groups before its bits are looked at, because the array is far larger than any cache.
#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/voxel_rows.h"
#include "techniques/base/parallel.h"
#include "techniques/rays/light_records.h"
#include "techniques/refinement.h"
#include "techniques/voxel_rows/pixel_groups.h"
#include "techniques/voxel_rows/query.h"

namespace sightlines::voxel_rows {
namespace {

namespace wide = wide_kernel;
using wide::Int;
using wide::lanes;
using wide::Mask;
using wide::Real;
using wide::UInt;
using wide::Vec3;

constexpr int tile_width = 128, tile_height = 64;  ///< pixels; a tile's sums and surfaces stay in the second-level cache
constexpr float inverse_pi = 0.318309886f;
constexpr std::size_t batch_vectors = 32;  ///< that go through a step together

/// What is summed for each pixel of a tile.
struct TileSums {
    std::vector<int> asked, blocked;   ///< [G * 16]
    std::vector<float> irradiance[3];  ///< [G * 16], W/m^2; empty when only counting

    TileSums(std::size_t pixels, bool shade) : asked(pixels), blocked(pixels) {
        if (shade)
            for (auto& channel : irradiance) channel.resize(pixels);
    }
};

/// One vector of rays on its way through the three steps: discretise, locate, look.
struct PendingRays {
    wide::Direction direction;
    wide::RowSpan near, far;
    Mask asked;
    std::size_t start;  ///< of its pixels in the tile
};

/// The vectors of one batch in which any ray is asked.
struct Batch {
    std::array<PendingRays, batch_vectors> rays;
    std::size_t count = 0;
};

struct TileWork {
    wide::FrameTable frames;
    wide::Rows rows;
    RowShape query;
    std::span<const LightRecord> lights;
    const PixelGroups& pixels;
    Verdicts* verdicts;  ///< may be null
};

HWY_INLINE Vec3 load_three(const std::vector<float> (&axes)[3], std::size_t start) {
    return {wide::load(&axes[0][start]), wide::load(&axes[1][start]), wide::load(&axes[2][start])};
}

/// The rows of some rays spread over the block of 4 x 4 pixels; those of the others mostly share their cache lines.
HWY_INLINE void prefetch_rows(const wide::Rows& rows, const UInt& row, int words_per_row) {
    constexpr std::size_t step = lanes == 16 ? 3 : 1;
    const auto* index = reinterpret_cast<const uint*>(&row);
    for (std::size_t lane = 0; lane < lanes; lane += step)
        __builtin_prefetch(rows.v + static_cast<std::size_t>(index[lane]) * words_per_row);
}

HWY_INLINE void prefetch(const TileWork& work, const RowShape& query, const PendingRays& rays) {
    prefetch_rows(work.rows, rays.near.row, query.words_per_row);
    if (query.subrays == 2) prefetch_rows(work.rows, rays.far.row, query.words_per_row);
}

/// The ray's ends as the kernel looks them up: off the surface, and inside the bounds where lights may be outside.
HWY_INLINE void ray_ends(const TileWork& work, const RowShape& query, std::size_t start, Vec3 to_light, Vec3& a, Vec3& b) {
    const Vec3 position = load_three(work.pixels.position, start);
    const Vec3 normal = load_three(work.pixels.normal, start);
    a = wide::ray_origin(query, position, normal);
    b = position + to_light;
    if (query.clip_to_bounds != 0) wide::clip_to_bounds(query, a, b);
}

HWY_INLINE Vec3 to_light_of(const TileWork& work, const LightRecord& light, std::size_t start) {
    return wide::to_light(light, load_three(work.pixels.position, start), work.query.reach_m);
}

/// Takes up those of the vectors first, first + 1 ... in which any light ray starts from the front of its surface.
HWY_INLINE void gather_asked(const TileWork& work, const LightRecord& light, std::size_t first, std::size_t count,
                             Batch& batch) {
    batch.count = 0;
    for (std::size_t k = first; k < first + count; ++k) {
        const std::size_t start = k * lanes;
        PendingRays& rays = batch.rays[batch.count];
        rays.asked = wide::is_asked(load_three(work.pixels.normal, start), to_light_of(work, light, start));
        rays.start = start;
        batch.count += wide::any(rays.asked) ? 1 : 0;
    }
}

HWY_INLINE void discretize(const TileWork& work, const RowShape& query, const LightRecord& light, PendingRays& rays) {
    Vec3 a, b;
    ray_ends(work, query, rays.start, to_light_of(work, light, rays.start), a, b);
    rays.direction = wide::discretize_direction(query, b - a);
}

HWY_INLINE void locate(const TileWork& work, const RowShape& query, const LightRecord& light, PendingRays& rays) {
    Vec3 a, b;
    ray_ends(work, query, rays.start, to_light_of(work, light, rays.start), a, b);
    wide::locate_spans(query, work.frames, rays.direction, a, b, rays.near, rays.far);
}

HWY_INLINE void add(std::vector<int>& sums, std::size_t start, Mask mask) {
    const wide::IntTag tag;
    const auto ones = wide::select(mask, wide::splat(1), wide::splat(0));
    wide::store(Int{wide::hn::LoadU(tag, &sums[start])} + ones, &sums[start]);
}

void keep_verdicts(const TileWork& work, std::size_t start, std::uint32_t light, Mask blocked) {
    for (std::uint32_t bits = wide::bits_of(blocked); bits != 0; bits &= bits - 1) {
        const std::size_t pixel = work.pixels.pixel[start + static_cast<std::size_t>(__builtin_ctz(bits))];
        work.verdicts->words[pixel * work.verdicts->words_per_pixel + light / 32u] |= 1u << (light % 32u);
    }
}

template <bool shade>
HWY_INLINE void look(const TileWork& work, const RowShape& query, std::uint32_t light, const PendingRays& rays,
                     TileSums& sums) {
    Mask blocked = wide::span_is_blocked(query, work.rows, rays.near);
    if (query.subrays == 2) blocked = blocked || wide::span_is_blocked(query, work.rows, rays.far);
    blocked = blocked && rays.asked;
    add(sums.asked, rays.start, rays.asked);
    add(sums.blocked, rays.start, blocked);
    if constexpr (shade) {
        const LightRecord& record = work.lights[light];
        const Real unshadowed = wide::irradiance_per_intensity(record, load_three(work.pixels.normal, rays.start),
                                                               to_light_of(work, record, rays.start));
        const Real given = wide::select(rays.asked && !blocked, unshadowed, wide::splat(0.0f));
        for (int channel = 0; channel < 3; ++channel) {
            float* sum = &sums.irradiance[channel][rays.start];
            wide::store(wide::fused(given, wide::splat(record.intensity[channel]), wide::load(sum)), sum);
        }
        if (work.verdicts != nullptr) keep_verdicts(work, rays.start, light, blocked);
    }
}

/// All lights over one tile, batch after batch of its vectors. Each step runs over a whole batch before the next, so
/// that no vector waits for itself; a batch's rows are on their way from memory while the next one is located.
/// `words_per_row` is repeated as a constant, so that the loops over words unroll.
template <bool shade, int words_per_row> void ask_tile(const TileWork& work, TileSums& sums) {
    RowShape query = work.query;
    query.words_per_row = words_per_row;
    const std::size_t vectors = work.pixels.pixel.size() / lanes;
    std::array<Batch, 2> batches;
    std::size_t current = 0;
    std::uint32_t light_before = 0;
    for (std::uint32_t light = 0; light < work.lights.size(); ++light) {
        const LightRecord record = work.lights[light];
        for (std::size_t first = 0; first < vectors; first += batch_vectors) {
            Batch& now = batches[current];
            gather_asked(work, record, first, std::min(batch_vectors, vectors - first), now);
            for (std::size_t k = 0; k < now.count; ++k) discretize(work, query, record, now.rays[k]);
            for (std::size_t k = 0; k < now.count; ++k) locate(work, query, record, now.rays[k]);
            for (std::size_t k = 0; k < now.count; ++k) prefetch(work, query, now.rays[k]);
            const Batch& before = batches[1 - current];
            for (std::size_t k = 0; k < before.count; ++k) look<shade>(work, query, light_before, before.rays[k], sums);
            current = 1 - current;
            light_before = light;
        }
    }
    const Batch& last = batches[1 - current];
    for (std::size_t k = 0; k < last.count; ++k) look<shade>(work, query, light_before, last.rays[k], sums);
}

template <bool shade> void ask_tile(const TileWork& work, TileSums& sums) {
    switch (work.query.words_per_row) {
        case 1: return ask_tile<shade, 1>(work, sums);
        case 2: return ask_tile<shade, 2>(work, sums);
        case 4: return ask_tile<shade, 4>(work, sums);
        default: return ask_tile<shade, 8>(work, sums);
    }
}

std::vector<PixelRect> tiles_of(ImageSize size) {
    std::vector<PixelRect> tiles;
    for (int y = 0; y < size.height; y += tile_height)
        for (int x = 0; x < size.width; x += tile_width)
            tiles.push_back({x, y, std::min(tile_width, size.width - x), std::min(tile_height, size.height - y)});
    return tiles;
}

TileWork tile_work(const RowArray& array, const RowShape& query, std::span<const LightRecord> lights,
                   const PixelGroups& pixels, Verdicts* verdicts) {
    return {{array.grid.frames.data()}, {array.words.words.data()}, query, lights, pixels, verdicts};
}

}  // namespace

void are_blocked(const RowArray& array, const RowShape& query, std::span<const Segment> segments,
                 std::span<const vec3> normals, std::span<std::uint8_t> answers) {
    const wide::FrameTable frames{array.grid.frames.data()};
    const wide::Rows rows{array.words.words.data()};
    for (std::size_t start = 0; start < segments.size(); start += lanes) {
        const std::size_t count = std::min(lanes, segments.size() - start);
        alignas(64) float numbers[9][lanes] = {};
        for (std::size_t lane = 0; lane < count; ++lane) {
            for (int axis = 0; axis < 3; ++axis) {
                numbers[axis][lane] = segments[start + lane].origin[axis];
                numbers[3 + axis][lane] = segments[start + lane].target[axis];
                numbers[6 + axis][lane] = normals[start + lane][axis];
            }
        }
        const auto three = [&](int k) {
            return Vec3{wide::load(numbers[k]), wide::load(numbers[k + 1]), wide::load(numbers[k + 2])};
        };
        const Vec3 origin = wide::ray_origin(query, three(0), three(6));
        const std::uint32_t bits = wide::bits_of(wide::is_blocked(query, frames, rows, origin, three(3)));
        for (std::size_t lane = 0; lane < count; ++lane) answers[start + lane] = (bits >> lane) & 1u;
    }
}

QueryCount count_blocked_on_cpu(const RowArray& array, const RenderRequest& request) {
    const RowShape query = make_query(array, request.parameters, request.lights);
    const std::vector<LightRecord> lights = light_records(request.lights);
    const std::vector<PixelRect> tiles = tiles_of(request.surfaces->size);
    std::vector<QueryCount> counts(tiles.size());
    const auto start = std::chrono::steady_clock::now();
    parallel_for(static_cast<std::int64_t>(tiles.size()), request.threads, [&](std::int64_t tile) {
        const PixelGroups pixels = group_pixels(*request.surfaces, tiles[static_cast<std::size_t>(tile)], 1, 0);
        TileSums sums(pixels.pixel.size(), false);
        ask_tile<false>(tile_work(array, query, lights, pixels, nullptr), sums);
        QueryCount& count = counts[static_cast<std::size_t>(tile)];
        for (const int asked : sums.asked) count.rays += static_cast<std::uint64_t>(asked);
        for (const int blocked : sums.blocked) count.blocked += static_cast<std::uint64_t>(blocked);
    });
    QueryCount total;
    for (const QueryCount& count : counts) {
        total.rays += count.rays;
        total.blocked += count.blocked;
    }
    total.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return total;
}

namespace {

/// Puts a tile's sums into the picture.
void resolve(const PixelGroups& pixels, const TileSums& sums, const SurfaceBuffer& surfaces, RenderResult& result) {
    for (std::size_t k = 0; k < pixels.pixel.size(); ++k) {
        const std::uint32_t pixel = pixels.pixel[k];
        if (pixel == no_triangle) continue;
        const vec3 irradiance(sums.irradiance[0][k], sums.irradiance[1][k], sums.irradiance[2][k]);
        result.radiance.pixels[pixel] = surfaces.emission[pixel] + surfaces.albedo[pixel] * inverse_pi * irradiance;
        result.rays_asked.pixels[pixel] = static_cast<std::uint32_t>(sums.asked[k]);
        result.shadow.pixels[pixel] =
            sums.asked[k] == 0 ? 0.0f : static_cast<float>(sums.blocked[k]) / static_cast<float>(sums.asked[k]);
    }
}

}  // namespace

RenderResult render_on_cpu(const RowArray& array, const RenderRequest& request, Progress& progress) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const RowShape query = make_query(array, request.parameters, request.lights);
    const std::vector<LightRecord> lights = light_records(request.lights);
    RenderResult result = blank_result(request);
    std::vector<PixelRect> tiles = tiles_of(surfaces.size);
    if (request.reverse_tiles) std::ranges::reverse(tiles);
    const std::vector<RefinementPass> passes = refinement_passes(static_cast<bool>(request.on_region));
    progress.begin("asking shadow rays", static_cast<std::int64_t>(tiles.size() * passes.size()));
    const auto start = std::chrono::steady_clock::now();
    std::mutex region_mutex;
    for (const RefinementPass& pass : passes) {
        parallel_for(static_cast<std::int64_t>(tiles.size()), request.threads, [&](std::int64_t index) {
            const PixelRect tile = tiles[static_cast<std::size_t>(index)];
            const PixelGroups pixels = group_pixels(surfaces, tile, pass.stride, pass.skip_stride);
            TileSums sums(pixels.pixel.size(), true);
            Verdicts* verdicts = request.keep_verdicts ? &result.verdicts : nullptr;
            ask_tile<true>(tile_work(array, query, lights, pixels, verdicts), sums);
            {
                const std::lock_guard lock(region_mutex);
                resolve(pixels, sums, surfaces, result);
                if (request.on_region) {
                    fill_blocks(result, surfaces, tile, pass.stride);
                    request.on_region(result, tile);
                }
            }
            progress.advance();
        });
    }
    count_rays(result);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.device = "CPU, " + std::to_string(thread_count(request.threads)) + " threads, " +
                    std::to_string(lanes) + " wide";
    return result;
}

}  // namespace sightlines::voxel_rows
