#include "techniques/visibility_field/irradiance_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

#include "techniques/base/parallel.h"

namespace sightlines::visibility_field {
namespace {

constexpr float least_cosine = 0.95f;        ///< between the normals of pixels that share light
constexpr float least_facets_cosine = 0.9f;  ///< between those of their triangles, which may round a ball coarsely
constexpr float largest_slope = 0.05f;       ///< of the way between them, against the plane that they share

enum class Known : std::uint8_t { nothing, interpolated, asked };

/// What the passes work on.
struct Cache {
    const EnvironmentRequest& request;
    float tolerance = 0.0f;
    float mean_unshadowed = 0.0f;
    SurfaceBuffer shown;  ///< only the pixels that a pass asks show a surface
    std::vector<Known> known;
    EnvironmentResult result;

    const SurfaceBuffer& surfaces() const { return *request.surfaces; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(surfaces().size.width) +
               static_cast<std::size_t>(x);
    }
    bool waits(std::size_t pixel) const {
        return known[pixel] == Known::nothing && surfaces().triangle[pixel] != no_triangle;
    }
};

/// Pixels left <= x < end_x, top <= y < end_y, between the asked columns left and right and rows top and bottom.
struct Block {
    int left = 0, top = 0, right = 0, bottom = 0, end_x = 0, end_y = 0;
};

using Corners = std::array<std::size_t, 4>;  ///< left top, right top, left bottom, right bottom

/// The blocks of a pass. The last ones end at the picture's last column and row.
struct Blocks {
    ImageSize size;
    int stride = 1;

    int across() const { return (size.width - 1) / stride + 1; }
    int down() const { return (size.height - 1) / stride + 1; }
    std::size_t count() const { return static_cast<std::size_t>(across()) * static_cast<std::size_t>(down()); }
    Block at(std::size_t number) const {
        const auto columns = static_cast<std::size_t>(across());
        const int left = static_cast<int>(number % columns) * stride, top = static_cast<int>(number / columns) * stride;
        return {left,
                top,
                std::min(left + stride, size.width - 1),
                std::min(top + stride, size.height - 1),
                std::min(left + stride, size.width),
                std::min(top + stride, size.height)};
    }
};

/// Calls work(number, block) for all blocks on all threads.
template <class Work>
void for_blocks(const Cache& cache, const Blocks& blocks, const Work& work) {
    const auto across = static_cast<std::size_t>(blocks.across());
    parallel_for(blocks.down(), cache.request.threads, [&](std::int64_t row) {
        const std::size_t first = static_cast<std::size_t>(row) * across;
        for (std::size_t number = first; number < first + across; ++number) work(number, blocks.at(number));
    });
}

Corners corners_of(const Cache& cache, const Block& block) {
    return {cache.index(block.left, block.top), cache.index(block.right, block.top),
            cache.index(block.left, block.bottom), cache.index(block.right, block.bottom)};
}

/// How much two pixels' light is alike by their surfaces alone, in [0, 1]. The way between points of a plane, and of a
/// ball, is at right angles to the sum of their normals. It is measured as the camera sees it: of two planes of which
/// one lies behind the other, points that are seen side by side may be far apart.
float likeness(const SurfaceBuffer& surfaces, std::size_t one, std::size_t other) {
    if (one == other) return 1.0f;
    if (surfaces.triangle[other] == no_triangle) return 0.0f;
    const float facets = glm::dot(surfaces.normal[one], surfaces.normal[other]);
    const float along = glm::dot(surfaces.shading_normal[one], surfaces.shading_normal[other]);
    if (along <= least_cosine || facets <= least_facets_cosine) return 0.0f;
    const vec3 way = surfaces.position[other] - surfaces.position[one];
    const vec3 normal = glm::normalize(surfaces.normal[one] + surfaces.normal[other]);
    const Camera& camera = surfaces.camera;
    const vec3 seen = camera.kind == CameraKind::perspective ? surfaces.position[one] : camera.target;
    const vec3 view = glm::normalize(seen - camera.position);
    const float across = glm::length(way - glm::dot(way, view) * view);
    const float slope = across > 0.0f ? std::fabs(glm::dot(way, normal)) / across : 0.0f;
    if (slope >= largest_slope) return 0.0f;
    const float turned = (1.0f - std::min(along, 1.0f)) / (1.0f - least_cosine), off = slope / largest_slope;
    return (1.0f - turned) * (1.0f - off * off);
}

/// Each corner's share by place alone.
std::array<float, 4> shares_at(const Block& block, int x, int y) {
    const float right = block.right > block.left
                            ? static_cast<float>(x - block.left) / static_cast<float>(block.right - block.left)
                            : 0.0f;
    const float bottom = block.bottom > block.top
                             ? static_cast<float>(y - block.top) / static_cast<float>(block.bottom - block.top)
                             : 0.0f;
    return {(1.0f - right) * (1.0f - bottom), right * (1.0f - bottom), (1.0f - right) * bottom, right * bottom};
}

/// Whether what is between the corners is next to them.
bool is_small(const Block& block) { return block.right - block.left <= 2 && block.bottom - block.top <= 2; }

/// The corners' weights for a pixel by place and surface, 0 for those that are not of its surface. False where too few
/// are: of a small block half by place and two at least, so that little is guessed past what was asked; else all.
bool find_weights(const Cache& cache, const Block& block, const Corners& corners, int x, int y,
                  std::array<float, 4>& weights) {
    const std::array<float, 4> shares = shares_at(block, x, y);
    float alike_share = 0.0f;
    int with_weight = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const float alike = likeness(cache.surfaces(), cache.index(x, y), corners[k]);
        if (alike <= 0.0f && !is_small(block)) return false;
        alike_share += alike > 0.0f ? shares[k] : 0.0f;
        weights[k] = shares[k] * alike;
        with_weight += weights[k] > 0.0f ? 1 : 0;
    }
    return alike_share == 1.0f || (alike_share >= 0.5f && with_weight > 1);
}

/// Whether all that is seen in a block is of one surface. Near anything else there may be a shadow that no corner has.
bool shows_one_surface(const Cache& cache, const Block& block) {
    const Corners corners = corners_of(cache, block);
    std::array<float, 4> weights;
    for (int y = block.top; y <= block.bottom; ++y)
        for (int x = block.left; x <= block.right; ++x)
            if (cache.surfaces().triangle[cache.index(x, y)] == no_triangle ||
                !find_weights(cache, block, corners, x, y, weights))
                return false;
    return true;
}

using Brightness = std::array<vec3, 4>;

/// Whether the light of the corners that have weight is alike.
bool share_light(const Cache& cache, const Brightness& brightness, const std::array<float, 4>& weights) {
    vec3 least(std::numeric_limits<float>::max()), most(0.0f);
    for (std::size_t k = 0; k < weights.size(); ++k) {
        if (weights[k] <= 0.0f) continue;
        least = glm::min(least, brightness[k]);
        most = glm::max(most, brightness[k]);
    }
    const vec3 difference = most - least;
    return std::max({difference.x, difference.y, difference.z}) < cache.tolerance;
}

template <class Visit>
void for_waiting(const Cache& cache, const Block& block, const Visit& visit) {
    for (int y = block.top; y < block.end_y; ++y)
        for (int x = block.left; x < block.end_x; ++x)
            if (cache.waits(cache.index(x, y)) && !visit(x, y)) return;
}

/// Whether light at the block's corners would be of use to one of its pixels.
bool is_useful(const Cache& cache, const Block& block) {
    bool useful = false;
    const Corners corners = corners_of(cache, block);
    if (!is_small(block)) {
        for_waiting(cache, block, [&](int, int) { return !(useful = true); });
        return useful && shows_one_surface(cache, block);
    }
    for_waiting(cache, block, [&](int x, int y) {
        std::array<float, 4> weights;
        useful = find_weights(cache, block, corners, x, y, weights);
        return !useful;
    });
    return useful;
}

/// Of each block of a pass. All of the first one's are, which has to have something to show; of the last one none.
std::vector<std::uint8_t> useful_blocks(const Cache& cache, const Blocks& blocks, bool first) {
    std::vector<std::uint8_t> useful(blocks.count(), first ? 1 : 0);
    if (first || blocks.stride == 1) return useful;
    for_blocks(cache, blocks,
               [&](std::size_t number, const Block& block) { useful[number] = is_useful(cache, block); });
    return useful;
}

/// In order: the corners of useful blocks; in the last pass all pixels that wait.
std::vector<std::size_t> pixels_to_ask(const Cache& cache, const Blocks& blocks,
                                       const std::vector<std::uint8_t>& useful) {
    std::vector<std::uint8_t> chosen(cache.known.size());
    for (std::size_t number = 0; number < useful.size(); ++number) {
        if (useful[number] == 0) continue;
        for (const std::size_t corner : corners_of(cache, blocks.at(number)))
            chosen[corner] = cache.known[corner] != Known::asked && cache.surfaces().triangle[corner] != no_triangle;
    }
    std::vector<std::size_t> pixels;
    for (std::size_t pixel = 0; pixel < chosen.size(); ++pixel)
        if (chosen[pixel] != 0 || (blocks.stride == 1 && cache.waits(pixel))) pixels.push_back(pixel);
    return pixels;
}

/// Has `make` ask these pixels, as if the picture showed nothing else, and takes them over.
void ask(Cache& cache, const Renderer& make, const std::vector<std::size_t>& pixels) {
    for (const std::size_t pixel : pixels) cache.shown.triangle[pixel] = cache.surfaces().triangle[pixel];
    EnvironmentRequest asked = cache.request;
    asked.surfaces = &cache.shown;
    asked.keep_verdicts = false;
    asked.on_region = {};
    const EnvironmentResult made = make(asked);
    EnvironmentResult& result = cache.result;
    for (const std::size_t pixel : pixels) {
        cache.shown.triangle[pixel] = no_triangle;
        cache.known[pixel] = Known::asked;
        result.irradiance.pixels[pixel] = made.irradiance.pixels[pixel];
        result.radiance.pixels[pixel] = made.radiance.pixels[pixel];
        result.rays_traced.pixels[pixel] = made.rays_traced.pixels[pixel];
        result.rays_asked.pixels[pixel] = made.rays_asked.pixels[pixel];
        result.shadow.pixels[pixel] = made.shadow.pixels[pixel];
    }
    add(result.counts, made.counts);
    add(result.second_rays, made.second_rays);
    add(result.area_rays, made.area_rays);
    result.device = made.device;
}

/// Gives a pixel the corners' mean by these weights.
void mix(Cache& cache, std::size_t pixel, const Corners& corners, const std::array<float, 4>& weights) {
    EnvironmentResult& result = cache.result;
    vec3 irradiance(0.0f);
    float shadow = 0.0f, asked = 0.0f, sum = 0.0f;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        irradiance += weights[k] * result.irradiance.pixels[corners[k]];
        shadow += weights[k] * result.shadow.pixels[corners[k]];
        asked += weights[k] * static_cast<float>(result.rays_asked.pixels[corners[k]]);
        sum += weights[k];
    }
    result.irradiance.pixels[pixel] = irradiance / sum;
    result.radiance.pixels[pixel] = reflected_radiance(cache.request, pixel, result.irradiance.pixels[pixel]);
    result.shadow.pixels[pixel] = std::min(shadow / sum, 1.0f);
    result.rays_asked.pixels[pixel] = static_cast<std::uint32_t>(std::lround(asked / sum));
}

/// Between the corners of a useful block, of which those that show surfaces were asked.
void interpolate(Cache& cache, const Block& block) {
    if (!is_small(block) && !shows_one_surface(cache, block)) return;
    const Corners corners = corners_of(cache, block);
    Brightness brightness;
    for (std::size_t k = 0; k < corners.size(); ++k)
        brightness[k] = brightness_of(cache.result.irradiance.pixels[corners[k]], cache.mean_unshadowed);
    for_waiting(cache, block, [&](int x, int y) {
        std::array<float, 4> weights;
        if (!find_weights(cache, block, corners, x, y, weights) || !share_light(cache, brightness, weights))
            return true;
        mix(cache, cache.index(x, y), corners, weights);
        cache.known[cache.index(x, y)] = Known::interpolated;
        return true;
    });
}

/// For who watches: what waits gets the light of the asked corner that is next to it, if there is one.
void fill_in(Cache& cache, const Block& block) {
    const Corners corners = corners_of(cache, block);
    for_waiting(cache, block, [&](int x, int y) {
        std::array<float, 4> weights{}, shares = shares_at(block, x, y);
        for (std::size_t k = 0; k < shares.size(); ++k)
            if (cache.known[corners[k]] != Known::asked) shares[k] = -1.0f;
        const auto nearest = std::ranges::max_element(shares);
        if (*nearest < 0.0f) return true;
        weights[static_cast<std::size_t>(nearest - shares.begin())] = 1.0f;
        mix(cache, cache.index(x, y), corners, weights);
        return true;
    });
}

Cache make_cache(const EnvironmentRequest& request, float tolerance) {
    EnvironmentRequest without_verdicts = request;
    without_verdicts.keep_verdicts = false;
    Cache cache{request, tolerance, 0.0f, *request.surfaces, {}, blank_environment(without_verdicts)};
    std::ranges::fill(cache.shown.triangle, no_triangle);
    cache.known.resize(cache.shown.triangle.size());
    for (int axis = 0; axis < 3; ++axis) {
        vec3 way(0.0f);
        way[axis] = 1.0f;
        const vec3 both = irradiance(request.light, way) + irradiance(request.light, -way);
        cache.mean_unshadowed += glm::dot(both, vec3(0.2126f, 0.7152f, 0.0722f)) / 6.0f;
    }
    return cache;
}

}  // namespace

vec3 brightness_of(vec3 irradiance, float mean_unshadowed) {
    return glm::sqrt(glm::max(irradiance, vec3(0.0f)) / std::max(mean_unshadowed, std::numeric_limits<float>::min()));
}

EnvironmentResult render_cached(const CacheOptions& options, const EnvironmentRequest& request, const Renderer& make) {
    const int spacing = static_cast<int>(std::bit_floor(static_cast<unsigned>(std::max(options.spacing, 0))));
    if (spacing < 2 || request.glossy) return make(request);
    const auto start = std::chrono::steady_clock::now();
    Cache cache = make_cache(request, options.tolerance);
    const ImageSize size = request.surfaces->size;
    for (int stride = spacing; stride >= 1; stride /= 2) {
        const Blocks blocks{size, stride};
        const std::vector<std::uint8_t> useful = useful_blocks(cache, blocks, stride == spacing);
        const std::vector<std::size_t> pixels = pixels_to_ask(cache, blocks, useful);
        if (!pixels.empty() || stride == spacing) ask(cache, make, pixels);
        for_blocks(cache, blocks, [&](std::size_t number, const Block& block) {
            if (useful[number] != 0) interpolate(cache, block);
        });
        if (!request.on_region) continue;
        for_blocks(cache, blocks, [&](std::size_t, const Block& block) { fill_in(cache, block); });
        request.on_region(cache.result, {0, 0, size.width, size.height});
    }
    EnvironmentResult& result = cache.result;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!request.keep_verdicts) return std::move(result);
    EnvironmentRequest all = request;
    all.on_region = {};
    EnvironmentResult made = make(all);
    result.verdicts = std::move(made.verdicts);
    result.rays_asked = std::move(made.rays_asked);
    return std::move(result);
}

}  // namespace sightlines::visibility_field
