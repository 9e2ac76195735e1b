// A scene divided by how its parts move: what stands still, what moves rigidly, what deforms.
#pragma once

#include <vector>

#include "techniques/scene/scene.h"

namespace sightlines {

/// Whether any part of the scene moves or deforms.
bool anything_moves(const Scene& scene);

/// Which parts of a scene are meant: all, those that never change, or those that move or deform.
enum class PartChoice { all, fixed, changing };

/// Whether each triangle belongs to these parts, [T].
std::vector<std::uint8_t> triangles_of(const Scene& scene, PartChoice parts);

/// The box round all moments of the scene: `motion_bounds` and what lies outside them now.
Box3 bounds_of_motion(const Scene& scene);

/// Boxes round what moves or deforms, at this moment: one for each part, or for several where there are more than
/// `most`.
std::vector<Box3> changing_boxes(const Scene& scene, std::size_t most);

/// A scene of the triangles of some parts only: positions, triangles and materials without textures, no normals and no
/// texture coordinates. Bounds are those of what is left; `motion_bounds` stays that of the whole.
Scene fixed_scene(const Scene& scene);     ///< of the parts that never change
Scene changing_scene(const Scene& scene);  ///< of the parts that move or deform

/// Parts that share a mesh and move rigidly (Wang 2017, Algorithm 5: a type of object and its instances).
struct RigidObject {
    std::uint32_t mesh = 0;
    std::vector<std::uint32_t> parts;  ///< of the scene, at least one
};
std::vector<RigidObject> rigid_objects(const Scene& scene);

/// The object in its own space, in metres: the mesh of its first part, as `changing_scene` holds it.
Scene object_scene(const Scene& scene, const RigidObject& object);

}  // namespace sightlines
