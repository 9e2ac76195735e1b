// The way through a picture, tile by tile on all threads. Internal to this folder.
#pragma once

#include <algorithm>
#include <chrono>
#include <mutex>

#include "techniques/base/parallel.h"
#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

constexpr int tile_side = 32;  ///< pixels; one task
constexpr int block_side = 4;  ///< pixels of a tile are taken in blocks, so that packets hold neighbours

/// Calls `ask(x, y)` for the pixels of the tile that starts at (left, top), block by block.
template <class Ask>
void for_pixels_of_tile(ImageSize size, int left, int top, const Ask& ask) {
    for (int block = 0; block < tile_side * tile_side; block += block_side * block_side) {
        const int blocks_across = tile_side / block_side, number = block / (block_side * block_side);
        const int block_left = left + number % blocks_across * block_side;
        const int block_top = top + number / blocks_across * block_side;
        for (int y = block_top; y < std::min(block_top + block_side, size.height); ++y)
            for (int x = block_left; x < std::min(block_left + block_side, size.width); ++x) ask(x, y);
    }
}

/// Calls `ask_tile(left, top)`, which returns SampleCounts, for all tiles of the picture on all threads; adds the
/// counts and the time up in `result`, and tells who watches.
template <class AskTile>
void ask_tiles(const EnvironmentRequest& request, EnvironmentResult& result, Progress& progress,
               const AskTile& ask_tile) {
    const ImageSize size = request.surfaces->size;
    const int columns = (size.width + tile_side - 1) / tile_side, rows = (size.height + tile_side - 1) / tile_side;
    const std::int64_t tiles = static_cast<std::int64_t>(columns) * rows;
    const auto start = std::chrono::steady_clock::now();
    std::mutex sum_mutex;
    progress.begin("asking the environment", tiles);
    parallel_for(tiles, request.threads, [&](std::int64_t index) {
        const std::int64_t tile = request.reverse_tiles ? tiles - 1 - index : index;
        const int left = static_cast<int>(tile % columns) * tile_side;
        const int top = static_cast<int>(tile / columns) * tile_side;
        const SampleCounts counts = ask_tile(left, top);
        {
            const std::lock_guard lock(sum_mutex);
            add(result.counts, counts);
            if (request.on_region)
                request.on_region(result, {left, top, std::min(tile_side, size.width - left),
                                           std::min(tile_side, size.height - top)});
        }
        progress.advance();
    });
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Goes over a picture that is there already: as ask_tiles, but adds only its time to `result`, which who watches sees,
/// and returns the counts.
template <class AskTile>
SampleCounts go_over_tiles(const EnvironmentRequest& request, EnvironmentResult& result, Progress& progress,
                           const AskTile& ask_tile) {
    EnvironmentRequest watched = request;
    if (request.on_region)
        watched.on_region = [&](const EnvironmentResult&, PixelRect changed) { request.on_region(result, changed); };
    EnvironmentResult more;
    ask_tiles(watched, more, progress, ask_tile);
    result.seconds += more.seconds;
    return more.counts;
}

/// Adds what the pixels of a tile gained to their irradiance, and shades them anew.
inline void add_gained(const EnvironmentRequest& request, const ImageRgb& gained, int left, int top,
                       EnvironmentResult& result) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    for_pixels_of_tile(surfaces.size, left, top, [&](int x, int y) {
        const auto pixel = static_cast<std::size_t>(y * surfaces.size.width + x);
        if (surfaces.triangle[pixel] == no_triangle) return;
        result.irradiance.pixels[pixel] += gained.pixels[pixel];
        result.radiance.pixels[pixel] = reflected_radiance(request, pixel, result.irradiance.pixels[pixel]);
    });
}

}  // namespace sightlines::visibility_field
