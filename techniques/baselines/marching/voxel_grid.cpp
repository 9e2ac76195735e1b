#include "techniques/baselines/marching/voxel_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <new>

#include "techniques/base/error.h"
#include "techniques/base/parallel.h"
#include "techniques/baselines/tiles.h"
#include "techniques/scene/surface_fragments.h"

namespace sightlines::baselines {
namespace {

constexpr std::uint8_t no_voxel = 255;

constexpr std::array<std::string_view, 2> shapes{"fitted", "cubes"};

constexpr std::array<Parameter, 6> parameters{{
    {"resolution", "Resolution", "voxels", ParameterKind::integer, ParameterAffects::structure, 32, 256, 128, 128,
     "Voxels along each axis; with cubes, along the longest side of the scene."},
    {"shape", "Voxel shape", "", ParameterKind::choice, ParameterAffects::structure, 0, 1, 0, std::nullopt,
     "Fitted: the same number along every side of the scene's bounds, so that voxels are oblong; or cubes.", shapes},
    {"samples_per_voxel", "Samples per voxel", "", ParameterKind::real, ParameterAffects::structure, 0.5, 3, 2,
     std::nullopt, "Samples of the surface along each voxel's edge; any of them sets the voxel."},
    {"start_offset", "Start offset along the ray", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 8, 2.0,
     std::nullopt, "Length of the ray left out at the surface, which would otherwise shadow itself."},
    {"normal_offset", "Start offset along the normal", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 4,
     1.0, std::nullopt, "How far off the surface the ray starts, in voxels of the scene's longest side."},
    {"light_offset", "Light-end offset", "voxels", ParameterKind::real, ParameterAffects::picture, 0, 8, 0.5,
     std::nullopt, "Length of the ray left out at the light."},
}};

/// The box that is voxelized and the number of voxels along each axis.
struct Lattice {
    Box3 box;
    ivec3 cells{1};
};

Lattice make_lattice(const Box3& bounds, const VoxelOptions& options) {
    Lattice lattice;
    const vec3 size = bounds.size();
    float longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0.0f)) longest = 1.0f;
    const float voxel = longest / static_cast<float>(options.resolution);
    vec3 sides(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        if (options.shape == VoxelShape::fitted) {
            lattice.cells[axis] = options.resolution;
            sides[axis] = std::max(size[axis], voxel);  // a flat scene lies in one layer of cubes at least
        } else {
            const int needed = static_cast<int>(std::ceil(size[axis] / voxel - 1.0e-3f));
            lattice.cells[axis] = std::clamp(needed, 1, options.resolution);
            sides[axis] = std::max(size[axis], voxel * static_cast<float>(lattice.cells[axis]));
        }
    }
    const vec3 centre = bounds.empty() ? vec3(0.0f) : bounds.centre();
    lattice.box = {centre - 0.5f * sides, centre + 0.5f * sides};
    lattice.box.add(bounds.empty() ? centre : bounds.lowest);  // rounding must not cut the bounds
    lattice.box.add(bounds.empty() ? centre : bounds.highest);
    return lattice;
}

VoxelGrid make_grid(const Lattice& lattice, float reach) {
    VoxelGrid grid{};
    const vec3 size = lattice.box.size();
    grid.lowest = lattice.box.lowest;
    grid.reach_m = reach;
    grid.voxels_per_metre = vec3(lattice.cells) / size;
    grid.cells_x = static_cast<float>(lattice.cells.x);
    grid.cells_y = static_cast<float>(lattice.cells.y);
    grid.cells_z = static_cast<float>(lattice.cells.z);
    grid.stride_y = (lattice.cells.x + 2 + 31) / 32 * 32;
    grid.stride_z = grid.stride_y * (lattice.cells.y + 2);
    grid.rows_per_layer = lattice.cells.y + 2;
    grid.rows = grid.rows_per_layer * (lattice.cells.z + 2);
    grid.backward_words = (lattice.cells.x + 3) / 4 * grid.rows;
    return grid;
}

void set_voxels(const Scene& scene, const VoxelOptions& options, Progress& progress, Voxelization& voxels) {
    const ivec3 samples(glm::max(vec3(1.0f), glm::ceil(vec3(voxels.cells) * float(options.samples_per_voxel))));
    const auto fragments = surface_fragments(scene, {voxels.box, samples}, options.threads, progress);
    const VoxelGrid& grid = voxels.grid;
    for (const Fragment& fragment : fragments) {
        const vec3 place = (fragment.position - grid.lowest) * grid.voxels_per_metre;
        const int number = scalar_kernel::voxel_number(grid, scalar_kernel::cell_of(grid.cells_x, place.x),
                                                       scalar_kernel::cell_of(grid.cells_y, place.y),
                                                       scalar_kernel::cell_of(grid.cells_z, place.z));
        voxels.bits[static_cast<std::size_t>(number / 32)] |= 1u << (number % 32);
    }
    for (const std::uint32_t word : voxels.bits) voxels.occupied += static_cast<std::size_t>(std::popcount(word));
}

void set_distances(const VoxelOptions& options, Progress& progress, Voxelization& voxels) {
    const VoxelGrid& grid = voxels.grid;
    voxels.distances.resize(2 * static_cast<std::size_t>(grid.backward_words), 0xffffffffu);
    progress.begin("measuring rows", voxels.cells.z);
    parallel_for(voxels.cells.z, options.threads, [&](std::int64_t z) {
        std::vector<bool> occupied(static_cast<std::size_t>(voxels.cells.x));
        std::vector<std::uint8_t> row(occupied.size());
        for (int y = 0; y < voxels.cells.y; ++y) {
            for (int x = 0; x < voxels.cells.x; ++x)
                occupied[static_cast<std::size_t>(x)] = voxels.at({x, y, static_cast<int>(z)});
            const int number = y + 1 + grid.rows_per_layer * (static_cast<int>(z) + 1);
            for (const int step : {1, -1}) {
                row_distances(occupied, step, row);
                std::uint32_t* words = voxels.distances.data() + number + (step < 0 ? grid.backward_words : 0);
                for (std::size_t x = 0; x < row.size(); ++x) {
                    std::uint32_t& word = words[x / 4 * static_cast<std::size_t>(grid.rows)];
                    word &= ~(0xffu << (x % 4 * 8));
                    word |= std::uint32_t{row[x]} << (x % 4 * 8);
                }
            }
        }
        progress.advance();
    });
}

}  // namespace

bool Voxelization::at(ivec3 voxel) const {
    const int number = scalar_kernel::voxel_number(grid, voxel.x, voxel.y, voxel.z);
    return (bits[static_cast<std::size_t>(number / 32)] >> (number % 32)) & 1u;
}

void row_distances(const std::vector<bool>& occupied, int step, std::span<std::uint8_t> distances) {
    const int count = static_cast<int>(occupied.size());
    int distance = no_voxel;
    for (int i = 0; i < count; ++i) {
        const auto x = static_cast<std::size_t>(step > 0 ? count - 1 - i : i);
        const bool none = distance == no_voxel;
        distance = occupied[x] ? 0 : none ? no_voxel : std::min(distance + 1, no_voxel - 1);
        distances[x] = static_cast<std::uint8_t>(distance);
    }
}

Voxelization voxelize(const Scene& scene, const VoxelOptions& options, Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const Lattice lattice = make_lattice(scene.bounds, options);
    Voxelization voxels;
    voxels.cells = lattice.cells;
    voxels.box = lattice.box;
    voxels.reach_m = reach_m(scene);
    voxels.grid = make_grid(lattice, voxels.reach_m);
    try {
        voxels.bits.resize(static_cast<std::size_t>(voxels.grid.stride_z) * (lattice.cells.z + 2) / 32);
        set_voxels(scene, options, progress, voxels);
        if (options.distances) set_distances(options, progress, voxels);
    } catch (const std::bad_alloc&) {
        throw EnvironmentError("voxelization", "out of memory", "choose a lower resolution");
    }
    voxels.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return voxels;
}

std::span<const Parameter> marching_parameters() { return parameters; }

VoxelGrid make_query(const Voxelization& voxels, const ParameterValues& values) {
    const auto value = [&](std::string_view name) {
        return static_cast<float>(parameter_value(parameters, values, name));
    };
    VoxelGrid query = voxels.grid;
    const vec3 size = voxels.box.size();
    const int most_cells = std::max({voxels.cells.x, voxels.cells.y, voxels.cells.z});
    query.normal_offset_m =
        value("normal_offset") * std::max({size.x, size.y, size.z}) / static_cast<float>(most_cells);
    query.start_offset = value("start_offset");
    query.light_offset = value("light_offset");
    return query;
}

bool is_blocked_by_voxels(const Voxelization& voxels, const VoxelGrid& query, const Segment& segment, vec3 normal) {
    return scalar_kernel::is_blocked_by_voxels(query, {voxels.bits.data()}, segment.origin, normal, segment.target,
                                               true);
}

bool is_blocked_by_rows(const Voxelization& voxels, const VoxelGrid& query, const Segment& segment, vec3 normal) {
    return scalar_kernel::is_blocked_by_rows(query, {voxels.distances.data()}, segment.origin, normal, segment.target,
                                             true);
}

}  // namespace sightlines::baselines
