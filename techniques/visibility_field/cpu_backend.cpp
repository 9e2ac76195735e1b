// Algorithm 2 on the CPU. The samples of a pixel are made, looked up and sorted out by the wide kernels; those that are
// left are packed side by side, pixel after pixel, until there are enough for a batch, which Embree answers by packets
// of 16.
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <mutex>
#include <numbers>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/harmonic_light.h"
#include "shaders/visibility_field.h"
#include "techniques/base/parallel.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/ray_order.h"
#include "techniques/visibility_field/weighted_samples.h"

namespace sightlines::visibility_field {
namespace {

namespace wide = wide_kernel;
using wide::HarmonicMoments;
using wide::lanes;
using wide::Mask;
using wide::Real;
using wide::splat;
using wide::Vec3;

constexpr int tile_side = 32;             ///< pixels; one task
constexpr int block_side = 4;             ///< pixels of a tile are taken in blocks, so that packets hold neighbours
constexpr std::size_t batch_rays = 8192;  ///< packed before Embree is asked: they stay in the second-level cache

/// The rays of one pixel among the packed ones.
struct Run {
    std::uint32_t pixel = 0;
    std::size_t first = 0, count = 0;
    bool subtract = false;  ///< what is blocked is taken off `known`, else what is open is added to it
    PixelMoments known{};   ///< of the directions that need no ray
    std::uint32_t asked = 0, known_blocked = 0;  ///< samples above the surface; of these, blocked without a ray
};

/// Rays that wait for Embree.
struct PackedRays {
    std::vector<float> origin[3], direction[3];
    std::vector<std::uint32_t> blocked;
    std::vector<std::uint32_t> sample;  ///< the number of each ray's, where verdicts are kept
    std::vector<Run> runs;
    SortingRoom sorting;
    std::size_t count = 0;

    explicit PackedRays(int samples) {
        const std::size_t most = batch_rays + static_cast<std::size_t>(samples) + 4 * lanes;
        for (auto& axis : origin) axis.resize(most);
        for (auto& axis : direction) axis.resize(most);
        blocked.resize(most / 32 + 2);
        sample.resize(most);
    }
};

struct TileWork {
    const VisibilityField* field;
    const EmbreeScene* embree;
    const EnvironmentRequest& request;
    HarmonicLight light;
    EnvironmentResult& result;
    wide::Words masks() const { return {field->masks.data()}; }
};

/// What is known of a pixel before its samples.
struct Pixel {
    std::uint32_t index = 0;
    wide::HemisphereFrame frame;
    vec3 normal;              ///< geometric
    std::size_t first_group;  ///< of samples: the one that points to about the same side in all pixels
    bool has_cell = false;
    std::uint32_t label = 1;
    wide::CellMask visible, occluded;
};

Pixel make_pixel(const SurfaceBuffer& surfaces, const SamplePattern& pattern, int x, int y) {
    Pixel pixel;
    pixel.index = static_cast<std::uint32_t>(y * surfaces.size.width + x);
    const std::size_t tile = pattern.tile_place(x, y);
    pixel.frame = wide::frame_about(surfaces.shading_normal[pixel.index], pattern.turns[tile].x, pattern.turns[tile].y);
    pixel.normal = surfaces.normal[pixel.index];
    const std::size_t groups = pattern.x.size() / lanes;
    const auto turned = static_cast<std::size_t>(pattern.share[tile] * static_cast<float>(groups));
    pixel.first_group = turned == 0 ? 0 : groups - turned;
    return pixel;
}

/// Algorithm 2, lines 3 and 4; `room` holds the masks of a dense cell.
void find_masks(const TileWork& work, vec3 position, Pixel& pixel, std::vector<std::uint32_t>& room) {
    const FieldShape& shape = work.field->shape;
    const wide::FieldCell cell = wide::locate_cell(shape, {work.field->bricks.data()}, position, pixel.normal);
    wide::Words words = work.masks();
    std::uint32_t starts[2] = {};
    pixel.has_cell = cell.index != wide::no_cell;
    pixel.label = cell.label;
    if (work.request.dense != nullptr) {
        const DenseCell dense = dense_cell(*work.request.dense, {cell.x, cell.y, cell.z});
        pixel.has_cell = dense.occupied;
        pixel.label = dense.label;
        room = dense.visible;
        room.insert(room.end(), dense.occluded.begin(), dense.occluded.end());
        room.resize(room.size() + spare_words);
        words = {room.data()};
        starts[1] = static_cast<std::uint32_t>(shape.words_per_mask);
    } else if (pixel.has_cell) {
        const wide::Words numbers{work.field->mask_numbers.data()};
        for (std::uint32_t which = 0; which < 2; ++which)
            starts[which] = wide::mask_start(shape, numbers, cell.index, which);
    }
    if (!pixel.has_cell) return;
    if (work.request.culling == Culling::visible) pixel.label = 1;
    pixel.visible = wide::load_mask(words, starts[0], shape.words_per_mask);
    pixel.occluded = wide::load_mask(words, starts[1], shape.words_per_mask);
}

/// How a pixel's samples are sorted out: without masks, by one of them, or by both.
enum class Known { nothing, one_region, both_regions };

HWY_INLINE Vec3 sample_direction(const SamplePattern& pattern, const Pixel& pixel, std::size_t start) {
    return wide::direction_in(pixel.frame, wide::load(&pattern.x[start]), wide::load(&pattern.y[start]),
                              wide::load(&pattern.z[start]));
}

template <Known known>
HWY_INLINE wide::Decision decide(const FieldShape& shape, const Pixel& pixel, Vec3 direction, Mask above) {
    if constexpr (known == Known::nothing) return wide::decide_without_masks(above);
    const wide::Int texel = wide::texel_of(shape, direction);
    if constexpr (known == Known::one_region)
        return wide::decide_by_label(pixel.label, above,
                                     wide::is_set(pixel.label == 1 ? pixel.visible : pixel.occluded, texel));
    return wide::decide_by_both(above, wide::is_set(pixel.visible, texel), wide::is_set(pixel.occluded, texel));
}

HWY_INLINE void add(HarmonicMoments& moments, Vec3 direction, Mask mask) {
    wide::add_direction(moments, direction, wide::select(mask, splat(1.0f), splat(0.0f)));
}

HWY_INLINE PixelMoments summed(const HarmonicMoments& moments) {
    PixelMoments sums;
    for (std::size_t k = 0; k < sums.size(); ++k)
        sums[k] = wide::hn::GetLane(wide::hn::SumOfLanes(wide::RealTag(), moments.of[k].v));
    return sums;
}

HWY_INLINE Mask in_pattern(const SamplePattern& pattern, std::size_t start) {
    const auto left = static_cast<int>(static_cast<std::size_t>(pattern.samples) - start);
    return {wide::hn::FirstN(wide::RealTag(), static_cast<std::size_t>(std::max(0, left)))};
}

/// What the pixel's samples come to before any is traced.
struct Sorted {
    std::size_t rays = 0, below = 0, known_blocked = 0;
    PixelMoments known{};
};

/// Keeps the answers that need no ray, and which samples wait for one, of the vector of samples that starts at `start`.
void keep_verdicts(std::uint32_t* verdicts, std::size_t start, std::uint32_t blocked, std::uint32_t traced,
                   std::uint32_t* waiting) {
    verdicts[start / 32] |= blocked << (start % 32);
    for (; traced != 0; traced &= traced - 1)
        *waiting++ = static_cast<std::uint32_t>(start) + static_cast<std::uint32_t>(std::countr_zero(traced));
}

/// Makes the pixel's samples, packs the directions of those that must be traced from `to` on, and sums up those that
/// need no ray: added where open, or, where the occluded region is traced, all less those that are blocked.
template <Known known>
HWY_INLINE Sorted sort_samples(const FieldShape& shape, const EnvironmentRequest& request, const Pixel& pixel,
                               bool subtract, std::size_t to, PackedRays& packed, std::uint32_t* verdicts) {
    const SamplePattern& pattern = *request.pattern;
    const std::size_t size = pattern.x.size();
    const bool sum_all = subtract && request.unshadowed == Unshadowed::sampled;
    HarmonicMoments moments = wide::no_moments();
    Sorted sorted;
    std::size_t start = pixel.first_group * lanes;
    for (std::size_t done = 0; done < size; done += lanes, start = start + lanes == size ? 0 : start + lanes) {
        const Vec3 direction = sample_direction(pattern, pixel, start);
        const Mask inside = in_pattern(pattern, start);
        const Mask above = wide::leaves_surface(pixel.normal, direction) && inside;
        const wide::Decision decision = decide<known>(shape, pixel, direction, above);
        const std::uint32_t traced = wide::bits_of(decision.trace);
        const std::uint32_t below = wide::bits_of(inside && !above);
        if (verdicts != nullptr)
            keep_verdicts(verdicts, start, wide::bits_of(decision.blocked && above), traced,
                          &packed.sample[to + sorted.rays]);
        if (traced != 0) {
            wide::store_compressed(direction.x, decision.trace, &packed.direction[0][to + sorted.rays]);
            wide::store_compressed(direction.y, decision.trace, &packed.direction[1][to + sorted.rays]);
            wide::store_compressed(direction.z, decision.trace, &packed.direction[2][to + sorted.rays]);
            sorted.rays += static_cast<std::size_t>(std::popcount(traced));
        }
        sorted.below += static_cast<std::size_t>(std::popcount(below));
        if constexpr (known == Known::both_regions) {
            add(moments, direction, decision.open);
            sorted.known_blocked += static_cast<std::size_t>(std::popcount(wide::bits_of(decision.blocked && above)));
        }
        if (known == Known::one_region && subtract) {
            // With the samples' own mean: all but those below. With the analytic one: less those below.
            if (sum_all)
                add(moments, direction, above);
            else if (below != 0)
                wide::add_direction(moments, direction, wide::select(inside && !above, splat(-1.0f), splat(0.0f)));
        }
    }
    if (known == Known::both_regions || subtract) sorted.known = summed(moments);
    if (known == Known::one_region && pixel.label == 1)  // all that are not traced
        sorted.known_blocked = static_cast<std::size_t>(pattern.samples) - sorted.below - sorted.rays;
    return sorted;
}

Sorted sort_samples(const TileWork& work, const Pixel& pixel, bool subtract, std::size_t to, PackedRays& packed) {
    const EnvironmentRequest& request = work.request;
    Verdicts& kept = work.result.verdicts;
    std::uint32_t* const verdicts =
        kept.words.empty() ? nullptr : &kept.words[static_cast<std::size_t>(pixel.index) * kept.words_per_pixel];
    if (!pixel.has_cell) return sort_samples<Known::nothing>({}, request, pixel, false, to, packed, verdicts);
    const FieldShape shape = work.field->shape;
    if (request.culling == Culling::both)
        return sort_samples<Known::both_regions>(shape, request, pixel, false, to, packed, verdicts);
    return sort_samples<Known::one_region>(shape, request, pixel, subtract, to, packed, verdicts);
}

/// The polynomials of the run's rays: of the open ones, or of the blocked ones where they are subtracted, then
/// negative.
PixelMoments traced_moments(const PackedRays& packed, const Run& run, std::size_t& blocked_rays) {
    HarmonicMoments moments = wide::no_moments();
    for (std::size_t k = 0; k < run.count; k += lanes) {
        const std::size_t ray = run.first + k;
        const std::uint64_t two = packed.blocked[ray / 32] | std::uint64_t{packed.blocked[ray / 32 + 1]} << 32u;
        const auto left = static_cast<std::uint32_t>(std::min(lanes, run.count - k));
        const std::uint32_t used = (1u << left) - 1u;
        const std::uint32_t blocked = static_cast<std::uint32_t>(two >> (ray % 32)) & used;
        blocked_rays += static_cast<std::size_t>(std::popcount(blocked));
        const Vec3 direction{wide::load(&packed.direction[0][ray]), wide::load(&packed.direction[1][ray]),
                             wide::load(&packed.direction[2][ray])};
        const Mask counted = wide::mask_of(run.subtract ? blocked : blocked ^ used);
        wide::add_direction(moments, direction, wide::select(counted, splat(run.subtract ? -1.0f : 1.0f), splat(0.0f)));
    }
    return summed(moments);
}

/// Keeps the answers of the run's rays.
void keep_answers(const PackedRays& packed, const Run& run, Verdicts& verdicts) {
    std::uint32_t* const words = &verdicts.words[static_cast<std::size_t>(run.pixel) * verdicts.words_per_pixel];
    for (std::size_t ray = run.first; ray < run.first + run.count; ++ray) {
        const std::uint32_t blocked = packed.blocked[ray / 32] >> (ray % 32) & 1u;
        words[packed.sample[ray] / 32] |= blocked << (packed.sample[ray] % 32);
    }
}

/// Asks Embree for all packed rays and shades their pixels.
void answer(const TileWork& work, PackedRays& packed, SampleCounts& counts) {
    const PackedOpenRays rays{{packed.origin[0].data(), packed.origin[1].data(), packed.origin[2].data()},
                              {packed.direction[0].data(), packed.direction[1].data(), packed.direction[2].data()},
                              packed.count};
    if (work.request.order == RayOrder::direction)
        are_blocked_by_direction(*work.embree, rays.origin, rays.direction, rays.count, packed.sorting, packed.blocked);
    else
        are_blocked(*work.embree, rays, packed.blocked);
    const SurfaceBuffer& surfaces = *work.request.surfaces;
    for (const Run& run : packed.runs) {
        std::size_t blocked = 0;
        PixelMoments moments = traced_moments(packed, run, blocked);
        for (std::size_t k = 0; k < moments.size(); ++k) moments[k] += run.known[k];
        vec3 irradiance = irradiance_of(work.light, moments, work.request.pattern->samples);
        if (run.subtract && work.request.unshadowed == Unshadowed::analytic)
            irradiance += sightlines::irradiance(work.request.light, surfaces.shading_normal[run.pixel]);
        work.result.irradiance.pixels[run.pixel] = irradiance;
        work.result.radiance.pixels[run.pixel] = reflected_radiance(work.request, run.pixel, irradiance);
        work.result.rays_traced.pixels[run.pixel] = static_cast<std::uint32_t>(run.count);
        work.result.rays_asked.pixels[run.pixel] = run.asked;
        work.result.shadow.pixels[run.pixel] =
            static_cast<float>(run.known_blocked + blocked) / static_cast<float>(std::max(run.asked, 1u));
        if (!work.result.verdicts.words.empty()) keep_answers(packed, run, work.result.verdicts);
        counts.traced_blocked += blocked;
    }
    packed.runs.clear();
    packed.count = 0;
}

void set_origin(PackedRays& packed, std::size_t first, std::size_t count, vec3 origin) {
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < count; k += lanes)
            wide::store(splat(origin[axis]), &packed.origin[axis][first + k]);
}

/// Sorts the samples of the pixel (x, y); packs them and answers full batches unless only counting (without Embree).
void ask_pixel(const TileWork& work, int x, int y, PackedRays& packed, SampleCounts& counts,
               std::vector<std::uint32_t>& room) {
    const SurfaceBuffer& surfaces = *work.request.surfaces;
    Pixel pixel = make_pixel(surfaces, *work.request.pattern, x, y);
    if (surfaces.triangle[pixel.index] == no_triangle) return;
    const vec3 position = surfaces.position[pixel.index];
    if (work.field != nullptr) find_masks(work, position, pixel, room);
    const bool subtract = pixel.has_cell && pixel.label == 0 && work.request.culling == Culling::label;
    const Sorted sorted = sort_samples(work, pixel, subtract, packed.count, packed);
    counts.samples += static_cast<std::uint64_t>(work.request.pattern->samples);
    counts.below += sorted.below;
    counts.traced += sorted.rays;
    if (!pixel.has_cell) counts.outside += sorted.rays;
    if (work.embree == nullptr) return;
    set_origin(packed, packed.count, sorted.rays, lifted_off(*work.embree, position, pixel.normal));
    const auto asked =
        static_cast<std::uint32_t>(static_cast<std::size_t>(work.request.pattern->samples) - sorted.below);
    packed.runs.push_back({pixel.index, packed.count, sorted.rays, subtract, sorted.known, asked,
                           static_cast<std::uint32_t>(sorted.known_blocked)});
    packed.count += sorted.rays;
    if (packed.count >= batch_rays) answer(work, packed, counts);
}

SampleCounts ask_tile(const TileWork& work, int left, int top) {
    const ImageSize size = work.request.surfaces->size;
    PackedRays packed(work.request.pattern->samples);
    SampleCounts counts;
    std::vector<std::uint32_t> room;
    for (int block = 0; block < tile_side * tile_side; block += block_side * block_side) {
        const int blocks_across = tile_side / block_side, number = block / (block_side * block_side);
        const int block_left = left + number % blocks_across * block_side;
        const int block_top = top + number / blocks_across * block_side;
        for (int y = block_top; y < std::min(block_top + block_side, size.height); ++y)
            for (int x = block_left; x < std::min(block_left + block_side, size.width); ++x)
                ask_pixel(work, x, y, packed, counts, room);
    }
    if (work.embree != nullptr) answer(work, packed, counts);
    return counts;
}

/// All tiles of the picture; counts into `result`.
void ask_picture(const TileWork& work, Progress& progress) {
    const ImageSize size = work.request.surfaces->size;
    const int columns = (size.width + tile_side - 1) / tile_side, rows = (size.height + tile_side - 1) / tile_side;
    const std::int64_t tiles = static_cast<std::int64_t>(columns) * rows;
    const auto start = std::chrono::steady_clock::now();
    std::mutex sum_mutex;
    progress.begin("asking the environment", tiles);
    parallel_for(tiles, work.request.threads, [&](std::int64_t index) {
        const std::int64_t tile = work.request.reverse_tiles ? tiles - 1 - index : index;
        const SampleCounts counts =
            ask_tile(work, static_cast<int>(tile % columns) * tile_side, static_cast<int>(tile / columns) * tile_side);
        {
            const std::lock_guard lock(sum_mutex);
            add(work.result.counts, counts);
            if (work.request.on_region) {
                const int left = static_cast<int>(tile % columns) * tile_side;
                const int top = static_cast<int>(tile / columns) * tile_side;
                work.request.on_region(work.result, {left, top, std::min(tile_side, size.width - left),
                                                     std::min(tile_side, size.height - top)});
            }
        }
        progress.advance();
    });
    work.result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

EnvironmentResult render_environment(const VisibilityField* field, const EmbreeScene& embree,
                                     const EnvironmentRequest& request, Progress& progress) {
    if (is_weighted(request)) return render_weighted(field, embree, request, progress);
    EnvironmentResult result = blank_environment(request);
    ask_picture({field, &embree, request, harmonic_light(request.light), result}, progress);
    result.device =
        "CPU, " + std::to_string(thread_count(request.threads)) + " threads, " + std::to_string(lanes) + " wide";
    return result;
}

SampleCounts count_samples(const VisibilityField* field, const EnvironmentRequest& request, double& seconds) {
    EnvironmentResult result;
    Progress progress;
    ask_picture({field, nullptr, request, harmonic_light(request.light), result}, progress);
    seconds = result.seconds;
    return result.counts;
}

}  // namespace sightlines::visibility_field
