// Embree: the ground truth of every error metric and the opponent of every benchmark.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/scene/moving_parts.h"
#include "techniques/scene/scene.h"
#include "techniques/scene/surface_buffer.h"

namespace sightlines {

/// reference: ROBUST, high quality; benchmark: without ROBUST, whatever was measured to be fastest.
enum class EmbreeUse { reference, benchmark };

struct EmbreeScene;  // hides Embree's handles; immutable, shared between threads

/// The tree over all triangles. Alpha-masked ones have holes where their texture says so, for both uses; blended ones
/// count as opaque. Keeps copies of what it needs: the Scene may go before it does. A scene without triangles gives a
/// tree that nothing hits. `parts`: of these alone, as if the scene held nothing else. EnvironmentError where Embree
/// fails or memory runs out.
std::shared_ptr<const EmbreeScene> build_embree_scene(const Scene& scene, EmbreeUse use, int threads,
                                                      Progress& progress, PartChoice parts = PartChoice::all);

/// The tree of one moment of a scene that moves: over `fixed`, the tree of its parts that never change (of any moment),
/// and over the parts that do, for which alone a tree of the same use is built. Rays are answered as by the tree of
/// all, but for which of two surfaces in one place is hit; they take a little longer. Throws as build_embree_scene
/// does.
std::shared_ptr<const EmbreeScene> build_moment_tree(const Scene& scene, std::shared_ptr<const EmbreeScene> fixed,
                                                     int threads, Progress& progress);

struct Hit {
    float distance_m = 0.0f;
    std::uint32_t triangle = no_triangle;
    vec2 barycentric{0.0f};
};

/// The nearest surface along origin + t direction, t in (0, farthest_m).
std::optional<Hit> closest_hit(const EmbreeScene& scene, vec3 origin, vec3 direction, float farthest_m);

/// What a ray hits, as a surface.
struct SurfaceAt {
    vec3 position{0.0f};        ///< m
    vec3 normal{0.0f};          ///< unit geometric normal, turned against the ray
    vec3 shading_normal{0.0f};  ///< unit interpolated normal, on the same side
    vec3 albedo{0.0f};       ///< linear diffuse reflectance; a metal keeps half of its colour (it would be black else)
    vec3 emission{0.0f};     ///< radiance
    vec2 gloss{1.0f, 0.0f};  ///< roughness and metalness
};
SurfaceAt surface_at(const Scene& scene, const Hit& hit, vec3 ray_direction);

/// Whether anything lies between the two points: exactly the ray that the reference asks. `normal` is the surface's at
/// the origin (unit, turned towards the camera): the ray leaves the surface 1e-5 of the scene's extent along it, and
/// stops 1e-5 of its own length short of the target.
bool occluded(const EmbreeScene& scene, const Segment& segment, vec3 normal);

/// Primary visibility: what the camera sees under each pixel's middle, by packets of 16. `scene` is the one that the
/// tree was built from.
SurfaceBuffer visible_surfaces(const Scene& scene, const EmbreeScene& embree, const Camera& camera, ImageSize size,
                               int threads, Progress& progress);

/// The world-space ray through the point (x, y) of the picture, in pixels, (0, 0) the top left corner.
Segment camera_ray(const Camera& camera, ImageSize size, vec2 pixel, float length_m);

}  // namespace sightlines
