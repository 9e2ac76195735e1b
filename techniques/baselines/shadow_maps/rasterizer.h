// A software rasteriser for shadow maps: depth only, 16 triangles at a time while they are set up, 16 texels at a time
// while they are drawn.
#pragma once

#include <span>
#include <vector>

#include "shaders/shadow_map_data.h"
#include "techniques/base/progress.h"
#include "techniques/scene/scene.h"

namespace sightlines::baselines {

constexpr std::size_t cluster_triangles = 128;

/// The scene's triangles along a Morton curve, in clusters that are culled as one. Padded to whole clusters by
/// triangles without area.
struct TriangleClusters {
    std::vector<float> corners[3][3];  ///< [corner][axis][padded T], m
    std::vector<Box3> bounds;          ///< [clusters]
    std::size_t triangles = 0;

    std::size_t bytes() const { return corners[0][0].size() * 9 * sizeof(float) + bounds.size() * sizeof(Box3); }
};

TriangleClusters make_clusters(const Scene& scene, Progress& progress);

/// Texels first .. last of a map, inclusive; empty where first > last.
struct MapRect {
    int first_x = 0, first_y = 0, last_x = -1, last_y = -1;

    bool empty() const { return first_x > last_x || first_y > last_y; }
    void add(const MapRect& other);
};

/// Draws one map of the light; what lies outside `rect` is not valid afterwards. A texel holds the nearness of the
/// nearest surface that its middle sees, of either side; 0 where there is none. A texel on an edge between two
/// triangles is drawn by both. `numbers`: the map's, [resolution * pitch].
void rasterize(const TriangleClusters& clusters, const ShadowMapShape& shape, int map, MapRect rect,
               std::span<float> numbers, const Progress& progress);

}  // namespace sightlines::baselines
