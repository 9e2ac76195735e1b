// Pictures of samples whose weights differ, by Embree: the masks cull as they do for the paper's samples.
#include <chrono>
#include <mutex>

#include "techniques/base/parallel.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/decide.h"
#include "techniques/visibility_field/weighted_samples.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

/// The rays of some pixels that wait for Embree, and whose they are.
struct WaitingRays {
    struct Run {
        std::size_t pixel = 0;
        DrawnPixel drawn;
        std::vector<std::uint32_t> blocked;  ///< without a ray
    };
    std::vector<float> origin[3], direction[3];
    std::vector<std::uint32_t> run, sample;
    std::vector<Run> runs;

    void add(vec3 start, vec3 along, std::uint32_t number) {
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis].push_back(start[axis]);
            direction[axis].push_back(along[axis]);
        }
        run.push_back(static_cast<std::uint32_t>(runs.size() - 1));
        sample.push_back(number);
    }
};

struct Picture {
    const VisibilityField* field;
    const EmbreeScene& embree;
    const EnvironmentRequest& request;
    EnvironmentResult& result;
};

/// Makes the pixel's samples; what the masks know is noted, the rest waits.
void sort_samples(const Picture& picture, std::size_t pixel, WaitingRays& waiting, SampleCounts& counts) {
    const EnvironmentRequest& request = picture.request;
    const SurfaceBuffer& surfaces = *request.surfaces;
    const vec3 normal = surfaces.normal[pixel], position = surfaces.position[pixel];
    kernel::FieldCell cell{0, 0, 0, kernel::no_cell, 0};
    if (picture.field != nullptr)
        cell = kernel::locate_cell(picture.field->shape, {picture.field->bricks.data()}, position, normal);
    const bool has_cell = cell.index != kernel::no_cell;
    const vec3 start = lifted_off(picture.embree, position, normal);
    waiting.runs.push_back({pixel, draw_samples(request, pixel), {}});
    WaitingRays::Run& run = waiting.runs.back();
    run.blocked.resize((run.drawn.directions.size() + 31) / 32);
    std::uint32_t traced = 0;
    for (std::uint32_t k = 0; k < run.drawn.directions.size(); ++k) {
        const vec3 direction = run.drawn.directions[k];
        const bool above = kernel::leaves_surface(normal, direction);
        counts.below += !above;
        const kernel::Decision decision = has_cell
                                              ? decide(*picture.field, culling_used(request), cell, direction, above)
                                              : kernel::decide_without_masks(above);
        if (decision.blocked) run.blocked[k / 32] |= 1u << (k % 32);
        if (!decision.trace) continue;
        waiting.add(start, direction, k);
        ++traced;
    }
    counts.samples += run.drawn.directions.size();
    counts.traced += traced;
    if (!has_cell) counts.outside += traced;
    picture.result.rays_traced.pixels[pixel] = traced;
}

void answer(const Picture& picture, WaitingRays& waiting, SampleCounts& counts) {
    const std::size_t count = waiting.run.size();
    for (int axis = 0; axis < 3; ++axis) {
        waiting.origin[axis].resize(count + 16);
        waiting.direction[axis].resize(count + 16);
    }
    const PackedOpenRays rays{{waiting.origin[0].data(), waiting.origin[1].data(), waiting.origin[2].data()},
                              {waiting.direction[0].data(), waiting.direction[1].data(), waiting.direction[2].data()},
                              count};
    std::vector<std::uint32_t> blocked(count / 32 + 1);
    are_blocked(picture.embree, rays, blocked);
    for (std::size_t k = 0; k < count; ++k) {
        if ((blocked[k / 32] >> (k % 32) & 1u) == 0) continue;
        ++counts.traced_blocked;
        waiting.runs[waiting.run[k]].blocked[waiting.sample[k] / 32] |= 1u << (waiting.sample[k] % 32);
    }
    for (const WaitingRays::Run& run : waiting.runs)
        resolve_weighted(picture.request, run.pixel, run.drawn, run.blocked, picture.result);
}

}  // namespace

EnvironmentResult render_weighted(const VisibilityField* field, const EmbreeScene& embree,
                                  const EnvironmentRequest& request, Progress& progress) {
    const ImageSize size = request.surfaces->size;
    EnvironmentResult result = blank_environment(request);
    const Picture picture{field, embree, request, result};
    const auto start = std::chrono::steady_clock::now();
    std::mutex sum_mutex;
    progress.begin("asking the environment", size.height);
    parallel_for(size.height, request.threads, [&](std::int64_t index) {
        const std::int64_t row = request.reverse_tiles ? size.height - 1 - index : index;
        WaitingRays waiting;
        SampleCounts counts;
        const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width);
        for (std::size_t pixel = first; pixel < first + static_cast<std::size_t>(size.width); ++pixel)
            if (request.surfaces->triangle[pixel] != no_triangle) sort_samples(picture, pixel, waiting, counts);
        answer(picture, waiting, counts);
        {
            const std::lock_guard lock(sum_mutex);
            add(result.counts, counts);
            if (request.on_region) request.on_region(result, {0, static_cast<int>(row), size.width, 1});
        }
        progress.advance();
    });
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.device = "CPU, " + std::to_string(thread_count(request.threads)) + " threads";
    return result;
}

}  // namespace sightlines::visibility_field
