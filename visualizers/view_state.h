// How the view inside is looked at: a plain value, part of the session. The mouse edits it through the functions below;
// there is no other state.
#pragma once

#include <optional>

#include "techniques/base/types.h"

namespace sightlines {

enum class Theme { light, dark, print };  ///< print: as light, on nothing (transparent), darker ink

/// A camera that circles a point, upright. Vertical field of view: `view_field_of_view_deg`.
struct OrbitCamera {
    vec3 focal_point{0.0f};      ///< m
    float azimuth_deg = 0.0f;    ///< about +Y; 0 looks from +Z, 90 from +X
    float elevation_deg = 0.0f;  ///< above the horizon, -89 to 89
    float distance_m = 10.0f;    ///< from the focal point

    bool operator==(const OrbitCamera&) const = default;
};

/// Narrow, so that far cells of a row are nearly as large as near ones.
constexpr float view_field_of_view_deg = 20.0f;

/// Which voxels stand between the eye and the row.
enum class CutAway {
    none,    ///< all voxels are drawn (the scene is cut open all the same)
    to_row,  ///< those on the camera's side of the row are taken away, and those beyond a slab behind it
};

constexpr int most_merged_samples = 10'000'000;

/// What is shown and how. The default is the figure as it is meant: framed automatically, cut open along the row.
struct ViewState {
    std::optional<OrbitCamera> camera;  ///< none: framed automatically, the row across the picture
    Theme theme = Theme::light;
    bool scene = true;   ///< the mesh, ghosted
    bool voxels = true;  ///< the voxelization's surface
    bool row = true;     ///< the bar of bits
    bool extent = true;  ///< [s, e]
    bool ray = true;     ///< as asked
    bool twin = true;    ///< the row's direction through the ray's midpoint, and the angle between the two
    bool labels = true;  ///< text, orientation marker, scale bar
    CutAway cut_away = CutAway::to_row;
    int slab_voxels = 10;   ///< how many layers of voxels stay behind the row, at least 1
    int slice_first = 0;    ///< voxels with slice_first <= u <= slice_last are drawn (the row always is)
    int slice_last = 1023;  ///< clamped to the resolution
    int merged_samples = most_merged_samples;  ///< of a cell's point samples, those merged so far; clamped to them

    bool operator==(const ViewState&) const = default;
};

/// Each takes the camera as shown now (framed automatically or not) and gives the state to show next.
/// The scene turns with the hand: +x to the right, +y downwards, as the mouse moves.
ViewState turned(ViewState state, const OrbitCamera& shown, vec2 drag_deg);
/// `factor` > 1 comes nearer.
ViewState zoomed(ViewState state, const OrbitCamera& shown, float factor);
/// Moves the picture by `drag_pixels` of a view `height_pixels` high.
ViewState panned(ViewState state, const OrbitCamera& shown, vec2 drag_pixels, int height_pixels);
/// Back to automatic framing; what is shown stays as it is.
ViewState reframed(ViewState state);
/// Moves the slice range by `voxels`, keeping its length, within [0, resolution).
ViewState sliced(ViewState state, int voxels, int resolution);

}  // namespace sightlines
