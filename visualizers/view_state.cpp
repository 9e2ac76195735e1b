#include "visualizers/view_state.h"

#include <algorithm>
#include <cmath>

#include "visualizers/view_camera.h"

namespace sightlines {

ViewState turned(ViewState state, const OrbitCamera& shown, vec2 drag_deg) {
    OrbitCamera camera = shown;
    camera.azimuth_deg = std::remainder(shown.azimuth_deg - drag_deg.x, 360.0f);
    camera.elevation_deg = std::clamp(shown.elevation_deg + drag_deg.y, -89.0f, 89.0f);
    state.camera = camera;
    return state;
}

ViewState zoomed(ViewState state, const OrbitCamera& shown, float factor) {
    OrbitCamera camera = shown;
    camera.distance_m = std::clamp(shown.distance_m / std::max(factor, 1e-3f), 1e-2f, 1e6f);
    state.camera = camera;
    return state;
}

ViewState panned(ViewState state, const OrbitCamera& shown, vec2 drag_pixels, int height_pixels) {
    const ViewCamera view = view_camera(shown, {height_pixels, height_pixels});
    const vec2 drag_m = drag_pixels * metres_per_pixel(view, shown.distance_m);
    OrbitCamera camera = shown;
    camera.focal_point += -drag_m.x * view.right + drag_m.y * view.up;
    state.camera = camera;
    return state;
}

ViewState reframed(ViewState state) {
    state.camera.reset();
    return state;
}

ViewState sliced(ViewState state, int voxels, int resolution) {
    const int first = std::clamp(state.slice_first, 0, resolution - 1);
    const int last = std::clamp(state.slice_last, first, resolution - 1);
    const int step = std::clamp(voxels, -first, resolution - 1 - last);
    state.slice_first = first + step;
    state.slice_last = last + step;
    return state;
}

}  // namespace sightlines
