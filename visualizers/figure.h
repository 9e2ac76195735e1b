// Figures to take home: a picture for a slide (PNG), a page for a paper (SVG, PDF), the data for ParaView (VTK).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "visualizers/canvas.h"
#include "visualizers/inside_view.h"
#include "visualizers/voxel_row_view.h"

namespace sightlines {

enum class FigureFormat { png, svg, pdf, vtk };

/// "png", "svg", "pdf" or "vtk"; InputError for another, naming them.
FigureFormat parse_figure_format(const std::string& text);

struct FigureOptions {
    FigureFormat format = FigureFormat::png;
    float dpi = 200.0f;       ///< of a PNG, and of the rendered picture inside SVG and PDF; 36 to 1200
    float width_mm = 180.0f;  ///< a paper's two columns; the height follows
};

/// The view inside with the row as a strip of bits below (Wang 2017, Figure 4), the verdict, and the legend, as the
/// bytes of a PNG, SVG or PDF. Same input, same bytes. InputError where the size is out of range.
std::vector<std::uint8_t> voxel_row_figure(VoxelRowView& view, const VoxelRowPicture& picture, const ViewState& state,
                                           CanvasFormat format, const FigureOptions& options);

/// The voxels before compression, with the row's differing bits in frames, and the panel of the dictionary below.
std::vector<std::uint8_t> dictionary_figure(VoxelRowView& view, const DictionaryPicture& picture,
                                            const ViewState& state, CanvasFormat format, const FigureOptions& options);

/// The ray in the scene, and below it the maps that it was looked up in.
std::vector<std::uint8_t> ray_figure(RayView& view, const RayPicture& picture, const ViewState& state,
                                     CanvasFormat format, const FigureOptions& options);

/// Writes the figure as `folder`/`name`.EXTENSION, or for VTK the pieces and voxel-row.vtm that names them, each whole
/// or not at all. Gives the files written, the one to open first. EnvironmentError where that is not possible,
/// InputError where the figure has no data for VTK.
std::vector<std::filesystem::path> write_figure(InsideView& view, const InsidePicture& picture, std::string_view name,
                                                const ViewState& state, const FigureOptions& options,
                                                const std::filesystem::path& folder);

}  // namespace sightlines
