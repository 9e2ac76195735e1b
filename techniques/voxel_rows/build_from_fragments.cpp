// Algorithm 6 of Wang 2017: the surface becomes fragments once, and each fragment is splatted into every rotated
// voxelization. Laid out for the cache: all directions of one theta share the coordinate v, so the fragments are
// sorted by v once a theta, and one slice (N x N voxels, a few kilobytes) is filled and packed at a time.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>

#include "techniques/base/parallel.h"
#include "techniques/scene/surface_fragments.h"
#include "techniques/voxel_rows/moving_rows.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/slice_bits.h"

namespace sightlines::voxel_rows {
namespace {

/// A fragment from the centre of the bounds, and how much surface it stands for: 1 to 255 fifths of a cell's face.
struct SurfaceSample {
    vec3 position;
    std::uint8_t area;
};
constexpr double area_units = 5.0;

/// Samples of one theta in the plane of its directions, sorted by slice: height along Y, reach along the horizontal.
struct SlicedSamples {
    std::vector<float> height, reach;
    std::vector<std::uint8_t> area;
    std::vector<std::uint32_t> first;  ///< [N + 1], where each slice begins
};

int voxel_of(float coordinate, int resolution) { return std::clamp(static_cast<int>(coordinate), 0, resolution - 1); }

SlicedSamples slice_samples(std::span<const SurfaceSample> samples, const RowShape& shape, const DirectionFrame& frame,
                            vec3 horizontal) {
    const int resolution = shape.resolution;
    SlicedSamples sliced;
    sliced.first.assign(static_cast<std::size_t>(resolution) + 1, 0);
    std::vector<std::uint16_t> slice_of(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const int slice = voxel_of(scalar_kernel::along_level(shape, frame, samples[k].position), resolution);
        slice_of[k] = static_cast<std::uint16_t>(slice);
        ++sliced.first[static_cast<std::size_t>(slice) + 1];
    }
    for (std::size_t slice = 1; slice < sliced.first.size(); ++slice) sliced.first[slice] += sliced.first[slice - 1];
    std::vector<std::uint32_t> next(sliced.first.begin(), sliced.first.end() - 1);
    sliced.height.resize(samples.size());
    sliced.reach.resize(samples.size());
    sliced.area.resize(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const std::uint32_t place = next[slice_of[k]]++;
        const vec3 position = samples[k].position;
        sliced.height[place] = position.y;
        sliced.reach[place] = horizontal.x * position.x + horizontal.z * position.z;
        sliced.area[place] = samples[k].area;
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

/// The area that sets a voxel, in the units of SurfaceSample: `coverage` of its cross-section. 1: any does.
int area_needed(const DirectionFrame& frame, double coverage, float cell_m) {
    const float cross_section_m2 = 1.0f / (glm::length(level_axis(frame)) * glm::length(frame.w));
    return std::max(1, static_cast<int>(std::lround(area_units * coverage * cross_section_m2 / (cell_m * cell_m))));
}

/// Adds up the areas of the samples of one slice, from `begin` on. Coordinates lie in [0, N] by the fitted box. A voxel
/// that holds more than 255 stays there where `saturating`, and loses the rest of 256 where not, which is faster.
template <bool saturating>
void add_areas(const PlaneMap& map, const SlicedSamples& sliced, std::size_t begin, std::size_t end, int resolution,
               SliceCounts& areas) {
    constexpr std::size_t batch = 64;
    alignas(64) std::array<int, batch> place;
    const float half = 0.5f * static_cast<float>(resolution), last = static_cast<float>(resolution) - 0.5f;
    const int first_place = areas.place_of(0, 0), pitch = areas.pitch;
    for (; begin < end; begin += batch) {
        const std::size_t count = std::min(batch, end - begin);
        const float* a = &sliced.height[begin];
        const float* b = &sliced.reach[begin];
        for (std::size_t k = 0; k < count; ++k) {
            const float u = fused(map.u_height, a[k], fused(map.u_reach, b[k], half));
            const float w = fused(map.w_height, a[k], fused(map.w_reach, b[k], half));
            const float u_inside = u < 0.0f ? 0.0f : (u > last ? last : u);
            const float w_inside = w < 0.0f ? 0.0f : (w > last ? last : w);
            place[k] = first_place + static_cast<int>(w_inside) * pitch + static_cast<int>(u_inside);
        }
        const std::uint8_t* area = &sliced.area[begin];
        std::uint8_t* bytes = areas.bytes.data();
        for (std::size_t k = 0; k < count; ++k) {
            const unsigned sum = bytes[place[k]] + unsigned{area[k]};
            bytes[place[k]] = static_cast<std::uint8_t>(saturating ? std::min(sum, 255u) : sum);
        }
    }
}

/// What is splatted, and how.
struct Splat {
    std::vector<SurfaceSample> samples;
    double coverage = 0.0;
    float cell_m = 0.0f;  ///< of the fragment grid
    Storing storing = Storing::replace;
};

vec3 horizontal_of(const RowGrid& grid, int theta) {
    const double angle = theta * std::numbers::pi / grid.angles;
    return {std::cos(angle), 0.0, std::sin(angle)};
}

/// The samples that lie in one slice.
struct SliceOfSamples {
    const SlicedSamples& sliced;
    std::size_t begin, end;
    std::uint64_t area;  ///< of all of them

    SliceOfSamples(const SlicedSamples& sliced_, int v)
        : sliced(sliced_),
          begin(sliced.first[static_cast<std::size_t>(v)]),
          end(sliced.first[static_cast<std::size_t>(v) + 1]),
          area(std::accumulate(sliced.area.data() + begin, sliced.area.data() + end, std::uint64_t{0})) {}
};

/// One slice's bits along the rows of `direction` (phi below 90 degrees), and of its partner across them.
void pack_slice(const SliceOfSamples& slice, const RowGrid& grid, int direction, vec3 horizontal, const Splat& splat,
                SliceCounts& areas, SliceBits& along_u, SliceBits& along_w) {
    const int n = grid.resolution;
    const DirectionFrame& frame = grid.frames[static_cast<std::size_t>(direction)];
    const DirectionFrame& partner = grid.frames[static_cast<std::size_t>(direction + grid.angles / 2)];
    const Needed needed{area_needed(frame, splat.coverage, splat.cell_m),
                        area_needed(partner, splat.coverage, splat.cell_m)};
    const PlaneMap map = plane_map(frame, horizontal);
    add_areas<false>(map, slice.sliced, slice.begin, slice.end, n, areas);
    if (take_bits(areas, needed, along_u, along_w) == slice.area) return;
    add_areas<true>(map, slice.sliced, slice.begin, slice.end, n, areas);  // a voxel overflowed: rare
    take_bits(areas, needed, along_u, along_w);
}

/// All directions of one theta: each slice is added up, packed, and stored as rows and, transposed, as its partner's.
/// Marks the slices that hold samples in `touched`, [N].
void splat_theta(RowArray& array, const RowShape& shape, const Splat& splat, int theta, std::span<std::uint8_t> touched,
                 const Progress& progress) {
    const RowGrid& grid = array.grid;
    const int n = grid.resolution, half = grid.angles / 2, first_direction = theta * grid.angles;
    const vec3 horizontal = horizontal_of(grid, theta);
    const SlicedSamples sliced =
        slice_samples(splat.samples, shape, grid.frames[static_cast<std::size_t>(first_direction)], horizontal);
    SliceBits along_u(n), along_w(n), transposed(n);
    SliceCounts areas(n);
    for (int v = 0; v < n; ++v) {
        const SliceOfSamples slice(sliced, v);
        if (slice.begin == slice.end) continue;  // stays as it was
        touched[static_cast<std::size_t>(v)] = 1;
        progress.check();  // a theta takes longer than whoever cancels wants to wait
        for (int direction = first_direction; direction < first_direction + half; ++direction) {
            pack_slice(slice, grid, direction, horizontal, splat, areas, along_u, along_w);
            store_slice(array, shape, direction, v, along_u, splat.storing);
            transpose(along_w, transposed);
            store_slice(array, shape, direction + half, v, transposed, splat.storing);
        }
    }
    finish_storing();
}

/// The edge of the cubes in which the surface is sampled.
float fragment_cell_m(const RowGrid& grid, double samples_per_voxel) {
    const vec3 size = grid.bounds.size();
    const float longest_m = std::max({size.x, size.y, size.z, 1.0e-3f});
    return longest_m / static_cast<float>(grid.resolution * samples_per_voxel);
}

/// The samples that the fragments stand for, those of solids `inset_m` below the surface. In an order that keeps
/// neighbours apart: adding two to the same voxel one after the other would wait for the first to be stored.
std::vector<SurfaceSample> surface_samples(const Scene& scene, const std::vector<Fragment>& fragments, vec3 centre,
                                           float inset_m, float cell_m) {
    constexpr std::size_t apart = 64;
    std::vector<SurfaceSample> samples;
    samples.reserve(fragments.size());
    const std::size_t step = fragments.size() / apart + 1;
    for (std::size_t first = 0; first < step; ++first) {
        for (std::size_t k = first; k < fragments.size(); k += step) {
            const Fragment& fragment = fragments[k];
            const bool solid = !scene.materials[scene.triangle_materials[fragment.triangle]].double_sided;
            const vec3 inset = solid ? inset_m * winding_normal(scene, fragment.triangle) : vec3(0.0f);
            const double area = area_units * fragment.area_m2 / (cell_m * cell_m);
            samples.push_back({fragment.position - centre - inset,
                               static_cast<std::uint8_t>(std::clamp(std::round(area), 1.0, 255.0))});
        }
    }
    return samples;
}

}  // namespace

FragmentGrid fragment_grid(const RowGrid& grid, double samples_per_voxel) {
    const vec3 cells = glm::ceil(grid.bounds.size() / fragment_cell_m(grid, samples_per_voxel));
    return {grid.bounds, glm::max(ivec3(cells), ivec3(1))};
}

namespace {

Splat make_splat(const Scene& scene, const RowGrid& grid, const BuildOptions& options, Storing storing,
                 Progress& progress) {
    const float cell_m = fragment_cell_m(grid, options.samples_per_voxel);
    const auto inset_m = static_cast<float>(options.inset) * fragment_cell_m(grid, 1.0);
    const std::vector<Fragment> fragments =
        surface_fragments(scene, fragment_grid(grid, options.samples_per_voxel), options.threads, progress);
    return {surface_samples(scene, fragments, grid.bounds.centre(), inset_m, cell_m), options.coverage, cell_m,
            storing};
}

/// Splats the scene's surface into the array. Returns the slices that it touched.
SliceMarks splat_surface(RowArray& array, const Scene& scene, const BuildOptions& options, Storing storing,
                         Progress& progress) {
    const RowGrid& grid = array.grid;
    const Splat splat = make_splat(scene, grid, options, storing, progress);
    array.fragments += splat.samples.size();
    progress.begin("splatting fragments into all directions", grid.angles);
    const RowShape shape = make_shape(grid);
    const auto n = static_cast<std::size_t>(grid.resolution);
    SliceMarks touched(static_cast<std::size_t>(grid.angles) * n);
    parallel_for(grid.angles, options.threads, [&](std::int64_t theta) {
        splat_theta(array, shape, splat, static_cast<int>(theta), std::span(touched).subspan(theta * n, n), progress);
        progress.advance();
    });
    return touched;
}

}  // namespace

RowArray build_from_fragments(const Scene& scene, const BuildOptions& options, Progress& progress) {
    RowArray array = allocate_array(scene, options);
    const auto start = std::chrono::steady_clock::now();
    splat_surface(array, scene, options, Storing::replace, progress);
    array.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return array;
}

std::vector<std::uint8_t> voxelize_from_fragments(const Scene& scene, const BuildOptions& options, int direction,
                                                  Progress& progress) {
    const RowGrid grid = make_grid(scene, options);
    const int n = grid.resolution, half = grid.angles / 2, theta = direction / grid.angles;
    const bool is_partner = direction % grid.angles >= half;
    const int packed_as = is_partner ? direction - half : direction;
    const Splat splat = make_splat(scene, grid, options, Storing::replace, progress);
    const vec3 horizontal = horizontal_of(grid, theta);
    const SlicedSamples sliced = slice_samples(splat.samples, make_shape(grid),
                                               grid.frames[static_cast<std::size_t>(theta) * grid.angles], horizontal);
    SliceBits along_u(n), along_w(n), transposed(n);
    SliceCounts areas(n);
    std::vector<std::uint8_t> occupied(static_cast<std::size_t>(n) * n * n);
    for (int v = 0; v < n; ++v) {
        const SliceOfSamples slice(sliced, v);
        if (slice.begin == slice.end) continue;
        pack_slice(slice, grid, packed_as, horizontal, splat, areas, along_u, along_w);
        transpose(along_w, transposed);
        unpack_slice(is_partner ? transposed : along_u, n, v, occupied);
    }
    return occupied;
}

SliceMarks splat_onto(RowArray& array, const Scene& moving, const BuildOptions& options, Progress& progress) {
    return splat_surface(array, moving, options, Storing::add, progress);
}

void restore_slices(RowArray& array, const RowArray& fixed, const SliceMarks& slices, int threads) {
    const RowGrid& grid = array.grid;
    const RowShape shape = make_shape(grid);
    const int n = grid.resolution;
    const auto eight_rows = static_cast<std::size_t>(grid.words_per_row) * 8;
    parallel_for(grid.angles, threads, [&](std::int64_t theta) {
        for (int v = 0; v < n; ++v) {
            if (slices[static_cast<std::size_t>(theta * n + v)] == 0) continue;
            for (int phi = 0; phi < grid.angles; ++phi) {
                for (int w = 0; w < n; w += 8) {  // eight rows lie together
                    const std::size_t first =
                        scalar_kernel::row_index(shape, {static_cast<int>(theta), phi}, v, w) * eight_rows / 8;
                    std::ranges::copy(fixed.words.words.subspan(first, eight_rows),
                                      array.words.words.subspan(first, eight_rows).begin());
                }
            }
        }
    });
}

}  // namespace sightlines::voxel_rows
