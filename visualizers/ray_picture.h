// What the view of a ray shows, of any technique: the scene cut open along the ray, the cells that the technique keeps
// of it, and the maps that the ray was looked up in.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shaders/trace.h"
#include "techniques/scene/scene.h"
#include "techniques/scene/surface_buffer.h"

namespace sightlines {

/// A cell of the technique's own data. `value` in [0, 1] is shown from pale to strong.
struct ValuedBox {
    Box3 box;  ///< m
    float value = 0.0f;
    ivec3 place{0};  ///< in the technique's grid; what picking it gives
};

/// A four-sided patch: 0 visible, 1 occluded, between them both.
struct ValuedPatch {
    std::array<vec3, 4> corners{};  ///< in order, m
    float value = 0.0f;

    bool operator==(const ValuedPatch&) const = default;
};

/// A flat map with the texel that the ray asked, or the first of a block of them.
struct PictureMap {
    std::string title;
    ivec2 size{0};              ///< texels across and down
    std::vector<float> values;  ///< [size.y][size.x] in [0, 1], pale to strong; row 0 is at the top
    std::optional<ivec2> asked;
    int asked_side = 1;  ///< texels along a side of that block
};

/// A point sample of a cell, and what it sees by itself.
struct CellSample {
    vec3 position{0.0f}, normal{0.0f};            ///< m; unit
    std::vector<std::uint8_t> visible, occluded;  ///< [side][side], 0 or 1
};

struct RayPicture {
    std::shared_ptr<const Scene> scene;                   ///< ghosted
    std::shared_ptr<const std::vector<ValuedBox>> boxes;  ///< may be null
    std::string boxes_title;                              ///< what they are, for the legend
    bool boxes_graded = false;                            ///< their values differ
    bool boxes_whole = false;                             ///< cells before the ray are shown too
    std::vector<ValuedPatch> patches;                     ///< a cell's directions, on a sphere about it; never cut away
    std::optional<Box3> cell;                             ///< whose directions they are
    std::vector<PictureMap> maps;
    float maps_share = 0.3f;  ///< of the view's height, that the maps may take
    /// Of `cell`, in the order in which they are merged; null where the view does not show that. Then `maps` are the
    /// latest sample's masks and those merged so far (merged_until).
    std::shared_ptr<const std::vector<CellSample>> samples;
    std::vector<TraceGeometry> marked, pointed;  ///< drawn over the view, thin and strong
    std::optional<Box3> focus;                   ///< what the automatic camera frames; else the ray
    std::vector<TraceGeometry> recorded;         ///< of all steps, each once, drawn thinly
    Segment ray;
    std::string end_name = "light";  ///< of what the ray goes to
    bool blocked = false;
    std::optional<bool> truly_blocked;  ///< Embree's verdict, where it was asked
};

}  // namespace sightlines
