// Algorithm 4 for the baselines: every light for every pixel, in vectors of up to 16 rays. What differs from one to the
// next is a judge: how a batch of rays to one light is answered. Include shaders/wide.h first.
#pragma once

#ifndef SIGHTLINES_WIDE_H
#error "include shaders/wide.h first"
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <mutex>

#include "shaders/lighting.h"
#include "techniques/base/parallel.h"
#include "techniques/baselines/tiles.h"
#include "techniques/packed_bits.h"
#include "techniques/rays/light_records.h"
#include "techniques/rays/reference.h"

namespace sightlines::baselines {

namespace wide = wide_kernel;

constexpr std::size_t batch_vectors = 32;  ///< of pixels that ask one light together

/// The answers to a batch of packed rays: ray i is bit i % lanes of word i / lanes.
using PackedVerdicts = std::array<std::uint32_t, batch_vectors + 2>;

/// The rays that some vectors of pixels ask of one light, packed so that no lane is idle but in the last vector, whose
/// idle lanes repeat its last ray.
struct RayBatch {
    std::size_t rays = 0;
    alignas(64) std::array<std::array<float, (batch_vectors + 1) * wide::lanes>, 6> numbers;  ///< position, normal

    std::size_t vectors() const { return (rays + wide::lanes - 1) / wide::lanes; }
    HWY_INLINE wide::Vec3 position(std::size_t vector) const { return three(0, vector); }
    HWY_INLINE wide::Vec3 normal(std::size_t vector) const { return three(3, vector); }

private:
    HWY_INLINE wide::Vec3 three(std::size_t first, std::size_t vector) const {
        const std::size_t start = vector * wide::lanes;
        return {wide::load(&numbers[first][start]), wide::load(&numbers[first + 1][start]),
                wide::load(&numbers[first + 2][start])};
    }
};

/// The lights of a request, as the judges and the tiles take them.
struct AskedLights {
    std::vector<LightRecord> records;
    float reach_m = 1.0f;  ///< how far directional lights are put away
};

namespace detail {

HWY_INLINE wide::Vec3 load_three(const std::vector<float> (&axes)[3], std::size_t start) {
    return {wide::load(&axes[0][start]), wide::load(&axes[1][start]), wide::load(&axes[2][start])};
}

/// Packs the rays that face the light. asked[k]: which pixels of vector first + k ask, bit by lane.
HWY_INLINE void gather_asked(const PixelGroups& pixels, const LightRecord& light, float reach_m, std::size_t first,
                             std::size_t count, std::array<std::uint32_t, batch_vectors>& asked, RayBatch& batch) {
    batch.rays = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t start = (first + k) * wide::lanes;
        const wide::Vec3 position = load_three(pixels.position, start), normal = load_three(pixels.normal, start);
        const wide::Mask mask = wide::is_asked(normal, wide::to_light(light, position, reach_m));
        asked[k] = wide::bits_of(mask);
        const std::array<wide::Real, 6> numbers{position.x, position.y, position.z, normal.x, normal.y, normal.z};
        for (std::size_t n = 0; n < 6; ++n) wide::store_compressed(numbers[n], mask, &batch.numbers[n][batch.rays]);
        batch.rays += static_cast<std::size_t>(std::popcount(asked[k]));
    }
    if (batch.rays == 0) return;
    for (auto& numbers : batch.numbers) wide::store(wide::splat(numbers[batch.rays - 1]), &numbers[batch.rays]);
}

HWY_INLINE void add_ones(std::vector<int>& sums, std::size_t start, wide::Mask mask) {
    const wide::Int ones = wide::select(mask, wide::splat(1), wide::splat(0));
    wide::store(wide::Int{wide::hn::LoadU(wide::IntTag(), &sums[start])} + ones, &sums[start]);
}

inline void keep_verdicts(const PixelGroups& pixels, std::size_t start, std::uint32_t light, std::uint32_t blocked,
                          Verdicts& verdicts) {
    for (std::uint32_t bits = blocked; bits != 0; bits &= bits - 1) {
        const std::size_t pixel = pixels.pixel[start + static_cast<std::size_t>(std::countr_zero(bits))];
        verdicts.words[pixel * verdicts.words_per_pixel + light / 32u] |= 1u << (light % 32u);
    }
}

/// Adds the answers of one vector of pixels to their sums.
template <bool shade>
HWY_INLINE void add_answers(const AskedLights& lights, std::uint32_t light, std::size_t start, std::uint32_t asked_bits,
                            std::uint32_t blocked_bits, Tile& tile, Verdicts* verdicts) {
    const wide::Mask asked = wide::mask_of(asked_bits), blocked = wide::mask_of(blocked_bits);
    add_ones(tile.asked, start, asked);
    add_ones(tile.blocked, start, blocked);
    if constexpr (shade) {
        const LightRecord& record = lights.records[light];
        const wide::Vec3 to_light = wide::to_light(record, load_three(tile.pixels.position, start), lights.reach_m);
        const wide::Real unshadowed =
            wide::irradiance_per_intensity(record, load_three(tile.pixels.shading_normal, start), to_light);
        const wide::Real given = wide::select(asked && !blocked, unshadowed, wide::splat(0.0f));
        for (int channel = 0; channel < 3; ++channel) {
            float* sum = &tile.irradiance[channel][start];
            wide::store(wide::fused(given, wide::splat(record.intensity[channel]), wide::load(sum)), sum);
        }
        if (verdicts != nullptr) keep_verdicts(tile.pixels, start, light, blocked_bits, *verdicts);
    }
}

}  // namespace detail

/// Asks the lights first .. end - 1 for the tile's pixels. `judge(lights, light, batch, verdicts)` answers a
/// batch.
template <bool shade, class Judge>
void ask_tile(const AskedLights& lights, std::uint32_t first_light, std::uint32_t end_light, const Judge& judge,
              Tile& tile, Verdicts* verdicts, const Progress* progress) {
    const std::size_t vectors = tile.pixels.pixel.size() / wide::lanes;
    RayBatch batch;
    PackedVerdicts packed{};
    std::array<std::uint32_t, batch_vectors> asked;
    for (std::uint32_t light = first_light; light < end_light; ++light) {
        if (progress != nullptr) progress->check();
        for (std::size_t first = 0; first < vectors; first += batch_vectors) {
            const std::size_t count = std::min(batch_vectors, vectors - first);
            detail::gather_asked(tile.pixels, lights.records[light], lights.reach_m, first, count, asked, batch);
            if (batch.rays == 0) continue;
            judge(lights, light, batch, packed);
            std::size_t ray = 0;
            for (std::size_t k = 0; k < count; ++k) {
                if (asked[k] == 0) continue;
                // The next rays' answers, spread back to the lanes that asked.
                const std::size_t word = ray / wide::lanes;
                const std::uint64_t two = packed[word] | static_cast<std::uint64_t>(packed[word + 1]) << wide::lanes;
                const std::uint32_t blocked =
                    deposit_bits(static_cast<std::uint32_t>(two >> (ray % wide::lanes)), asked[k]);
                ray += static_cast<std::size_t>(std::popcount(asked[k]));
                detail::add_answers<shade>(lights, light, (first + k) * wide::lanes, asked[k], blocked, tile, verdicts);
            }
        }
    }
}

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The picture tile by tile, all lights for each: for judges that answer any light at any time.
template <class Judge>
RenderResult render_tiles(const RenderRequest& request, float reach_m, const Judge& judge, Progress& progress) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const AskedLights lights{light_records(request.lights), reach_m};
    RenderResult result = blank_result(request);
    const std::vector<PixelRect> rects = tile_rects(request);
    const std::vector<RefinementPass> passes = refinement_passes(static_cast<bool>(request.on_region));
    progress.begin("asking shadow rays", static_cast<std::int64_t>(rects.size() * passes.size()));
    const auto start = Clock::now();
    std::mutex region_mutex;
    for (const RefinementPass& pass : passes) {
        parallel_for(static_cast<std::int64_t>(rects.size()), request.threads, [&](std::int64_t index) {
            const PixelRect rect = rects[static_cast<std::size_t>(index)];
            Tile tile = make_tile(surfaces, rect, pass, true);
            ask_tile<true>(lights, 0, static_cast<std::uint32_t>(lights.records.size()), judge, tile,
                           request.keep_verdicts ? &result.verdicts : nullptr, &progress);
            {
                const std::lock_guard lock(region_mutex);
                resolve(tile, 1.0f, surfaces, result);
                if (request.on_region) {
                    fill_blocks(result, surfaces, rect, pass.stride);
                    request.on_region(result, rect);
                }
            }
            progress.advance();
        });
    }
    count_rays(result);
    result.seconds = seconds_since(start);
    return result;
}

/// Only asks and counts; no shading.
template <class Judge>
QueryCount count_tiles(const RenderRequest& request, float reach_m, const Judge& judge) {
    const AskedLights lights{light_records(request.lights), reach_m};
    const std::vector<PixelRect> rects = tile_rects(request);
    std::vector<TileCount> counts(rects.size());
    const auto start = Clock::now();
    parallel_for(static_cast<std::int64_t>(rects.size()), request.threads, [&](std::int64_t index) {
        const auto at = static_cast<std::size_t>(index);
        Tile tile = make_tile(*request.surfaces, rects[at], {1, 0}, false);
        ask_tile<false>(lights, 0, static_cast<std::uint32_t>(lights.records.size()), judge, tile, nullptr, nullptr);
        counts[at] = count_of(tile);
    });
    QueryCount total;
    for (const TileCount& count : counts) {
        total.rays += count.rays;
        total.blocked += count.blocked;
    }
    total.seconds = seconds_since(start);
    return total;
}

/// All tiles of a picture, for judges that must prepare each light before it is asked: a few lights are prepared, all
/// pixels ask them, then the next few. Whatever their number, each pixel adds its lights in the same order.
struct LightByLight {
    AskedLights lights;
    std::vector<Tile> tiles;

    LightByLight(const RenderRequest& request, float reach_m, bool shade)
        : lights{light_records(request.lights), reach_m} {
        const std::vector<PixelRect> rects = tile_rects(request);
        tiles.resize(rects.size());
        parallel_for(static_cast<std::int64_t>(rects.size()), request.threads, [&](std::int64_t index) {
            const auto at = static_cast<std::size_t>(index);
            tiles[at] = make_tile(*request.surfaces, rects[at], {1, 0}, shade);
        });
    }
};

/// `prepare(picture, first, end)` makes the lights first .. end - 1 ready for the judge. While the picture is watched,
/// the lights so far stand for all of them; it is shown each time that their number has doubled.
template <class Prepare, class Judge>
RenderResult render_lights(const RenderRequest& request, float reach_m, std::uint32_t lights_at_once,
                           const Prepare& prepare, const Judge& judge, Progress& progress) {
    RenderResult result = blank_result(request);
    const auto start = Clock::now();
    LightByLight picture(request, reach_m, true);
    const auto light_count = static_cast<std::uint32_t>(picture.lights.records.size());
    progress.begin("rendering shadow maps", light_count);
    std::mutex region_mutex;
    std::uint32_t show_at = 1;
    for (std::uint32_t first = 0; first < light_count; first += lights_at_once) {
        const std::uint32_t end = std::min(first + lights_at_once, light_count);
        prepare(picture, first, end);
        const bool last = end == light_count, shown = last || (request.on_region && end >= show_at);
        if (shown) show_at = 2 * end;
        parallel_for(static_cast<std::int64_t>(picture.tiles.size()), request.threads, [&](std::int64_t index) {
            Tile& tile = picture.tiles[static_cast<std::size_t>(index)];
            ask_tile<true>(picture.lights, first, end, judge, tile, request.keep_verdicts ? &result.verdicts : nullptr,
                           &progress);
            if (!shown) return;
            const std::lock_guard lock(region_mutex);
            const float share = static_cast<float>(end) / static_cast<float>(light_count);
            resolve(tile, share, *request.surfaces, result);
            if (request.on_region) request.on_region(result, tile.rect);
        });
        progress.advance(end - first);
    }
    count_rays(result);
    result.seconds = seconds_since(start);
    return result;
}

/// Only prepares, asks and counts; no shading.
template <class Prepare, class Judge>
QueryCount count_lights(const RenderRequest& request, float reach_m, std::uint32_t lights_at_once,
                        const Prepare& prepare, const Judge& judge) {
    const auto start = Clock::now();
    LightByLight picture(request, reach_m, false);
    const auto light_count = static_cast<std::uint32_t>(picture.lights.records.size());
    for (std::uint32_t first = 0; first < light_count; first += lights_at_once) {
        const std::uint32_t end = std::min(first + lights_at_once, light_count);
        prepare(picture, first, end);
        parallel_for(static_cast<std::int64_t>(picture.tiles.size()), request.threads, [&](std::int64_t index) {
            ask_tile<false>(picture.lights, first, end, judge, picture.tiles[static_cast<std::size_t>(index)], nullptr,
                            nullptr);
        });
    }
    QueryCount total;
    for (const Tile& tile : picture.tiles) {
        const TileCount count = count_of(tile);
        total.rays += count.rays;
        total.blocked += count.blocked;
    }
    total.seconds = seconds_since(start);
    return total;
}

}  // namespace sightlines::baselines
