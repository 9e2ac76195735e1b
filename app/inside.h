// What a view inside shows, taken out of a session's results.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "app/selection.h"
#include "visualizers/voxel_row_picture.h"

namespace sightlines {

/// A figure that `sightlines figure` makes.
struct FigureRow {
    std::string_view name;       ///< "voxel-row"
    std::string_view technique;  ///< whose inside it shows
    std::string_view about;      ///< one sentence
};

/// The explicit list of figures.
std::span<const FigureRow> figures();

/// InputError offers the nearest name.
const FigureRow& find_figure(std::string_view name);

/// The voxelizations that were shown last, unpacked: another ray of the same direction shares the object, and the view
/// that shows it makes nothing anew. Keeps no structure alive.
struct UnpackedVoxels {
    struct Direction {
        std::weak_ptr<const Made<BuiltStructure>> structure;
        int direction = 0;
        std::shared_ptr<const std::vector<std::uint8_t>> occupied;
    };
    std::vector<Direction> latest;  ///< newest first, at most 4
};

/// The voxelization that serves the ray, with the scene around it. The session's technique must be voxel_rows.
VoxelRowPicture voxel_row_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress);
VoxelRowPicture voxel_row_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                                  UnpackedVoxels& unpacked);

/// How the session looks at that figure: its first open view of it, else the default.
ViewState view_state(const Session& session, std::string_view figure);

}  // namespace sightlines
