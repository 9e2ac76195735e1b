// What the view inside shows: one voxelization, the row in it that serves a ray, and the scene around them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "techniques/scene/scene.h"
#include "techniques/scene/surface_buffer.h"

namespace sightlines {

struct VoxelRowPicture;

/// An object that moves, which the ray was asked of besides what stands still, where it is at its moment.
struct ObjectPicture {
    std::string name;                             ///< "instance 2"
    std::vector<vec3> bounds;                     ///< a box: a corner and three edges, world, m
    bool blocked = false;                         ///< the object is in the way
    std::shared_ptr<const VoxelRowPicture> rows;  ///< its voxels and its row, without scene; null: the ray passes it by
};

/// Voxel (u, v, w) is occupied[(w * N + v) * N + u] != 0; u runs along the row. The scene and the occupancy are
/// immutable: a view rebuilds what depends on them when another object is handed in, never otherwise.
struct VoxelRowPicture {
    std::shared_ptr<const Scene> scene;                         ///< ghosted behind; may be null
    int resolution = 0;                                         ///< N, at least 1
    std::shared_ptr<const std::vector<std::uint8_t>> occupied;  ///< [N^3]
    mat4 world_from_voxels{1.0f};                               ///< from (u, v, w) in [0, N]^3; affine, m
    int v = 0, w = 0;                                           ///< the row
    int first = 0, last = -1;                                   ///< voxels kept, inclusive; first > last: none
    Segment ray;                                                ///< from the surface to the light
    vec3 row_direction{1.0f, 0.0f, 0.0f};                       ///< unit, world; either sign
    float angular_error_deg = 0.0f;                             ///< between the ray and the row
    float theta_deg = 0.0f, phi_deg = 0.0f;                     ///< the discretised direction
    bool blocked = false;                                       ///< the verdict of the row and of the objects
    std::optional<bool> truly_blocked;                          ///< Embree's verdict, where it was asked
    std::vector<ObjectPicture> objects;                         ///< in the order in which they were asked
};

/// Whether voxel (u, v, w) is set. The indices must be inside.
inline bool is_set(const VoxelRowPicture& picture, ivec3 voxel) {
    const auto n = static_cast<std::size_t>(picture.resolution);
    return (*picture.occupied)[(static_cast<std::size_t>(voxel.z) * n + static_cast<std::size_t>(voxel.y)) * n +
                               static_cast<std::size_t>(voxel.x)] != 0;
}

/// Length of one voxel along each axis, m.
inline vec3 voxel_size_m(const VoxelRowPicture& picture) {
    const mat4& m = picture.world_from_voxels;
    return {glm::length(vec3(m[0])), glm::length(vec3(m[1])), glm::length(vec3(m[2]))};
}

/// The world position of a point in voxel coordinates.
inline vec3 world_point(const VoxelRowPicture& picture, vec3 voxels) {
    return vec3(picture.world_from_voxels * vec4(voxels, 1.0f));
}

/// The twin: the row's direction through the ray's midpoint, as long as the ray and pointing the same way.
inline Segment twin_of(const VoxelRowPicture& picture) {
    const vec3 along = picture.ray.target - picture.ray.origin;
    const vec3 middle = 0.5f * (picture.ray.origin + picture.ray.target);
    const float sign = glm::dot(along, picture.row_direction) < 0.0f ? -1.0f : 1.0f;
    const vec3 half = sign * 0.5f * glm::length(along) * picture.row_direction;
    return {middle - half, middle + half};
}

}  // namespace sightlines
