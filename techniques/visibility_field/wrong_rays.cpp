// Which discarded rays should not have been: all of them cast, by the scalar kernel.
#include <algorithm>
#include <mutex>

#include "techniques/base/parallel.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/decide.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

/// The discarded rays of one pixel, packed.
struct Discarded {
    std::vector<float> origin[3], direction[3];
    std::vector<std::uint32_t> sample, blocked;
    std::vector<bool> taken_for_blocked;

    void clear() {
        for (auto& axis : origin) axis.clear();
        for (auto& axis : direction) axis.clear();
        sample.clear();
        taken_for_blocked.clear();
    }
    void pad() {
        for (auto& axis : origin) axis.resize(sample.size() + 16);
        for (auto& axis : direction) axis.resize(sample.size() + 16);
        blocked.resize(sample.size() / 32 + 1);
    }
};

void collect(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
             std::size_t pixel, std::size_t tile, Discarded& discarded) {
    discarded.clear();
    const SurfaceBuffer& surfaces = *request.surfaces;
    const SamplePattern& pattern = *request.pattern;
    const vec3 normal = surfaces.normal[pixel];
    const kernel::FieldCell cell =
        kernel::locate_cell(field.shape, {field.bricks.data()}, surfaces.position[pixel], normal);
    if (cell.index == kernel::no_cell) return;
    const kernel::HemisphereFrame frame =
        kernel::frame_about(surfaces.shading_normal[pixel], pattern.turns[tile].x, pattern.turns[tile].y);
    const vec3 start = lifted_off(embree, surfaces.position[pixel], normal);
    for (std::size_t k = 0; k < static_cast<std::size_t>(pattern.samples); ++k) {
        const vec3 direction = kernel::direction_in(frame, pattern.x[k], pattern.y[k], pattern.z[k]);
        if (!kernel::leaves_surface(normal, direction)) continue;
        const kernel::Decision decision = decide(field, request.culling, cell, direction, true);
        if (decision.trace) continue;
        for (int axis = 0; axis < 3; ++axis) {
            discarded.origin[axis].push_back(start[axis]);
            discarded.direction[axis].push_back(direction[axis]);
        }
        discarded.sample.push_back(static_cast<std::uint32_t>(k));
        discarded.taken_for_blocked.push_back(decision.blocked);
    }
    discarded.pad();
}

/// Casts the discarded rays; lists those that are wrong.
void check(const EmbreeScene& embree, std::size_t pixel, Discarded& discarded, WrongRays& found) {
    PackedOpenRays rays;
    rays.count = discarded.sample.size();
    for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis] = discarded.origin[axis].data();
        rays.direction[axis] = discarded.direction[axis].data();
    }
    are_blocked(embree, rays, discarded.blocked);
    found.discarded += rays.count;
    for (std::size_t k = 0; k < rays.count; ++k) {
        const bool blocked = (discarded.blocked[k / 32] >> (k % 32) & 1u) != 0;
        if (blocked == discarded.taken_for_blocked[k]) continue;
        ++found.wrong;
        found.first.push_back({static_cast<std::uint32_t>(pixel),
                               discarded.sample[k],
                               {discarded.direction[0][k], discarded.direction[1][k], discarded.direction[2][k]},
                               discarded.taken_for_blocked[k]});
    }
}

}  // namespace

WrongRays find_wrong_rays(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                          std::size_t most, Progress& progress) {
    const ImageSize size = request.surfaces->size;
    std::vector<WrongRays> rows(static_cast<std::size_t>(size.height));
    progress.begin("casting discarded rays", size.height);
    parallel_for(size.height, request.threads, [&](std::int64_t row) {
        WrongRays& found = rows[static_cast<std::size_t>(row)];
        Discarded discarded;
        for (int x = 0; x < size.width; ++x) {
            const std::size_t pixel =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
            if (request.surfaces->triangle[pixel] == no_triangle) continue;
            const std::size_t tile = request.pattern->tile_place(x, static_cast<int>(row));
            collect(field, embree, request, pixel, tile, discarded);
            if (!discarded.sample.empty()) check(embree, pixel, discarded, found);
        }
        found.first.resize(std::min(found.first.size(), most));
        progress.advance();
    });
    WrongRays all;
    for (const WrongRays& row : rows) {
        all.discarded += row.discarded;
        all.wrong += row.wrong;
        const std::size_t wanted = std::min(row.first.size(), most - all.first.size());
        all.first.insert(all.first.end(), row.first.begin(), row.first.begin() + static_cast<std::ptrdiff_t>(wanted));
    }
    return all;
}

}  // namespace sightlines::visibility_field
