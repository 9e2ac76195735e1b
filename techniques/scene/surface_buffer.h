// What the camera sees: the surface under each pixel. Every technique and the reference start from the same one.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/base/types.h"
#include "techniques/scene/scene.h"

namespace sightlines {

constexpr std::uint32_t no_triangle = 0xffffffffu;

/// One sample in the middle of each pixel, row-major, top row first. [P] = width * height.
/// Where triangle[p] == no_triangle the camera sees the background and the rest is zero.
struct SurfaceBuffer {
    ImageSize size{0, 0};
    Camera camera;                        ///< that sees it
    std::vector<vec3> position;           ///< [P] m, world
    std::vector<vec3> normal;             ///< [P] unit geometric normal, turned towards the camera
    std::vector<vec3> shading_normal;     ///< [P] unit interpolated normal, on the same side as `normal`
    std::vector<vec3> albedo;             ///< [P] linear diffuse reflectance
    std::vector<vec3> emission;           ///< [P] radiance
    std::vector<std::uint32_t> triangle;  ///< [P]
    std::vector<vec2> gloss{};            ///< [P] the material's roughness and metalness; empty: 1 and 0
};

/// A half-open rectangle of pixels.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(const PixelRect&) const = default;
};

/// A ray asked by a technique: from a surface point towards a light.
struct Segment {
    vec3 origin{0.0f};  ///< m, on the surface
    vec3 target{0.0f};  ///< m, the light
};

}  // namespace sightlines
