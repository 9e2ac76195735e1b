// Smooth bodies: round cones melted into one surface. For animals.
#pragma once

#include <functional>
#include <span>

#include "techniques/scene/builtin_mesh.h"

namespace sightlines {

/// The hull of two balls; one ball where both ends are the same.
struct RoundCone {
    vec3 from{0.0f}, to{0.0f};
    float from_radius = 0.1f, to_radius = 0.1f;
    std::uint32_t bone = 0;  ///< what it moves with
};

/// Distance to the round cone's surface, m, negative inside (to within the cone's taper).
float distance_to(const RoundCone& cone, vec3 point);

/// The surface of all cones together, neighbours melting into each other over `blend_m`, in cells of `cell_m`: one
/// closed mesh, its vertices shared, with smooth normals. `material_of` is asked at each triangle's middle.
Mesh blob_mesh(std::span<const RoundCone> cones, float blend_m, float cell_m,
               const std::function<std::uint32_t(vec3)>& material_of);

}  // namespace sightlines
