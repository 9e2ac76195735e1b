// The 2D array of rotated voxelizations (Wang 2017, section 3): one row of bits for each line through the scene in each
// of a dense set of directions; as it is, or as an index into a dictionary of rows.
#pragma once

#include <functional>
#include <span>

#include "shaders/voxel_rows.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/scene/surface_fragments.h"
#include "techniques/technique.h"

namespace sightlines::voxel_rows {

/// How the array is laid out. `angles` = 2 ceil(90 / step), so that the transposed partner (phi + 90 degrees) is in the
/// set: a deviation from the paper where the step does not divide 90 (the step used is 180 / angles, never coarser).
struct RowGrid {
    int resolution = 128;   ///< voxels along each axis of each voxelization, 32 to 256
    int angles = 90;        ///< of theta and of phi, in [0, 180) degrees
    int words_per_row = 4;  ///< 32-bit words: 1, 2, 4 or 8, the next power of two that holds the resolution
    Box3 bounds;            ///< of the scene, m
    std::vector<DirectionFrame> frames;  ///< [angles * angles], direction = theta * angles + phi

    /// Rows in memory: each direction's N x N, padded to whole blocks of row_index().
    std::size_t rows() const {
        const auto side = static_cast<std::size_t>((resolution + 7) / 8 * 8);
        return static_cast<std::size_t>(angles) * angles * side * side;
    }
};

/// What a compressed array's words hold besides the indices, and how well the dictionary serves it (Algorithm 2).
struct RowDictionary {
    int index_bits = 0;                      ///< 20 or 32; 0: the array is not compressed
    std::uint32_t rows = 0;                  ///< the most frequent ones of the array, most frequent first
    int steps = 0;                           ///< c = 0 to steps - 1
    std::vector<std::uint32_t> frequencies;  ///< [rows] how often each occurs in the array before
    std::uint64_t distinct_rows = 0;         ///< of the array before
    std::vector<std::uint64_t> rows_mapped;  ///< [steps] rows of the array that each step has mapped
    std::uint64_t rows_left_over = 0;        ///< that no step has
    double differing_share = 0.0;  ///< of the lights of all rows: those answered differently (differing_lights)
    double seconds = 0.0;
};

struct RowArray {
    RowGrid grid;
    /// [rows() * words_per_row] in the order of row_index(). Compressed: the dictionary's rows, [dictionary.rows *
    /// words_per_row], then an index for each row in the same order, bit after bit.
    HugeBuffer words;
    RowDictionary dictionary;
    double build_seconds = 0.0;
    std::size_t fragments = 0;  ///< surface samples that were splatted (0: built directly)
};

/// What a build depends on.
struct BuildOptions {
    int resolution = 128;
    double angle_step_deg = 2.0;
    double samples_per_voxel = 2.0;  ///< of the fragment grid, along each axis; Algorithm 6 only
    double coverage = 0.5;  ///< of a voxel's cross-section that sets it; 0: any fragment does. Algorithm 6 only
    double inset = 0.35;    ///< how far below the surface of solids the fragments lie, in voxels. Algorithm 6 only
    int threads = 0;
    /// Where the rows are to lie; empty: memory of our own.
    std::function<HugeBuffer(std::size_t words)> allocate;
};

/// Frames for every direction, each box fitted to the scene's bounds.
RowGrid make_grid(const Box3& bounds, int resolution, double angle_step_deg);

/// The grid of the scene's array: what moves stays inside it at all times.
RowGrid make_grid(const Scene& scene, const BuildOptions& options);

/// What the kernel must know of the grid, or of the array; the query's offsets are left at zero.
RowShape make_shape(const RowGrid& grid);
RowShape make_shape(const RowArray& array);

/// A clear array for the scene. EnvironmentError where the memory is not there.
RowArray allocate_array(const Scene& scene, const BuildOptions& options);

/// Algorithm 1: each direction voxelised from the triangles, along three axes. Slow, trusted.
RowArray build_directly(const Scene& scene, const BuildOptions& options, Progress& progress);

/// The cells in which the fast build samples the surface: cubes, `samples_per_voxel` to a voxel of the longest side.
FragmentGrid fragment_grid(const RowGrid& grid, double samples_per_voxel);

/// Algorithm 6: the surface becomes fragments once; each is splatted into all rotated voxelizations.
RowArray build_from_fragments(const Scene& scene, const BuildOptions& options, Progress& progress);

/// One direction's voxelization made by itself, as the whole build of the same options makes it; unpacked as below.
std::vector<std::uint8_t> voxelize_directly(const Scene& scene, const BuildOptions& options, int direction);
std::vector<std::uint8_t> voxelize_from_fragments(const Scene& scene, const BuildOptions& options, int direction,
                                                  Progress& progress);

/// The voxelization of one direction, unpacked for showing: occupied[(w * N + v) * N + u] != 0.
std::vector<std::uint8_t> unpack_voxelization(const RowArray& array, int direction);

/// The 32-bit words of one row, or of the dictionary's row for it: `row` is row_index(direction, v, w).
std::span<const std::uint32_t> row_words(const RowArray& array, std::uint32_t row);

/// A row of the dictionary and how often it occurred in the array.
struct DictionaryEntry {
    std::uint32_t index = 0, frequency = 0;
};

/// What stands for the row in a compressed array.
DictionaryEntry dictionary_entry(const RowArray& array, std::uint32_t row);

/// The axis v of a frame, in voxels per metre.
vec3 level_axis(const DirectionFrame& frame);

/// The voxel coordinates (u, v, w) of a point in the world.
vec3 voxel_coordinates(const RowShape& shape, const DirectionFrame& frame, vec3 point);

/// World from the voxel coordinates (u, v, w) in [0, N]^3 of a direction's voxelization.
mat4 world_from_voxels(const RowGrid& grid, int direction);

}  // namespace sightlines::voxel_rows
