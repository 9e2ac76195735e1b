#include "techniques/voxel_rows/row_array.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace sightlines::voxel_rows {
namespace {

/// The unit axis, scaled so that the bounds' extent along it is N voxels.
vec3 fitted_axis(vec3 axis, const Box3& bounds, int resolution) {
    const vec3 size = glm::max(bounds.size(), vec3(1.0e-3f));
    // A hair of slack keeps points on the bounds inside the grid after rounding.
    const float extent = glm::dot(glm::abs(axis), size) * 1.00001f;
    return axis * (static_cast<float>(resolution) / extent);
}

DirectionFrame make_frame(double theta, double phi, const Box3& bounds, int resolution) {
    const vec3 horizontal(std::cos(theta), 0.0, std::sin(theta));
    const vec3 up(0.0f, 1.0f, 0.0f);
    const auto cosine = static_cast<float>(std::cos(phi)), sine = static_cast<float>(std::sin(phi));
    const vec3 u = fitted_axis(cosine * up + sine * horizontal, bounds, resolution);
    const vec3 v = fitted_axis(vec3(-horizontal.z, 0.0f, horizontal.x), bounds, resolution);
    const vec3 w = fitted_axis(cosine * horizontal - sine * up, bounds, resolution);
    return {u, v.x, w, v.z};
}

int next_power_of_two(int value) {
    int power = 1;
    while (power < value) power *= 2;
    return power;
}

}  // namespace

RowGrid make_grid(const Box3& bounds, int resolution, double angle_step_deg) {
    RowGrid grid;
    grid.resolution = resolution;
    grid.angles = 2 * static_cast<int>(std::ceil(90.0 / angle_step_deg - 1e-9));
    grid.words_per_row = next_power_of_two((resolution + 31) / 32);
    grid.bounds = bounds.empty() ? Box3{vec3(-0.5f), vec3(0.5f)} : bounds;
    const int half = grid.angles / 2;
    const double step = std::numbers::pi / grid.angles;
    grid.frames.resize(static_cast<std::size_t>(grid.angles) * grid.angles);
    for (int theta = 0; theta < grid.angles; ++theta) {
        for (int phi = 0; phi < half; ++phi) {
            const DirectionFrame frame = make_frame(theta * step, phi * step, grid.bounds, resolution);
            const std::size_t direction = static_cast<std::size_t>(theta) * grid.angles + phi;
            grid.frames[direction] = frame;
            // 90 degrees on, the rows are the columns of this voxelization: u and w change places (Algorithm 1, line
            // 4).
            grid.frames[direction + half] = {frame.w, frame.v_x, frame.u, frame.v_z};
        }
    }
    return grid;
}

RowShape make_shape(const RowGrid& grid) {
    RowShape shape{};
    shape.resolution = grid.resolution;
    shape.angles = grid.angles;
    shape.words_per_row = grid.words_per_row;
    shape.subrays = 1;
    shape.centre = grid.bounds.centre();
    shape.half_size = 0.5f * grid.bounds.size();
    shape.reach_m = 2.0f * grid.bounds.diagonal();
    return shape;
}

RowShape make_shape(const RowArray& array) {
    RowShape shape = make_shape(array.grid);
    shape.index_bits = array.dictionary.index_bits;
    shape.index_start = static_cast<int>(array.dictionary.rows) * shape.words_per_row;
    return shape;
}

RowGrid make_grid(const Scene& scene, const BuildOptions& options) {
    const Box3& bounds = scene.motion_bounds.empty() ? scene.bounds : scene.motion_bounds;
    return make_grid(bounds, options.resolution, options.angle_step_deg);
}

RowArray allocate_array(const Scene& scene, const BuildOptions& options) {
    RowArray array;
    array.grid = make_grid(scene, options);
    const std::size_t words = array.grid.rows() * static_cast<std::size_t>(array.grid.words_per_row);
    array.words = options.allocate ? options.allocate(words) : allocate_huge(words);
    return array;
}

std::span<const std::uint32_t> row_words(const RowArray& array, std::uint32_t row) {
    const auto length = static_cast<std::size_t>(array.grid.words_per_row);
    const std::uint32_t stored = scalar_kernel::stored_row(make_shape(array), {array.words.words.data()}, row);
    return array.words.words.subspan(stored * length, length);
}

DictionaryEntry dictionary_entry(const RowArray& array, std::uint32_t row) {
    assert(array.dictionary.index_bits != 0);
    const std::uint32_t index = scalar_kernel::stored_row(make_shape(array), {array.words.words.data()}, row);
    return {index, array.dictionary.frequencies[index]};
}

std::vector<std::uint8_t> unpack_voxelization(const RowArray& array, int direction) {
    const int n = array.grid.resolution;
    const RowShape shape = make_shape(array.grid);
    std::vector<std::uint8_t> occupied(static_cast<std::size_t>(n) * n * n);
    for (int w = 0; w < n; ++w) {
        for (int v = 0; v < n; ++v) {
            const auto words = row_words(
                array, scalar_kernel::row_index(shape, {direction / shape.angles, direction % shape.angles}, v, w));
            std::uint8_t* row = &occupied[(static_cast<std::size_t>(w) * n + v) * n];
            for (int u = 0; u < n; ++u) row[u] = (words[static_cast<std::size_t>(u / 32)] >> (u % 32)) & 1u;
        }
    }
    return occupied;
}

vec3 level_axis(const DirectionFrame& frame) { return {frame.v_x, 0.0f, frame.v_z}; }

vec3 voxel_coordinates(const RowShape& shape, const DirectionFrame& frame, vec3 point) {
    const vec3 from_centre = point - shape.centre;
    return {scalar_kernel::along(shape, frame.u, from_centre), scalar_kernel::along_level(shape, frame, from_centre),
            scalar_kernel::along(shape, frame.w, from_centre)};
}

mat4 world_from_voxels(const RowGrid& grid, int direction) {
    const DirectionFrame& frame = grid.frames[static_cast<std::size_t>(direction)];
    const mat3 world_axes = glm::inverse(glm::transpose(mat3(frame.u, level_axis(frame), frame.w)));
    const vec3 origin = grid.bounds.centre() - world_axes * vec3(0.5f * static_cast<float>(grid.resolution));
    return {vec4(world_axes[0], 0.0f), vec4(world_axes[1], 0.0f), vec4(world_axes[2], 0.0f), vec4(origin, 1.0f)};
}

}  // namespace sightlines::voxel_rows
