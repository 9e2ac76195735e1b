// Algorithm 1 of Wang 2017: every direction is voxelised from the triangles themselves, rasterised along each of the
// voxelization's three axes so that no surface is seen edge-on by all. Slow and simple: the oracle of the fast build.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "techniques/base/parallel.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/slice_bits.h"

namespace sightlines::voxel_rows {
namespace {

/// Marks of a whole voxelization: a voxel that holds anything is set.
struct Marks {
    int resolution;
    std::vector<SliceCounts> slices;  ///< [N] along v

    explicit Marks(int n) : resolution(n), slices(static_cast<std::size_t>(n), SliceCounts(n)) {}
    void set(vec3 voxel) {
        const ivec3 place = glm::clamp(ivec3(glm::floor(voxel)), 0, resolution - 1);
        SliceCounts& slice = slices[static_cast<std::size_t>(place.y)];
        slice.bytes[static_cast<std::size_t>(slice.place_of(place.x, place.z))] = 1;
    }
};

float edge(vec2 a, vec2 b, vec2 point) { return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x); }

/// Sets the voxel under each pixel centre that the triangle covers when seen along `axis`.
void rasterize_along(int axis, const std::array<vec3, 3>& corners, Marks& marks) {
    const int across = (axis + 1) % 3, down = (axis + 2) % 3;
    std::array<vec2, 3> flat;
    for (std::size_t k = 0; k < 3; ++k) flat[k] = {corners[k][across], corners[k][down]};
    const float area = edge(flat[0], flat[1], flat[2]);
    if (area == 0.0f) return;  // seen edge-on
    const vec2 lowest = glm::min(flat[0], glm::min(flat[1], flat[2]));
    const vec2 highest = glm::max(flat[0], glm::max(flat[1], flat[2]));
    const ivec2 begin = glm::max(ivec2(glm::ceil(lowest - 0.5f)), 0);
    const ivec2 end = glm::min(ivec2(glm::floor(highest - 0.5f)), marks.resolution - 1);
    for (int y = begin.y; y <= end.y; ++y) {
        for (int x = begin.x; x <= end.x; ++x) {
            const vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const vec3 weights =
                vec3(edge(flat[1], flat[2], centre), edge(flat[2], flat[0], centre), edge(flat[0], flat[1], centre)) /
                area;
            if (weights.x < 0.0f || weights.y < 0.0f || weights.z < 0.0f) continue;
            vec3 point;
            point[across] = centre.x;
            point[down] = centre.y;
            point[axis] = weights.x * corners[0][axis] + weights.y * corners[1][axis] + weights.z * corners[2][axis];
            marks.set(point);
        }
    }
}

void voxelize(const Scene& scene, const RowShape& shape, const DirectionFrame& frame, Marks& marks) {
    for (const uvec3& triangle : scene.triangles) {
        std::array<vec3, 3> corners;
        for (int k = 0; k < 3; ++k)
            corners[static_cast<std::size_t>(k)] = voxel_coordinates(shape, frame, scene.positions[triangle[k]]);
        for (int axis = 0; axis < 3; ++axis) rasterize_along(axis, corners, marks);
    }
}

}  // namespace

RowArray build_directly(const Scene& scene, const BuildOptions& options, Progress& progress) {
    RowArray array = allocate_array(scene, options);
    const auto start = std::chrono::steady_clock::now();
    const int n = options.resolution, half = array.grid.angles / 2;
    const RowShape shape = make_shape(array.grid);
    progress.begin("voxelising each direction from the triangles", static_cast<std::int64_t>(array.grid.angles) * half);
    parallel_for(array.grid.angles, options.threads, [&](std::int64_t theta) {
        Marks marks(n);
        SliceBits bits(n), bits_again(n), transposed(n);
        for (int phi = 0; phi < half; ++phi) {
            const int direction = static_cast<int>(theta) * array.grid.angles + phi;
            voxelize(scene, shape, array.grid.frames[static_cast<std::size_t>(direction)], marks);
            for (int v = 0; v < n; ++v) {
                take_bits(marks.slices[static_cast<std::size_t>(v)], {1, 1}, bits, bits_again);
                transpose(bits, transposed);
                store_slice(array, shape, direction, v, bits);
                store_slice(array, shape, direction + half, v, transposed);
            }
            progress.advance();
        }
        finish_storing();
    });
    array.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return array;
}

std::vector<std::uint8_t> voxelize_directly(const Scene& scene, const BuildOptions& options, int direction) {
    const RowGrid grid = make_grid(scene, options);
    const int n = grid.resolution, half = grid.angles / 2;
    const bool is_partner = direction % grid.angles >= half;
    const int voxelized_as = is_partner ? direction - half : direction;
    Marks marks(n);
    voxelize(scene, make_shape(grid), grid.frames[static_cast<std::size_t>(voxelized_as)], marks);
    SliceBits bits(n), bits_again(n), transposed(n);
    std::vector<std::uint8_t> occupied(static_cast<std::size_t>(n) * n * n);
    for (int v = 0; v < n; ++v) {
        take_bits(marks.slices[static_cast<std::size_t>(v)], {1, 1}, bits, bits_again);
        transpose(bits, transposed);
        unpack_slice(is_partner ? transposed : bits, n, v, occupied);
    }
    return occupied;
}

}  // namespace sightlines::voxel_rows
