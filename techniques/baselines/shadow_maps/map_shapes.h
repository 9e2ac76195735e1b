// What the maps of one light look like, for conventional and for imperfect maps.
#pragma once

#include "shaders/lighting_data.h"
#include "shaders/shadow_map_data.h"
#include "techniques/base/types.h"
#include "techniques/scene/scene.h"

namespace sightlines::baselines {

/// The largest share of memory that maps may take at once, bytes: maps of further lights wait.
constexpr std::size_t maps_at_once_bytes = std::size_t{128} << 20u;

/// How the parameters want the maps of every light.
struct MapOptions {
    int resolution = 128;
    float normal_offset = 1.0f, depth_bias = 1.0f;  ///< sizes of a texel
    float blur_m = 0.0f;                            ///< ShadowMapShape::blur_m
};

/// `bounds` may be empty: a metre about the origin then. Rows are padded to 16 texels, so that rasterisers may write
/// whole vectors.
ShadowMapShape map_shape(const LightRecord& light, const Box3& bounds, const MapOptions& options);

/// How many lights' maps, of `maps` each, fit into maps_at_once_bytes: 1 to 64.
std::uint32_t lights_at_once(int resolution, int maps);

/// Where the blocker that a texel holds lies, m.
vec3 held_point(const ShadowMapShape& shape, int map, int column, int line, float held, bool paraboloids);

}  // namespace sightlines::baselines
