// The view inside of whatever technique is shown: one alternative a technique, and the same handful of functions for
// all.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "shaders/trace.h"
#include "visualizers/dictionary_picture.h"
#include "visualizers/ray_view.h"
#include "visualizers/voxel_row_view.h"

namespace sightlines {

/// What a view inside shows; the alternatives are the explicit list of views.
using InsidePicture = std::variant<VoxelRowPicture, DictionaryPicture, RayPicture>;

/// The voxels of a picture of voxel rows; null for others.
const VoxelRowPicture* rows_in_space(const InsidePicture& picture);

/// The solid part of a view as it was drawn last, and what it was drawn from.
struct SolidDrawn {
    std::optional<InsidePicture> picture;
    ViewState state;
    ImageSize size;
    int samples_per_axis = 0;
    ImageRgba8 pixels;
};

/// Draws any of them. As VoxelRowView: one thread at a time, no state that a picture depends on. Where only the marks
/// differ from the last picture (the step, what is pointed at), only they are drawn again.
struct InsideView {
    std::optional<VoxelRowView> voxel_rows;  ///< made when first drawn with
    std::optional<RayView> rays;
    SolidDrawn latest;
};

/// Geometry of a recorded step, drawn over the view: what the current step touches and, stronger, what is pointed at.
struct LitGeometry {
    std::vector<TraceGeometry> step;     ///< of the current step
    std::vector<TraceGeometry> pointed;  ///< of the value under the mouse

    bool operator==(const LitGeometry&) const = default;
};

/// `text_scale`, here and below, is the height of body text over 12 pixels.
OrbitCamera shown_camera(const InsidePicture& picture, const ViewState& state, ImageSize size, float text_scale = 1.0f);
/// As render() of the technique's own view, with `lit` on top.
ImageRgba8 render(InsideView& view, const InsidePicture& picture, const ViewState& state, const LitGeometry& lit,
                  ImageSize size, int samples_per_axis, float text_scale);

/// Whether both are the same solid part: drawing one after the other draws only the marks anew.
bool same_solid(const InsidePicture& a, const InsidePicture& b);

/// A cell of the technique's own data as a box to be lit, with its place for a name.
TraceGeometry voxel_box(const VoxelRowPicture& picture, ivec3 voxel);

/// The voxels in which the own row and the dictionary's differ, as boxes.
std::vector<TraceGeometry> differing_voxels(const DictionaryPicture& picture);

/// What lies under a pixel of the view.
struct PickedInside {
    std::optional<ivec3> voxel;  ///< in the technique's own cells
    std::string geometry;  ///< the name of the recorded geometry nearest to the pixel ("ray", "row"); may be empty
};
/// `recorded` is the geometry of all steps of the ray; lines and points within 6 pixels count before voxels do, points
/// before lines. A voxel of the row that serves the ray is "extent" where the ray's extent keeps it, else "row".
PickedInside pick(const InsidePicture& picture, const ViewState& state, std::span<const TraceGeometry> recorded,
                  ImageSize size, vec2 pixel, float text_scale = 1.0f);

}  // namespace sightlines
