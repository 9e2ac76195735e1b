// The view of a ray: what every technique has that records its rays. Without a display; the same for window and page.
#pragma once

#include <memory>
#include <optional>

#include "visualizers/canvas.h"
#include "visualizers/ray_picture.h"
#include "visualizers/view_state.h"

namespace sightlines {

/// As VoxelRowView: for one thread at a time, no state that a picture depends on.
struct RayView {
    struct Objects;
    std::unique_ptr<Objects> objects;

    /// EnvironmentError where there is no OpenGL.
    RayView();
    ~RayView();
    RayView(RayView&&) noexcept;
    RayView& operator=(RayView&&) noexcept;
};

/// The state's own camera, or the automatic one: the ray across the picture, seen from a little above and aside.
OrbitCamera shown_camera(const RayPicture& picture, const ViewState& state, ImageSize size);

/// Ghosted scene and cells, without those that stand between the eye and the ray. As render_solid of voxel rows.
ImageRgba8 render_solid(RayView& view, const RayPicture& picture, const ViewState& state, ImageSize size,
                        int samples_per_axis);

/// What the steps have touched, the ray, orientation, scale, verdict. Into (0, 0) to `size` of the canvas.
void draw_ray_marks(Canvas& canvas, const RayPicture& picture, const ViewState& state, ImageSize size,
                    float text_scale);

/// The height that the maps take below a view of this size; 0 where there are none, or no room.
float map_panel_height(const RayPicture& picture, vec2 size, float text_height);

/// The maps side by side in `where`.
void draw_map_panel(Canvas& canvas, const RayPicture& picture, const ViewState& state, const Rectangle& where,
                    float text_height);

/// The place of the nearest cell under a pixel of the part in space.
std::optional<ivec3> pick(const RayPicture& picture, const ViewState& state, ImageSize size, vec2 pixel);

}  // namespace sightlines
