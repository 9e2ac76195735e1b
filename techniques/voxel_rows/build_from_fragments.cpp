// Algorithm 6 of Wang 2017: the surface becomes fragments once, and each fragment is splatted into every rotated
// voxelization. Laid out for the cache: all directions of one theta share the coordinate v, so the fragments are
// sorted by v once a theta, and one slice (N x N voxels, a few kilobytes) is filled and packed at a time.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>

#include "techniques/base/parallel.h"
#include "techniques/scene/surface_fragments.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/slice_bits.h"

namespace sightlines::voxel_rows {
namespace {

/// Fragments of one theta in the plane of its directions, sorted by slice: height along Y, reach along the horizontal.
struct SlicedFragments {
    std::vector<float> height, reach;
    std::vector<std::uint32_t> first;  ///< [N + 1], where each slice begins
};

int voxel_of(float coordinate, int resolution) { return std::clamp(static_cast<int>(coordinate), 0, resolution - 1); }

/// positions: from the centre of the bounds.
SlicedFragments slice_fragments(std::span<const vec3> positions, const RowShape& shape, const DirectionFrame& frame,
                                vec3 horizontal) {
    const int resolution = shape.resolution;
    SlicedFragments sliced;
    sliced.first.assign(static_cast<std::size_t>(resolution) + 1, 0);
    std::vector<std::uint16_t> slice_of(positions.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const int slice = voxel_of(scalar_kernel::along_level(shape, frame, positions[k]), resolution);
        slice_of[k] = static_cast<std::uint16_t>(slice);
        ++sliced.first[static_cast<std::size_t>(slice) + 1];
    }
    for (std::size_t slice = 1; slice < sliced.first.size(); ++slice) sliced.first[slice] += sliced.first[slice - 1];
    std::vector<std::uint32_t> next(sliced.first.begin(), sliced.first.end() - 1);
    sliced.height.resize(positions.size());
    sliced.reach.resize(positions.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const std::uint32_t place = next[slice_of[k]]++;
        sliced.height[place] = positions[k].y;
        sliced.reach[place] = horizontal.x * positions[k].x + horizontal.z * positions[k].z;
    }
    return sliced;
}

/// The affine map of one direction from (height, reach) to its voxel coordinates u and w.
struct PlaneMap {
    float u_height, u_reach, w_height, w_reach;
};

PlaneMap plane_map(const DirectionFrame& frame, vec3 horizontal) {
    return {frame.u.y, glm::dot(frame.u, horizontal), frame.w.y, glm::dot(frame.w, horizontal)};
}

/// How many fragments set a voxel: `coverage` of those that a surface across the rows leaves in one voxel's
/// cross-section. A voxel that surfaces cover by less than half lets most rays pass. At least 1.
int fragments_needed(const DirectionFrame& frame, double coverage, float cell_m) {
    const float cross_section_m2 = 1.0f / (glm::length(level_axis(frame)) * glm::length(frame.w));
    return std::max(1, static_cast<int>(std::lround(coverage * cross_section_m2 / (cell_m * cell_m))));
}

/// Counts the slice's fragments in a byte a voxel: bytes[w * stride + u]. Coordinates lie in [0, N] by the fitted box.
void count_fragments(const PlaneMap& map, std::span<const float> height, std::span<const float> reach, int resolution,
                     int stride, std::uint8_t* bytes) {
    constexpr std::size_t batch = 64;
    alignas(64) std::array<int, batch> place;
    const float half = 0.5f * static_cast<float>(resolution), last = static_cast<float>(resolution) - 0.5f;
    for (std::size_t begin = 0; begin < height.size(); begin += batch) {
        const std::size_t count = std::min(batch, height.size() - begin);
        const float* a = &height[begin];
        const float* b = &reach[begin];
        for (std::size_t k = 0; k < count; ++k) {
            const float u = fused(map.u_height, a[k], fused(map.u_reach, b[k], half));
            const float w = fused(map.w_height, a[k], fused(map.w_reach, b[k], half));
            const float u_inside = u < 0.0f ? 0.0f : (u > last ? last : u);
            const float w_inside = w < 0.0f ? 0.0f : (w > last ? last : w);
            place[k] = static_cast<int>(w_inside) * stride + static_cast<int>(u_inside);
        }
        for (std::size_t k = 0; k < count; ++k) ++bytes[place[k]];
    }
}

/// All directions of one theta: each slice is counted, packed, and stored as rows and, transposed, as its partner's.
void splat_theta(RowArray& array, const RowShape& shape, std::span<const vec3> positions, int theta, double coverage,
                 float cell_m) {
    const RowGrid& grid = array.grid;
    const int n = grid.resolution, half = grid.angles / 2;
    const double angle = theta * std::numbers::pi / grid.angles;
    const vec3 horizontal(std::cos(angle), 0.0, std::sin(angle));
    const int first_direction = theta * grid.angles;
    const SlicedFragments sliced =
        slice_fragments(positions, shape, grid.frames[static_cast<std::size_t>(first_direction)], horizontal);
    SliceBits bits(n), transposed(n);
    std::vector<std::uint8_t> bytes(bits.marks());
    for (int v = 0; v < n; ++v) {
        const std::size_t begin = sliced.first[static_cast<std::size_t>(v)];
        const std::size_t count = sliced.first[static_cast<std::size_t>(v) + 1] - begin;
        if (count == 0) continue;  // the array starts out clear
        for (int phi = 0; phi < half; ++phi) {
            const int direction = first_direction + phi;
            const DirectionFrame& frame = grid.frames[static_cast<std::size_t>(direction)];
            const DirectionFrame& partner = grid.frames[static_cast<std::size_t>(direction + half)];
            count_fragments(plane_map(frame, horizontal), {&sliced.height[begin], count}, {&sliced.reach[begin], count},
                            n, bits.stride(), bytes.data());
            bits.pack(bytes, fragments_needed(partner, coverage, cell_m));
            transposed.transpose_of(bits);
            bits.pack(bytes, fragments_needed(frame, coverage, cell_m));
            std::fill(bytes.begin(), bytes.end(), std::uint8_t{0});
            store_slice(array, shape, direction, v, bits);
            store_slice(array, shape, direction + half, v, transposed);
        }
    }
}

/// The edge of the cubes in which the surface is sampled.
float fragment_cell_m(const RowGrid& grid, double samples_per_voxel) {
    const vec3 size = grid.bounds.size();
    const float longest_m = std::max({size.x, size.y, size.z, 1.0e-3f});
    return longest_m / static_cast<float>(grid.resolution * samples_per_voxel);
}

/// The fragments in an order that keeps neighbours apart: counting two in the same voxel one after the other would wait
/// for the first to be stored.
std::vector<Fragment> scattered(const std::vector<Fragment>& fragments) {
    constexpr std::size_t apart = 64;
    std::vector<Fragment> order;
    order.reserve(fragments.size());
    const std::size_t step = fragments.size() / apart + 1;
    for (std::size_t first = 0; first < step; ++first)
        for (std::size_t k = first; k < fragments.size(); k += step) order.push_back(fragments[k]);
    return order;
}

}  // namespace

FragmentGrid fragment_grid(const RowGrid& grid, double samples_per_voxel) {
    const vec3 cells = glm::ceil(grid.bounds.size() / fragment_cell_m(grid, samples_per_voxel));
    return {grid.bounds, glm::max(ivec3(cells), ivec3(1))};
}

RowArray build_from_fragments(const Scene& scene, const BuildOptions& options, Progress& progress) {
    RowArray array = allocate_array(scene, options);
    const auto start = std::chrono::steady_clock::now();
    std::vector<vec3> positions;
    const FragmentGrid cells = fragment_grid(array.grid, options.samples_per_voxel);
    for (const Fragment& fragment : scattered(surface_fragments(scene, cells, options.threads, progress)))
        positions.push_back(fragment.position - array.grid.bounds.centre());
    array.fragments = positions.size();
    const float cell_m = fragment_cell_m(array.grid, options.samples_per_voxel);
    progress.begin("splatting fragments into all directions", array.grid.angles);
    const RowShape shape = make_shape(array.grid);
    parallel_for(array.grid.angles, options.threads, [&](std::int64_t theta) {
        splat_theta(array, shape, positions, static_cast<int>(theta), options.coverage, cell_m);
        progress.advance();
    });
    array.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return array;
}

}  // namespace sightlines::voxel_rows
