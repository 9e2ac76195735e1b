// Algorithm 2 on the CPU. The samples of a pixel are made, looked up and sorted out by the wide kernels; those that are
// left are packed side by side, pixel after pixel, until there are enough for a batch, which Embree answers by packets
// of 16.
#include <algorithm>
#include <array>
#include <bit>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/harmonic_light.h"
#include "techniques/visibility_field/weighted_samples.h"
#include "techniques/visibility_field/wide_asking.h"

namespace sightlines::visibility_field {
namespace {

using wide::HarmonicMoments;
using wide::lanes;
using wide::Mask;
using wide::Real;
using wide::splat;
using wide::Vec3;

/// The rays of one pixel among the packed ones.
struct Run {
    std::uint32_t pixel = 0;
    std::size_t first = 0, count = 0;
    bool subtract = false;  ///< what is blocked is taken off `known`, else what is open is added to it
    PixelMoments known{};   ///< of the directions that need no ray
    std::uint32_t asked = 0, known_blocked = 0;  ///< samples above the surface; of these, blocked without a ray
};

/// Rays that wait for Embree, and whose they are.
struct PackedRays {
    WaitingRays rays;
    std::vector<Run> runs;
};

struct TileWork {
    const VisibilityField* field;
    const EmbreeScene* embree;
    const EnvironmentRequest& request;
    HarmonicLight light;
    EnvironmentResult& result;
};

/// What is known of a pixel before its samples.
struct Pixel {
    std::uint32_t index = 0;
    wide::HemisphereFrame frame;
    vec3 normal;              ///< geometric
    std::size_t first_group;  ///< of samples: the one that points to about the same side in all pixels
    CellMasks cell;
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

HWY_INLINE Vec3 sample_direction(const SamplePattern& pattern, const Pixel& pixel, std::size_t start) {
    return wide::direction_in(pixel.frame, wide::load(&pattern.x[start]), wide::load(&pattern.y[start]),
                              wide::load(&pattern.z[start]));
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
                               bool subtract, WaitingRays& rays, std::uint32_t* verdicts) {
    const std::size_t to = rays.count;
    const SamplePattern& pattern = *request.pattern;
    const std::size_t size = pattern.x.size();
    const bool sum_all = subtract && request.unshadowed == Unshadowed::sampled;
    HarmonicMoments moments = wide::no_moments();
    Sorted sorted;
    std::size_t known_open = 0;
    std::size_t start = pixel.first_group * lanes;
    for (std::size_t done = 0; done < size; done += lanes, start = start + lanes == size ? 0 : start + lanes) {
        const Vec3 direction = sample_direction(pattern, pixel, start);
        const Mask inside = in_pattern(pattern, start);
        const Mask above = wide::leaves_surface(pixel.normal, direction) && inside;
        const wide::Decision decision = decide<known>(shape, pixel.cell, direction, above);
        const std::uint32_t traced = wide::bits_of(decision.trace);
        const std::uint32_t below = wide::bits_of(inside && !above);
        if (verdicts != nullptr)
            keep_verdicts(verdicts, start, wide::bits_of(decision.blocked && above), traced,
                          &rays.sample[to + sorted.rays]);
        if (traced != 0) {
            rays.place(direction, decision.trace, to + sorted.rays);
            sorted.rays += static_cast<std::size_t>(std::popcount(traced));
        }
        sorted.below += static_cast<std::size_t>(std::popcount(below));
        if constexpr (known == Known::both_regions) {
            const std::uint32_t open = wide::bits_of(decision.open);
            if (open != 0) add(moments, direction, decision.open);
            known_open += static_cast<std::size_t>(std::popcount(open));
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
    if (known == Known::both_regions || (known == Known::one_region && pixel.cell.label == 1))  // all others
        sorted.known_blocked = static_cast<std::size_t>(pattern.samples) - sorted.below - sorted.rays - known_open;
    return sorted;
}

Sorted sort_samples(const TileWork& work, const Pixel& pixel, bool subtract, WaitingRays& rays) {
    const EnvironmentRequest& request = work.request;
    Verdicts& kept = work.result.verdicts;
    std::uint32_t* const verdicts =
        kept.words.empty() ? nullptr : &kept.words[static_cast<std::size_t>(pixel.index) * kept.words_per_pixel];
    if (!pixel.cell.has_cell) return sort_samples<Known::nothing>({}, request, pixel, false, rays, verdicts);
    const FieldShape shape = work.field->shape;
    if (request.culling == Culling::both)
        return sort_samples<Known::both_regions>(shape, request, pixel, false, rays, verdicts);
    return sort_samples<Known::one_region>(shape, request, pixel, subtract, rays, verdicts);
}

/// The polynomials of the run's rays: of the open ones, or of the blocked ones where they are subtracted, then
/// negative.
PixelMoments traced_moments(const WaitingRays& rays, const Run& run, std::size_t& blocked_rays) {
    HarmonicMoments moments = wide::no_moments();
    for (std::size_t k = 0; k < run.count; k += lanes) {
        const std::size_t ray = run.first + k;
        const auto left = static_cast<std::uint32_t>(std::min(lanes, run.count - k));
        const std::uint32_t used = (1u << left) - 1u;
        const std::uint32_t blocked = rays.blocked_from(ray) & used;
        blocked_rays += static_cast<std::size_t>(std::popcount(blocked));
        const Vec3 direction{wide::load(&rays.direction[0][ray]), wide::load(&rays.direction[1][ray]),
                             wide::load(&rays.direction[2][ray])};
        const Mask counted = wide::mask_of(run.subtract ? blocked : blocked ^ used);
        wide::add_direction(moments, direction, wide::select(counted, splat(run.subtract ? -1.0f : 1.0f), splat(0.0f)));
    }
    return summed(moments);
}

/// Keeps the answers of the run's rays.
void keep_answers(const WaitingRays& rays, const Run& run, Verdicts& verdicts) {
    std::uint32_t* const words = &verdicts.words[static_cast<std::size_t>(run.pixel) * verdicts.words_per_pixel];
    for (std::size_t ray = run.first; ray < run.first + run.count; ++ray) {
        const std::uint32_t blocked = rays.blocked[ray / 32] >> (ray % 32) & 1u;
        words[rays.sample[ray] / 32] |= blocked << (rays.sample[ray] % 32);
    }
}

/// Asks Embree for all packed rays and shades their pixels.
void answer(const TileWork& work, PackedRays& packed, SampleCounts& counts) {
    packed.rays.ask(*work.embree, work.request.order);
    const SurfaceBuffer& surfaces = *work.request.surfaces;
    for (const Run& run : packed.runs) {
        std::size_t blocked = 0;
        PixelMoments moments = traced_moments(packed.rays, run, blocked);
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
        if (!work.result.verdicts.words.empty()) keep_answers(packed.rays, run, work.result.verdicts);
        counts.traced_blocked += blocked;
    }
    packed.runs.clear();
    packed.rays.count = 0;
}

/// Sorts the samples of the pixel (x, y); packs them and answers full batches unless only counting (without Embree).
void ask_pixel(const TileWork& work, int x, int y, PackedRays& packed, SampleCounts& counts,
               std::vector<std::uint32_t>& room) {
    const SurfaceBuffer& surfaces = *work.request.surfaces;
    Pixel pixel = make_pixel(surfaces, *work.request.pattern, x, y);
    if (surfaces.triangle[pixel.index] == no_triangle) return;
    const vec3 position = surfaces.position[pixel.index];
    pixel.cell = find_masks(work.field, work.request, position, pixel.normal, room);
    const bool subtract = pixel.cell.has_cell && pixel.cell.label == 0 && work.request.culling == Culling::label;
    const Sorted sorted = sort_samples(work, pixel, subtract, packed.rays);
    counts.samples += static_cast<std::uint64_t>(work.request.pattern->samples);
    counts.below += sorted.below;
    counts.traced += sorted.rays;
    if (!pixel.cell.has_cell) counts.outside += sorted.rays;
    if (work.embree == nullptr) return;
    const auto asked =
        static_cast<std::uint32_t>(static_cast<std::size_t>(work.request.pattern->samples) - sorted.below);
    packed.runs.push_back({pixel.index, packed.rays.count, sorted.rays, subtract, sorted.known, asked,
                           static_cast<std::uint32_t>(sorted.known_blocked)});
    packed.rays.add(sorted.rays, lifted_off(*work.embree, position, pixel.normal));
    if (packed.rays.count >= batch_rays) answer(work, packed, counts);
}

SampleCounts ask_tile(const TileWork& work, int left, int top) {
    PackedRays packed{WaitingRays(work.request.pattern->samples), {}};
    SampleCounts counts;
    std::vector<std::uint32_t> room;
    for_pixels_of_tile(work.request.surfaces->size, left, top,
                       [&](int x, int y) { ask_pixel(work, x, y, packed, counts, room); });
    if (work.embree != nullptr) answer(work, packed, counts);
    return counts;
}

void ask_picture(const TileWork& work, Progress& progress) {
    ask_tiles(work.request, work.result, progress, [&](int left, int top) { return ask_tile(work, left, top); });
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
