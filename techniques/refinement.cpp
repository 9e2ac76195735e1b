#include "techniques/refinement.h"

#include <algorithm>
#include <numeric>

#include "techniques/base/huge_buffer.h"

namespace sightlines {

std::vector<RefinementPass> refinement_passes(bool watched) {
    if (!watched) return {{1, 0}};
    return {{4, 0}, {2, 4}, {1, 2}};
}

RenderResult blank_result(const RenderRequest& request) {
    RenderResult result;
    const ImageSize size = request.surfaces->size;
    result.radiance = ImageRgb(size);
    result.shadow = ImageScalar(size);
    result.rays_asked = Image<std::uint32_t>(size);
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel)
        result.radiance.pixels[pixel] = request.surfaces->emission[pixel];
    if (!request.keep_verdicts) return result;
    result.verdicts.words_per_pixel = static_cast<std::uint32_t>((request.lights.size() + 31) / 32);
    const std::size_t words = size.pixels() * result.verdicts.words_per_pixel;
    if (words * sizeof(std::uint32_t) > available_memory_bytes() / 2)
        throw InputError("size", "", "the answers of all rays would take " + std::to_string(words >> 18u) + " MiB",
                         "compare a smaller picture, or with fewer lights");
    result.verdicts.words.resize(words);
    return result;
}

void fill_blocks(RenderResult& result, const SurfaceBuffer& surfaces, PixelRect rect, int stride) {
    if (stride == 1) return;
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
        for (int x = rect.x; x < rect.x + rect.width; ++x) {
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(surfaces.size.width) +
                               static_cast<std::size_t>(x);
            if (surfaces.triangle[pixel] == no_triangle) continue;
            const int from_x = std::max(rect.x, x - x % stride), from_y = std::max(rect.y, y - y % stride);
            result.radiance.at(x, y) = result.radiance.at(from_x, from_y);
            result.shadow.at(x, y) = result.shadow.at(from_x, from_y);
            result.rays_asked.at(x, y) = result.rays_asked.at(from_x, from_y);
        }
    }
}

void count_rays(RenderResult& result) {
    result.rays = std::accumulate(result.rays_asked.pixels.begin(), result.rays_asked.pixels.end(), std::uint64_t{0});
}

}  // namespace sightlines
