// Built-in scenes that are made once, on first use, and only posed for each moment.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "techniques/scene/builtin_mesh.h"

namespace sightlines {

/// A part that moves rigidly: its triangles in a frame of their own, and where its vertices are in the scene.
struct RigidPart {
    std::uint32_t part = 0, first_vertex = 0;
    std::shared_ptr<const Mesh> mesh;
};

/// Adds a part that will be placed anew for each moment.
RigidPart add_rigid_part(Scene& scene, std::shared_ptr<const Mesh> mesh, const std::string& name,
                         std::uint32_t mesh_number);

/// Puts the part where it is now. `world_from_part` is rigid or evenly scaling.
void place_part(Scene& scene, const RigidPart& rigid, const mat4& world_from_part);

/// A scene at rest, and what happens to a copy of it at `time_s`: `pose` moves vertices of the parts that are marked as
/// moving or deforming, and lights and textures; nothing else. It may be called by several threads at once.
struct PosableScene {
    Scene rest;
    std::function<void(Scene& scene, double time_s)> pose;
    std::optional<Box3> reach;  ///< holds what is animated at all times; unset: found by posing at many times
};

/// `make` is called once, by the first thread that asks; copies of the model share what it made. Bounds and
/// motion_bounds are filled in.
SceneModel posed_model(const std::string& name, const std::string& about, double duration_s,
                       std::function<PosableScene()> make);

/// Adds meshes as parts that stay where they are, one mesh number for all instances of a mesh.
struct PartBuilder {
    Scene& scene;
    std::uint32_t meshes = 0;

    void add(const Mesh& mesh, const std::string& name, const std::vector<mat4>& places);
    void add(const Mesh& mesh, const std::string& name);
    /// Parts that move, `count` instances of the mesh.
    std::vector<RigidPart> add_rigid(Mesh mesh, const std::string& name, int count);
};

}  // namespace sightlines
