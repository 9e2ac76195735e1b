// Pictures of samples whose weights differ, by Embree. The samples of a pixel are drawn, looked up and sorted out by
// the wide kernels, as the paper's in cpu_backend.cpp; only those that turn out to be open are weighed.
#include <algorithm>
#include <bit>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "techniques/visibility_field/weighted_samples.h"
#include "techniques/visibility_field/wide_asking.h"
#include "techniques/visibility_field/wide_weighted.h"

namespace sightlines::visibility_field {
namespace {

/// The rays of one pixel among those that wait.
struct Run {
    std::uint32_t pixel = 0;
    std::size_t first = 0, count = 0;
    SampledSurface surface;
    vec3 known{0.0f};                            ///< what samples bring that are open without a ray
    std::uint32_t asked = 0, known_blocked = 0;  ///< samples above the surface; of these, blocked without a ray
};

struct Picture {
    const VisibilityField* field;
    const EmbreeScene& embree;
    const EnvironmentRequest& request;
    WeightedTables tables;
    WideTables wide_tables;
    EnvironmentResult& result;
};

/// What one thread needs for a tile.
struct TileRoom {
    WaitingRays rays;
    Directions open;
    std::vector<Run> runs{};
    std::vector<std::uint32_t> dense{};
    SampleCounts counts{};
};

/// Sets those bits of a pixel's verdicts that belong to the vector of samples from `first` on.
void keep_verdicts(std::uint32_t* verdicts, std::uint32_t first, std::uint32_t blocked) {
    const std::uint64_t two = std::uint64_t{blocked} << (first % 32);
    verdicts[first / 32] |= static_cast<std::uint32_t>(two);
    if (two >> 32u != 0) verdicts[first / 32 + 1] |= static_cast<std::uint32_t>(two >> 32u);
}

std::uint32_t* verdicts_of(const Picture& picture, std::size_t pixel) {
    Verdicts& kept = picture.result.verdicts;
    return kept.words.empty() ? nullptr : &kept.words[pixel * kept.words_per_pixel];
}

/// Draws the pixel's samples and packs those that need a ray; notes what the masks know of the rest.
template <Known known>
HWY_INLINE void sort_samples(const Picture& picture, const WeightedPixel& pixel, const CellMasks& cell, TileRoom& room,
                             Run& run) {
    const FieldShape shape = known == Known::nothing ? FieldShape{} : picture.field->shape;
    std::uint32_t* const verdicts = verdicts_of(picture, run.pixel);
    WaitingRays& rays = room.rays;
    room.open.count = 0;
    draw_by_vectors(picture.tables, picture.wide_tables, pixel,
                    [&](std::uint32_t first, const wide::DrawnSample& drawn, wide::Mask inside) HWY_ATTR {
                        const wide::Mask above = drawn.above && inside;
                        const wide::Decision decision = decide<known>(shape, cell, drawn.direction, above);
                        std::uint32_t traced = wide::bits_of(decision.trace);
                        const std::uint32_t blocked = wide::bits_of(decision.blocked && above);
                        run.asked += static_cast<std::uint32_t>(std::popcount(wide::bits_of(above)));
                        run.known_blocked += static_cast<std::uint32_t>(std::popcount(blocked));
                        if (known != Known::nothing && wide::any_lane(decision.open))
                            room.open.add(drawn.direction, decision.open);
                        if (traced != 0) rays.place(drawn.direction, decision.trace, rays.count + run.count);
                        const std::size_t to = rays.count + run.count;
                        run.count += static_cast<std::size_t>(std::popcount(traced));
                        if (verdicts == nullptr) return;
                        keep_verdicts(verdicts, first, blocked);
                        for (std::size_t k = to; traced != 0; traced &= traced - 1)
                            rays.sample[k++] = first + static_cast<std::uint32_t>(std::countr_zero(traced));
                    });
    run.known = sum_of_weighed(picture.wide_tables, pixel.surface, room.open);
}

/// Weighs the run's rays that turned out to be open, and shades the pixel.
void resolve(const Picture& picture, TileRoom& room, const Run& run) {
    room.open.count = 0;
    std::uint32_t in_the_way = run.known_blocked;
    std::uint32_t* const verdicts = verdicts_of(picture, run.pixel);
    for (std::size_t k = 0; k < run.count; k += wide::lanes) {
        const std::size_t ray = run.first + k;
        const auto left = static_cast<std::uint32_t>(std::min(wide::lanes, run.count - k));
        const std::uint32_t used = (1u << left) - 1u, blocked = room.rays.blocked_from(ray) & used;
        in_the_way += static_cast<std::uint32_t>(std::popcount(blocked));
        const wide::Vec3 direction{wide::load(&room.rays.direction[0][ray]), wide::load(&room.rays.direction[1][ray]),
                                   wide::load(&room.rays.direction[2][ray])};
        if (blocked != used) room.open.add(direction, wide::mask_of(blocked ^ used));
        for (std::uint32_t bits = verdicts != nullptr ? blocked : 0; bits != 0; bits &= bits - 1) {
            const std::uint32_t sample = room.rays.sample[ray + static_cast<std::size_t>(std::countr_zero(bits))];
            verdicts[sample / 32] |= 1u << (sample % 32);
        }
    }
    const vec3 irradiance = run.known + sum_of_weighed(picture.wide_tables, run.surface, room.open);
    EnvironmentResult& result = picture.result;
    result.irradiance.pixels[run.pixel] = irradiance;
    result.radiance.pixels[run.pixel] = reflected_radiance(picture.request, run.pixel, irradiance);
    result.rays_traced.pixels[run.pixel] = static_cast<std::uint32_t>(run.count);
    result.rays_asked.pixels[run.pixel] = run.asked;
    result.shadow.pixels[run.pixel] = static_cast<float>(in_the_way) / static_cast<float>(std::max(run.asked, 1u));
    room.counts.traced_blocked += in_the_way - run.known_blocked;
}

void answer(const Picture& picture, TileRoom& room) {
    room.rays.ask(picture.embree, picture.request.order);
    for (const Run& run : room.runs) resolve(picture, room, run);
    room.runs.clear();
    room.rays.count = 0;
}

void ask_pixel(const Picture& picture, std::size_t index, TileRoom& room) {
    const SurfaceBuffer& surfaces = *picture.request.surfaces;
    if (surfaces.triangle[index] == no_triangle) return;
    const vec3 position = surfaces.position[index], normal = surfaces.normal[index];
    const WeightedPixel pixel = weighted_pixel(picture.request, index);
    const CellMasks cell = find_masks(picture.field, picture.request, position, normal, room.dense);
    Run run{static_cast<std::uint32_t>(index), room.rays.count, 0, pixel.surface};
    if (!cell.has_cell)
        sort_samples<Known::nothing>(picture, pixel, cell, room, run);
    else if (picture.request.culling == Culling::both)
        sort_samples<Known::both_regions>(picture, pixel, cell, room, run);
    else
        sort_samples<Known::one_region>(picture, pixel, cell, room, run);
    const auto samples = static_cast<std::uint64_t>(picture.request.pattern->samples);
    room.counts.samples += samples;
    room.counts.below += samples - run.asked;
    room.counts.traced += run.count;
    if (!cell.has_cell) room.counts.outside += run.count;
    room.rays.add(run.count, lifted_off(picture.embree, position, normal));
    room.runs.push_back(run);
    if (room.rays.count >= batch_rays) answer(picture, room);
}

SampleCounts ask_tile(const Picture& picture, int left, int top) {
    const ImageSize size = picture.request.surfaces->size;
    const int samples = picture.request.pattern->samples;
    TileRoom room{WaitingRays(samples), Directions(static_cast<std::size_t>(samples))};
    for_pixels_of_tile(size, left, top, [&](int x, int y) {
        ask_pixel(picture,
                  static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x),
                  room);
    });
    answer(picture, room);
    return room.counts;
}

}  // namespace

EnvironmentResult render_weighted(const VisibilityField* field, const EmbreeScene& embree,
                                  const EnvironmentRequest& request, Progress& progress) {
    EnvironmentResult result = blank_environment(request);
    const WeightedTables tables = weighted_tables(request);
    const Picture picture{field, embree, request, tables, WideTables(tables), result};
    ask_tiles(request, result, progress, [&](int left, int top) { return ask_tile(picture, left, top); });
    result.device =
        "CPU, " + std::to_string(thread_count(request.threads)) + " threads, " + std::to_string(wide::lanes) + " wide";
    return result;
}

}  // namespace sightlines::visibility_field
