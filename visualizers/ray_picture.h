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
};

/// A four-sided patch: 0 visible, 1 occluded, between them both.
struct ValuedPatch {
    std::array<vec3, 4> corners{};  ///< in order, m
    float value = 0.0f;

    bool operator==(const ValuedPatch&) const = default;
};

/// A flat map with the texel that the ray asked.
struct PictureMap {
    std::string title;
    int side = 0;               ///< texels
    std::vector<float> values;  ///< [side][side] in [0, 1], pale to strong; row 0 is at the top
    std::optional<ivec2> asked;
};

struct RayPicture {
    std::shared_ptr<const Scene> scene;                   ///< ghosted
    std::shared_ptr<const std::vector<ValuedBox>> boxes;  ///< may be null
    std::string boxes_title;                              ///< what they are, for the legend
    bool boxes_graded = false;                            ///< their values differ
    std::vector<ValuedPatch> patches;                     ///< a cell's directions, on a sphere about it; never cut away
    std::vector<PictureMap> maps;
    std::vector<TraceGeometry> recorded;  ///< of all steps, each once, drawn thinly
    Segment ray;
    std::string end_name = "light";  ///< of what the ray goes to
    bool blocked = false;
    std::optional<bool> truly_blocked;  ///< Embree's verdict, where it was asked
};

}  // namespace sightlines
