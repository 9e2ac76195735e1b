#include "techniques/baselines/tiles.h"

#include <algorithm>

#include "techniques/base/error.h"
#include "techniques/base/parallel.h"

namespace sightlines::baselines {
namespace {

constexpr int tile_side = 64;
constexpr float inverse_pi = 0.318309886f;

}  // namespace

std::vector<PixelRect> tile_rects(const RenderRequest& request) {
    const ImageSize size = request.surfaces->size;
    std::vector<PixelRect> rects;
    for (int y = 0; y < size.height; y += tile_side)
        for (int x = 0; x < size.width; x += tile_side)
            rects.push_back({x, y, std::min(tile_side, size.width - x), std::min(tile_side, size.height - y)});
    if (request.reverse_tiles) std::ranges::reverse(rects);
    return rects;
}

Tile make_tile(const SurfaceBuffer& surfaces, PixelRect rect, RefinementPass pass, bool shade) {
    Tile tile;
    tile.rect = rect;
    tile.pixels = group_pixels(surfaces, rect, pass.stride, pass.skip_stride);
    const std::size_t pixels = tile.pixels.pixel.size();
    tile.asked.resize(pixels);
    tile.blocked.resize(pixels);
    if (shade)
        for (auto& channel : tile.irradiance) channel.resize(pixels);
    return tile;
}

void resolve(const Tile& tile, float lights_share, const SurfaceBuffer& surfaces, RenderResult& result) {
    const float scale = inverse_pi / lights_share;
    for (std::size_t k = 0; k < tile.pixels.pixel.size(); ++k) {
        const std::uint32_t pixel = tile.pixels.pixel[k];
        if (pixel == no_triangle) continue;
        const vec3 irradiance(tile.irradiance[0][k], tile.irradiance[1][k], tile.irradiance[2][k]);
        result.radiance.pixels[pixel] = surfaces.emission[pixel] + surfaces.albedo[pixel] * scale * irradiance;
        result.rays_asked.pixels[pixel] = static_cast<std::uint32_t>(tile.asked[k]);
        result.shadow.pixels[pixel] =
            tile.asked[k] == 0 ? 0.0f : static_cast<float>(tile.blocked[k]) / static_cast<float>(tile.asked[k]);
    }
}

TileCount count_of(const Tile& tile) {
    TileCount count;
    for (const int asked : tile.asked) count.rays += static_cast<std::uint64_t>(asked);
    for (const int blocked : tile.blocked) count.blocked += static_cast<std::uint64_t>(blocked);
    return count;
}

float reach_m(const Scene& scene) {
    const float diagonal = scene.bounds.diagonal();
    return diagonal > 0.0f ? diagonal : 1.0f;
}

std::string cpu_device(int threads, std::string_view how) {
    return "CPU, " + std::to_string(thread_count(threads)) + " threads, " + std::string(how);
}

void refuse_vulkan(Backend backend, std::string_view technique) {
    if (backend == Backend::cpu) return;
    throw InputError("technique " + std::string(technique), "", "runs on the CPU only", "give --backend cpu");
}

}  // namespace sightlines::baselines
