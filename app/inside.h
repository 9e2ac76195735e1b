// What a view inside shows, taken out of a session's results.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "app/selection.h"
#include "visualizers/inside_view.h"

namespace sightlines {

/// A figure that `sightlines figure` makes.
struct FigureRow {
    std::string_view name;       ///< "voxel-row"
    std::string_view title;      ///< "Row of voxels"
    std::string_view technique;  ///< whose inside it shows; empty: any
    bool compressed = false;     ///< only of a structure that is compressed
    std::string_view about;      ///< one sentence
};

/// The explicit list of figures.
std::span<const FigureRow> figures();

/// InputError offers the nearest name.
const FigureRow& find_figure(std::string_view name);

/// Whether what is shown depends on the cell that is picked in the view (selection.voxel).
bool shows_cells(const Session& session);

/// Whether the session's technique, with its parameters, has what the figure shows.
bool can_show(const FigureRow& figure, const Session& session);

/// The figure that the view inside shows: that of the first open view, else the technique's first; empty where it has
/// none.
std::string_view shown_figure(const Session& session);

/// From now on the view inside shows that figure, as it was looked at last.
void show_figure(Session& session, std::string_view figure);

/// The voxelizations that were shown last, unpacked: another ray of the same direction shares the object, and the view
/// that shows it makes nothing anew. Keeps no structure alive.
struct UnpackedVoxels {
    struct Direction {
        std::weak_ptr<const Made<BuiltStructure>> structure;
        int direction = 0;
        bool uncompressed = false;  ///< as it was before it was compressed
        std::shared_ptr<const std::vector<std::uint8_t>> occupied;
    };
    std::vector<Direction> latest;  ///< newest first, at most 4
    std::weak_ptr<const Made<BuiltStructure>> summarised;
    std::shared_ptr<const DictionarySummary> summary;  ///< of that structure
    std::weak_ptr<const Made<BuiltStructure>> boxed;
    std::shared_ptr<const std::vector<ValuedBox>> boxes;  ///< of that structure, for ray_picture
};

/// The voxelization that serves the ray, with the scene around it. The session's technique must be voxel_rows.
VoxelRowPicture voxel_row_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                                  UnpackedVoxels& unpacked);

/// The same before it was compressed, and what compression made of the row. The structure must be compressed.
DictionaryPicture dictionary_picture(const Session& session, const SelectedRay& ray, Results& results,
                                     Progress& progress, UnpackedVoxels& unpacked);

/// The ray in the scene, with what the technique keeps of it: occupied voxels, maps of its light. Any technique.
RayPicture ray_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                       UnpackedVoxels& unpacked);

/// What shown_figure(session), which must not be empty, shows.
InsidePicture inside_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                             UnpackedVoxels& unpacked);

/// How the session looks at that figure: its first open view of it, else the default.
ViewState view_state(const Session& session, std::string_view figure);

}  // namespace sightlines
