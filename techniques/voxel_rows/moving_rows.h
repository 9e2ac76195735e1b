// Arrays of scenes that move (Wang 2017, section 5.2): what stands still is kept, what moves is splatted over it again.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

/// Slices of constant v in all directions of a theta, [angles][N]; not 0: marked.
using SliceMarks = std::vector<std::uint8_t>;

/// Algorithm 6 for what moves: splats its surface over what the array holds, whose grid spans it at all times. Returns
/// the slices that it touched. Where a voxel holds too little of what moves and too little of what stands still, but
/// enough of both together, it stays clear: a deviation from voxelising the whole.
SliceMarks splat_onto(RowArray& array, const Scene& moving, const BuildOptions& options, Progress& progress);

/// Puts back what `fixed`, of the same grid, holds in those slices.
void restore_slices(RowArray& array, const RowArray& fixed, const SliceMarks& slices, int threads);

/// Rows that equal the fixed ones but for some slices.
struct ChangedRows {
    HugeBuffer words;
    SliceMarks touched;
};

/// What the moments of one scene share: the rows of what stands still, and memory that no moment uses now.
struct MovingRows {
    RowArray fixed;
    std::mutex mutex;
    std::vector<ChangedRows> spare;
};

/// The rows of one moment; goes back to the spare ones at its end, so that the next moment need not copy all of them.
struct Moment {
    std::shared_ptr<MovingRows> shared;
    ChangedRows rows;

    Moment() = default;
    Moment(std::shared_ptr<MovingRows> shared_, ChangedRows rows_)
        : shared(std::move(shared_)), rows(std::move(rows_)) {}
    ~Moment();
    Moment(Moment&&) noexcept = default;
    Moment& operator=(Moment&&) noexcept = default;
};

/// The rows of the scene's parts that never change, on a grid that spans the whole at all times.
std::shared_ptr<MovingRows> build_fixed(const Scene& scene, const BuildOptions& options, Progress& progress);

/// The rows of the whole scene at its moment: `array.words` are `moment.rows.words`.
struct MomentArray {
    RowArray array;
    Moment moment;
};
MomentArray build_moment(const std::shared_ptr<MovingRows>& shared, const Scene& scene, const BuildOptions& options,
                         Progress& progress);

}  // namespace sightlines::voxel_rows
