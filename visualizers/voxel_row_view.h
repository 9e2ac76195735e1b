// The view inside of voxel rows: the voxelization that serves a ray, cut open along the row, with the row's bits, the
// extent, the ray and its discretised twin (Wang 2017, Figures 3 and 4). Without a display; the same for window and
// page.
#pragma once

#include <memory>
#include <optional>

#include "techniques/base/image.h"
#include "visualizers/view_state.h"
#include "visualizers/voxel_row_picture.h"

namespace sightlines {

/// Keeps the geometry on the graphics side between frames, so that turning the view only redraws. Used by one thread at
/// a time. Holds no state that a picture depends on: same input, same pixels, whatever was drawn before.
struct VoxelRowView {
    struct Objects;
    std::unique_ptr<Objects> objects;

    /// EnvironmentError where there is no OpenGL.
    VoxelRowView();
    ~VoxelRowView();
    VoxelRowView(VoxelRowView&&) noexcept;
    VoxelRowView& operator=(VoxelRowView&&) noexcept;
};

/// The camera that is in force: the state's own, or the automatic one, which puts the kept part of the row and the ray
/// across the picture, from left (s) to right (e), seen from a little above and aside.
OrbitCamera shown_camera(const VoxelRowPicture& picture, const ViewState& state, ImageSize size);

/// The solid part of the view: ghosted scene, voxels, row. Straight (not premultiplied) sRGB with alpha, clear where
/// there is nothing. `samples_per_axis` squared samples a pixel: 1 while a mouse drags, 2 at rest, 3 for print.
ImageRgba8 render_solid(VoxelRowView& view, const VoxelRowPicture& picture, const ViewState& state, ImageSize size,
                        int samples_per_axis);

/// What a window shows: the solid part on the theme's background (none for Theme::print) and the marks on top, with
/// verdict and legend in a corner.
/// `text_scale` is the height of body text over 12 pixels.
ImageRgba8 render(VoxelRowView& view, const VoxelRowPicture& picture, const ViewState& state, ImageSize size,
                  int samples_per_axis, float text_scale = 1.0f);

/// The voxel that is drawn under the pixel position (0, 0 is the top left corner of the picture), or nothing. Needs no
/// window. Voxels of the row count where the row is shown; those of objects that move hide what is behind them, and are
/// not picked themselves.
std::optional<ivec3> pick(const VoxelRowPicture& picture, const ViewState& state, ImageSize size, vec2 pixel);

}  // namespace sightlines
