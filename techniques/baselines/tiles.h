// The picture in tiles, and what each of its pixels gathers from the lights. What all baselines share apart from the
// vectors (lighting.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "shaders/lighting_data.h"
#include "techniques/pixel_groups.h"
#include "techniques/refinement.h"
#include "techniques/technique.h"

namespace sightlines::baselines {

/// A tile's pixels and their sums so far, [G * 16] each.
struct Tile {
    PixelRect rect;
    PixelGroups pixels;
    std::vector<int> asked, blocked;
    std::vector<float> irradiance[3];  ///< W/m^2; empty when only counting
};

/// Tiles of 64 x 64 pixels: a tile's sums and surfaces stay in the second-level cache. In the request's order.
std::vector<PixelRect> tile_rects(const RenderRequest& request);

/// The pixels of one pass over the tile, with nothing gathered yet. `shade`: light is summed, not only counted.
Tile make_tile(const SurfaceBuffer& surfaces, PixelRect rect, RefinementPass pass, bool shade);

/// Puts the tile's sums into the picture. `lights_share`: the share of all lights that have been asked so far; those
/// stand for all.
void resolve(const Tile& tile, float lights_share, const SurfaceBuffer& surfaces, RenderResult& result);

/// Adds a tile's sums to a count.
struct TileCount {
    std::uint64_t rays = 0, blocked = 0;
};
TileCount count_of(const Tile& tile);

/// How far directional lights are put away: the diagonal of the bounds, as the reference does.
float reach_m(const Scene& scene);

/// "CPU, 2 threads, 16 wide"
std::string cpu_device(int threads, std::string_view how);

/// InputError where the request wants Vulkan: the baselines run on the CPU only.
void refuse_vulkan(Backend backend, std::string_view technique);

}  // namespace sightlines::baselines
