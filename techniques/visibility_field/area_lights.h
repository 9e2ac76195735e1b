// Local area lights (Xu 2022, section 6: "not supported because the DVFs store visibility about the environment"):
// surfaces that shine by themselves light the others directly. Each pixel draws points on them and asks the segments to
// them, of which the cells cull those that they know (area_sight.h).
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

struct AreaSight;

/// A triangle that shines.
struct AreaTriangle {
    std::uint32_t triangle = 0;           ///< of the scene
    std::uint32_t part = 0;               ///< of the lights that it belongs to
    vec3 corner{0.0f}, u{0.0f}, v{0.0f};  ///< m; the first corner and the edges from it
    vec3 normal{0.0f};                    ///< unit, of its front
    bool both_sides = false;              ///< else it shines to its front only
    float until = 0.0f;                   ///< the share of all power that it and those before it send
    float per_m2 = 0.0f;                  ///< how densely points are drawn on it, of one point in all
};

/// All triangles of a scene that shine. Points are drawn on them by the power that they send, evenly over each.
struct AreaLights {
    std::vector<AreaTriangle> triangles;  ///< by their number in the scene
    std::vector<vec2> parts;              ///< at most most_light_parts: from and until which share of power each goes
};

constexpr std::size_t most_light_parts = 64;

/// A point of a light.
struct AreaPoint {
    std::uint32_t at = 0;    ///< of AreaLights::triangles
    vec2 barycentric{0.0f};  ///< as a Hit's
    vec3 position{0.0f};     ///< m
};

/// From a surface to a point of a light.
struct AreaSegment {
    vec3 direction{0.0f};  ///< unit
    float distance_m = 0.0f;
    float cosine_there = 0.0f;  ///< from the light's normal
    vec3 end{0.0f};             ///< where the ray ends, lift_m off the light
    bool faces = false;         ///< each is in front of the other, and a ray fits between them
};

/// The lights of the scene: triangles with an area whose emission is not black, on average over as many points as the
/// triangle has texels.
AreaLights find_area_lights(const Scene& scene);

/// Radiance of a triangle's point, W/(sr m^2); black in the holes of a masked material.
vec3 emission_at(const Scene& scene, std::uint32_t triangle, vec2 barycentric);

/// By how much a pixel shifts the Hammersley points that it draws points of the lights by: blue noise.
vec2 point_shift(const EnvironmentRequest& request, std::size_t pixel);

/// The point that is drawn by two numbers in [0, 1). There must be lights.
AreaPoint draw_point(const AreaLights& lights, vec2 numbers);

/// `normal` (unit, geometric): of the surface, on the side that is lit. `lift_m`: as of rays from surfaces.
AreaSegment segment_to(const AreaLights& lights, const AreaPoint& point, vec3 position, vec3 normal, float lift_m);

/// Adds what `samples` points of the scene's lights (find_area_lights) for each pixel bring to the irradiance and
/// radiance of `result`, and the segments' rays to its pictures and counts of area rays. Without lights nothing
/// happens. `field` and `sight` (both or neither null; the sight of the same lights): which segments need no ray.
void add_area_lights(const VisibilityField* field, const AreaSight* sight, const EmbreeScene& embree,
                     const Scene& scene, const AreaLights& lights, const EnvironmentRequest& request, int samples,
                     EnvironmentResult& result, Progress& progress);

}  // namespace sightlines::visibility_field
