#include "techniques/voxel_rows/moving_rows.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "techniques/base/parallel.h"
#include "techniques/scene/moving_parts.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::size_t most_spare = 1;

void copy_words(const HugeBuffer& from, const HugeBuffer& to, int threads, Progress& progress) {
    constexpr std::size_t piece = std::size_t{1} << 20u;  // words: 4 MiB
    const std::size_t pieces = (from.words.size() + piece - 1) / piece;
    parallel_for(static_cast<std::int64_t>(pieces), threads, [&](std::int64_t k) {
        progress.check();
        const std::size_t first = static_cast<std::size_t>(k) * piece;
        const std::size_t count = std::min(piece, from.words.size() - first);
        std::memcpy(&to.words[first], &from.words[first], count * sizeof(std::uint32_t));
    });
}

/// Spare rows, or new ones that equal the fixed.
ChangedRows take_rows(MovingRows& shared, const BuildOptions& options, Progress& progress) {
    {
        const std::lock_guard lock(shared.mutex);
        if (!shared.spare.empty()) {
            ChangedRows rows = std::move(shared.spare.back());
            shared.spare.pop_back();
            return rows;
        }
    }
    const HugeBuffer& fixed = shared.fixed.words;
    ChangedRows rows{options.allocate ? options.allocate(fixed.words.size()) : allocate_huge(fixed.words.size()), {}};
    copy_words(fixed, rows.words, options.threads, progress);
    return rows;
}

}  // namespace

Moment::~Moment() {
    if (!shared) return;
    const std::lock_guard lock(shared->mutex);
    if (shared->spare.size() < most_spare) shared->spare.push_back(std::move(rows));
}

std::shared_ptr<MovingRows> build_fixed(const Scene& scene, const BuildOptions& options, Progress& progress) {
    auto shared = std::make_shared<MovingRows>();
    shared->fixed = build_from_fragments(fixed_scene(scene), options, progress);
    return shared;
}

MomentArray build_moment(const std::shared_ptr<MovingRows>& shared, const Scene& scene, const BuildOptions& options,
                         Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    // Rows that a cancelled build leaves half changed are let go.
    ChangedRows rows = take_rows(*shared, options, progress);
    RowArray array;
    array.grid = shared->fixed.grid;
    array.words = rows.words;
    array.fragments = shared->fixed.fragments;
    if (!rows.touched.empty()) restore_slices(array, shared->fixed, rows.touched, options.threads);
    rows.touched = splat_onto(array, changing_scene(scene), options, progress);
    array.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return {std::move(array), Moment(shared, std::move(rows))};
}

}  // namespace sightlines::voxel_rows
