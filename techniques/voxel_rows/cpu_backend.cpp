// Algorithm 4 on the CPU, by the wide compilation of the kernel. Lights outside, pixels inside: for one light the
// rays of neighbouring pixels want neighbouring rows. Each group of rays is located and its rows are prefetched some
// groups before its bits are looked at, because the array is far larger than any cache.
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <mutex>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/voxel_rows.h"
#include "techniques/base/parallel.h"
#include "techniques/packed_bits.h"
#include "techniques/pixel_groups.h"
#include "techniques/rays/light_records.h"
#include "techniques/refinement.h"
#include "techniques/voxel_rows/cpu_objects.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/row_bits.h"

namespace sightlines::voxel_rows {
namespace {

namespace wide = wide_kernel;
using wide::Int;
using wide::lanes;
using wide::Mask;
using wide::Real;
using wide::UInt;
using wide::Vec3;

constexpr int tile_width = 64, tile_height = 64;  ///< pixels; a tile's sums and surfaces stay in the second-level cache
constexpr float inverse_pi = 0.318309886f;
constexpr std::size_t batch_vectors = 64;             ///< that go through a step together
constexpr std::uint32_t lights_between_checks = 256;  ///< whether to stop

/// What is summed for each pixel of a tile.
struct TileSums {
    std::vector<int> asked, blocked;   ///< [G * 16]
    std::vector<float> irradiance[3];  ///< [G * 16], W/m^2; empty when only counting

    TileSums(std::size_t pixels, bool shade) : asked(pixels), blocked(pixels) {
        if (shade)
            for (auto& channel : irradiance) channel.resize(pixels);
    }
};

/// One vector of rays on its way through the steps.
struct PendingRays {
    wide::Direction direction;
    Int frame;               ///< its place in the table
    wide::RowSpan spans[2];  ///< [subrays]
};

/// The rays that a batch of vectors of pixels asks of one light, packed so that no lane is idle.
struct Batch {
    std::uint32_t light = 0;
    std::size_t first = 0, count = 0;                ///< the vectors of pixels
    std::array<std::uint32_t, batch_vectors> asked;  ///< which pixels of each ask, bit by lane
    std::size_t rays = 0;                            ///< in all
    bool common_end = false;                         ///< all rays end at the light itself; b is not kept
    std::array<std::array<float, (batch_vectors + 1) * lanes>, 6> ends;  ///< x, y, z of a, then of b; packed
    std::array<PendingRays, batch_vectors> pending;                      ///< vectors of packed rays

    std::size_t vectors() const { return (rays + lanes - 1) / lanes; }
};

struct TileWork {
    wide::FrameTable frames;
    wide::Rows rows;
    RowShape query;
    std::span<const LightRecord> lights;
    const PixelGroups& pixels;
    Verdicts* verdicts;          ///< may be null
    const Progress* progress;    ///< may be null
    const ObjectQuery& objects;  ///< asked after the array
    PixelBounds bounds;          ///< empty without objects
};

HWY_INLINE Vec3 load_three(const std::vector<float> (&axes)[3], std::size_t start) {
    return {wide::load(&axes[0][start]), wide::load(&axes[1][start]), wide::load(&axes[2][start])};
}

/// The rows of some rays spread over the block of 4 x 4 pixels; those of the others mostly share their cache lines.
HWY_INLINE void prefetch_rows(const wide::Rows& rows, const UInt& row, int words_per_row) {
    constexpr std::size_t step = lanes == 16 ? 5 : 1;
    const auto* index = reinterpret_cast<const uint*>(&row);
    for (std::size_t lane = 0; lane < lanes; lane += step)
        __builtin_prefetch(rows.v + static_cast<std::size_t>(index[lane]) * words_per_row);
}

/// The same for the indices of some rays' rows.
HWY_INLINE void prefetch_indices(const wide::Rows& rows, const RowShape& query, const UInt& row) {
    constexpr std::size_t step = lanes == 16 ? 3 : 1;
    const auto* number = reinterpret_cast<const uint*>(&row);
    const auto* bytes = reinterpret_cast<const char*>(rows.v + query.index_start);
    for (std::size_t lane = 0; lane < lanes; lane += step)
        __builtin_prefetch(bytes + std::size_t{number[lane]} * static_cast<std::size_t>(query.index_bits) / 8);
}

/// Dictionary rows lie anywhere: neighbours share only those that they have in common.
HWY_INLINE void prefetch_dictionary(const wide::Rows& rows, const UInt& row, int words_per_row) {
    const auto* index = reinterpret_cast<const uint*>(&row);
    for (std::size_t lane = 0; lane < lanes; ++lane)
        __builtin_prefetch(rows.v + static_cast<std::size_t>(index[lane]) * words_per_row);
}

/// What the batch's rays need next: rows, or indices where the array is compressed.
HWY_INLINE void prefetch(const TileWork& work, const RowShape& query, const PendingRays& rays) {
    for (int part = 0; part < query.subrays; ++part) {
        const UInt& row = rays.spans[part].row;
        if (query.index_bits == 0)
            prefetch_rows(work.rows, row, query.words_per_row);
        else
            prefetch_indices(work.rows, query, row);
    }
}

/// Packs the rays of the batch's pixels that face the light, as the kernel looks them up: off the surface, and inside
/// the bounds where lights may be outside.
HWY_INLINE void gather_asked(const TileWork& work, const RowShape& query, const LightRecord& light, Batch& batch) {
    batch.common_end = light.kind != light_directional && query.clip_to_bounds == 0;
    const std::size_t numbers_kept = batch.common_end ? 3 : 6;
    std::size_t rays = 0;
    for (std::size_t k = 0; k < batch.count; ++k) {
        const std::size_t start = (batch.first + k) * lanes;
        const Vec3 position = load_three(work.pixels.position, start);
        const Vec3 normal = load_three(work.pixels.normal, start);
        const Mask asked = wide::is_asked(normal, wide::to_light(light, position, query.reach_m));
        batch.asked[k] = wide::bits_of(asked);
        Vec3 a = wide::ray_origin(query, position, normal);
        Vec3 b = wide::light_end(light, position, query.reach_m);
        if (query.clip_to_bounds != 0) wide::clip_to_bounds(query, a, b);
        const std::array<Real, 6> numbers{a.x, a.y, a.z, b.x, b.y, b.z};
        for (std::size_t n = 0; n < numbers_kept; ++n) wide::store_compressed(numbers[n], asked, &batch.ends[n][rays]);
        rays += static_cast<std::size_t>(std::popcount(batch.asked[k]));
    }
    batch.rays = rays;
    if (rays == 0) return;
    // The last vector's idle lanes repeat its last ray.
    for (std::size_t n = 0; n < numbers_kept; ++n)
        wide::store(wide::splat(batch.ends[n][rays - 1]), &batch.ends[n][rays]);
}

HWY_INLINE Vec3 load_end(const Batch& batch, std::size_t end, std::size_t start) {
    return {wide::load(&batch.ends[3 * end][start]), wide::load(&batch.ends[3 * end + 1][start]),
            wide::load(&batch.ends[3 * end + 2][start])};
}

HWY_INLINE Vec3 load_light_end(const Batch& batch, const LightRecord& light, std::size_t start) {
    return batch.common_end ? wide::splat(light.position) : load_end(batch, 1, start);
}

/// Where the answers of the batch's rays lie. Each step runs over all vectors before the next, so that none waits for
/// its own last step.
HWY_INLINE void locate(const TileWork& work, const RowShape& query, const LightRecord& light, Batch& batch) {
    const std::size_t vectors = batch.vectors();
    for (std::size_t k = 0; k < vectors; ++k) {
        const Vec3 along_ray = load_light_end(batch, light, k * lanes) - load_end(batch, 0, k * lanes);
        PendingRays& rays = batch.pending[k];
        rays.direction = wide::discretize_direction(query, along_ray);
        rays.frame = wide::frame_index(query, rays.direction);
    }
    for (std::size_t k = 0; k < vectors; ++k) {
        PendingRays& rays = batch.pending[k];
        const Vec3 a = load_end(batch, 0, k * lanes), b = load_light_end(batch, light, k * lanes);
        const wide::Frame frame = wide::load_frame(work.frames, rays.frame);
        for (int part = 0; part < query.subrays; ++part)
            rays.spans[part] = wide::locate_part(query, frame, rays.direction, a, b, part);
    }
    for (std::size_t k = 0; k < vectors; ++k) prefetch(work, query, batch.pending[k]);
}

/// From the array's rows to the dictionary's, whose bits are then on their way from memory.
HWY_INLINE void look_up_indices(const TileWork& work, const RowShape& query, Batch& batch) {
    for (std::size_t k = 0; k < batch.vectors(); ++k) {
        for (int part = 0; part < query.subrays; ++part) {
            UInt& row = batch.pending[k].spans[part].row;
            row = wide::stored_row(query, work.rows, row);
            prefetch_dictionary(work.rows, row, query.words_per_row);
        }
    }
}

HWY_INLINE void add(std::vector<int>& sums, std::size_t start, Mask mask) {
    const wide::IntTag tag;
    const auto ones = wide::select(mask, wide::splat(1), wide::splat(0));
    wide::store(Int{wide::hn::LoadU(tag, &sums[start])} + ones, &sums[start]);
}

void keep_verdicts(const TileWork& work, std::size_t start, std::uint32_t light, std::uint32_t blocked) {
    for (std::uint32_t bits = blocked; bits != 0; bits &= bits - 1) {
        const std::size_t pixel = work.pixels.pixel[start + static_cast<std::size_t>(__builtin_ctz(bits))];
        work.verdicts->words[pixel * work.verdicts->words_per_pixel + light / 32u] |= 1u << (light % 32u);
    }
}

/// Looks at the batch's rows. blocked[i / lanes] has the verdict of packed ray i as bit i % lanes.
HWY_INLINE void look(const TileWork& work, const RowShape& query, const Batch& batch,
                     std::array<std::uint32_t, batch_vectors + 2>& blocked) {
    for (std::size_t k = 0; k < batch.vectors(); ++k) {
        const PendingRays& rays = batch.pending[k];
        Mask in_the_way = wide::span_is_blocked(query, work.rows, rays.spans[0]);
        if (query.subrays == 2) in_the_way = in_the_way || wide::span_is_blocked(query, work.rows, rays.spans[1]);
        blocked[k] = wide::bits_of(in_the_way);
    }
}

/// Asks the objects for the batch's rays that are not blocked yet.
void ask_objects_of(const TileWork& work, const Batch& batch, std::array<std::uint32_t, batch_vectors + 2>& blocked) {
    const BatchOfRays rays{work.pixels, work.bounds, batch.first / batch_vectors, batch.first,
                           std::span(batch.asked).first(batch.count)};
    ask_objects(work.objects, rays, work.lights[batch.light], blocked);
}

/// Adds the batch's answers to the sums of its pixels.
template <bool shade>
HWY_INLINE void add_answers(const TileWork& work, const Batch& batch,
                            const std::array<std::uint32_t, batch_vectors + 2>& packed, TileSums& sums) {
    const LightRecord record = work.lights[batch.light];
    std::size_t ray = 0;
    for (std::size_t k = 0; k < batch.count; ++k) {
        const std::uint32_t asked_bits = batch.asked[k];
        if (asked_bits == 0) continue;
        // The next rays' answers, spread back to the lanes that asked.
        const std::uint64_t two = packed[ray / lanes] | static_cast<std::uint64_t>(packed[ray / lanes + 1]) << lanes;
        const std::uint32_t blocked_bits = deposit_bits(static_cast<std::uint32_t>(two >> (ray % lanes)), asked_bits);
        ray += static_cast<std::size_t>(std::popcount(asked_bits));
        const std::size_t start = (batch.first + k) * lanes;
        const Mask asked = wide::mask_of(asked_bits), blocked = wide::mask_of(blocked_bits);
        add(sums.asked, start, asked);
        add(sums.blocked, start, blocked);
        if constexpr (shade) {
            const Vec3 position = load_three(work.pixels.position, start);
            const Real unshadowed =
                wide::irradiance_per_intensity(record, load_three(work.pixels.shading_normal, start),
                                               wide::to_light(record, position, work.query.reach_m));
            const Real given = wide::select(asked && !blocked, unshadowed, wide::splat(0.0f));
            for (int channel = 0; channel < 3; ++channel) {
                float* sum = &sums.irradiance[channel][start];
                wide::store(wide::fused(given, wide::splat(record.intensity[channel]), wide::load(sum)), sum);
            }
            if (work.verdicts != nullptr) keep_verdicts(work, start, batch.light, blocked_bits);
        }
    }
}

/// All lights over one tile, batch after batch of its vectors. What a batch needs next from memory is on its way while
/// later ones are located: its indices where there are any, then its rows. What the template repeats of the query is
/// constant, so that loops unroll and an array without a dictionary pays nothing for it.
template <bool shade, int words_per_row, int subrays, int index_bits>
void ask_tile(const TileWork& work, TileSums& sums) {
    RowShape query = work.query;
    query.words_per_row = words_per_row;
    query.subrays = subrays;
    query.index_bits = index_bits;
    constexpr std::size_t stages = index_bits == 0 ? 2 : 3;
    const std::size_t vectors = work.pixels.pixel.size() / lanes;
    std::array<Batch, stages> batches;
    std::array<std::uint32_t, batch_vectors + 2> blocked{};
    const std::size_t batches_per_light = (vectors + batch_vectors - 1) / batch_vectors;
    const std::size_t count = batches_per_light * work.lights.size();
    // Of the older batches the last but one gets its rows, the oldest its answers. They start and end empty. One place
    // for each step: compiled out of line, they would not see what is constant of the query.
    for (std::size_t step = 0; step < count + stages - 1; ++step) {
        Batch& newest = batches[step % stages];
        newest.count = newest.rays = 0;
        if (step < count) {
            newest.light = static_cast<std::uint32_t>(step / batches_per_light);
            newest.first = step % batches_per_light * batch_vectors;
            newest.count = std::min(batch_vectors, vectors - newest.first);
            if (work.progress != nullptr && newest.first == 0 && newest.light % lights_between_checks == 0)
                work.progress->check();
            const LightRecord record = work.lights[newest.light];
            gather_asked(work, query, record, newest);
            locate(work, query, record, newest);
        }
        if constexpr (index_bits != 0) look_up_indices(work, query, batches[(step + stages - 1) % stages]);
        const Batch& oldest = batches[(step + 1) % stages];
        look(work, query, oldest, blocked);
        if (!work.objects.instances.empty() && oldest.rays != 0) ask_objects_of(work, oldest, blocked);
        add_answers<shade>(work, oldest, blocked, sums);
    }
}

template <bool shade, int words_per_row, int subrays>
void ask_tile(const TileWork& work, TileSums& sums) {
    switch (work.query.index_bits) {
        case 0:
            return ask_tile<shade, words_per_row, subrays, 0>(work, sums);
        case 20:
            return ask_tile<shade, words_per_row, subrays, 20>(work, sums);
        default:
            return ask_tile<shade, words_per_row, subrays, 32>(work, sums);
    }
}

template <bool shade, int words_per_row>
void ask_tile(const TileWork& work, TileSums& sums) {
    if (work.query.subrays == 1) return ask_tile<shade, words_per_row, 1>(work, sums);
    return ask_tile<shade, words_per_row, 2>(work, sums);
}

template <bool shade>
void ask_tile(const TileWork& work, TileSums& sums) {
    if (work.lights.empty()) return;
    with_row_length(work.query.words_per_row, [&](auto length) { ask_tile<shade, length()>(work, sums); });
}

std::vector<PixelRect> tiles_of(ImageSize size) {
    std::vector<PixelRect> tiles;
    for (int y = 0; y < size.height; y += tile_height)
        for (int x = 0; x < size.width; x += tile_width)
            tiles.push_back({x, y, std::min(tile_width, size.width - x), std::min(tile_height, size.height - y)});
    return tiles;
}

TileWork tile_work(const RowArray& array, const RowShape& query, std::span<const LightRecord> lights,
                   const PixelGroups& pixels, Verdicts* verdicts, const Progress* progress,
                   const ObjectQuery& objects) {
    return {{array.grid.frames.data()},
            {array.words.words.data()},
            query,
            lights,
            pixels,
            verdicts,
            progress,
            objects,
            objects.instances.empty() ? PixelBounds() : bounds_of_pixels(pixels, batch_vectors)};
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

QueryCount count_blocked_on_cpu(const RowArray& array, const RenderRequest& request, const Objects& objects) {
    const RowShape query = make_query(array, request.parameters, request.lights);
    const ObjectQuery moving = make_object_query(objects, request.parameters, query.reach_m);
    const std::vector<LightRecord> lights = light_records(request.lights);
    const std::vector<PixelRect> tiles = tiles_of(request.surfaces->size);
    std::vector<QueryCount> counts(tiles.size());
    const auto start = std::chrono::steady_clock::now();
    parallel_for(static_cast<std::int64_t>(tiles.size()), request.threads, [&](std::int64_t tile) {
        const PixelGroups pixels = group_pixels(*request.surfaces, tiles[static_cast<std::size_t>(tile)], 1, 0);
        TileSums sums(pixels.pixel.size(), false);
        ask_tile<false>(tile_work(array, query, lights, pixels, nullptr, nullptr, moving), sums);
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

RenderResult render_on_cpu(const RowArray& array, const RenderRequest& request, Progress& progress,
                           const Objects& objects) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const RowShape query = make_query(array, request.parameters, request.lights);
    const ObjectQuery moving = make_object_query(objects, request.parameters, query.reach_m);
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
            ask_tile<true>(tile_work(array, query, lights, pixels, verdicts, &progress, moving), sums);
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
    result.device =
        "CPU, " + std::to_string(thread_count(request.threads)) + " threads, " + std::to_string(lanes) + " wide";
    return result;
}

}  // namespace sightlines::voxel_rows
