// A glTF file ready to be shown at any moment: all that stays in memory, and nothing of the file's own format.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "techniques/scene/animation.h"
#include "techniques/scene/gltf_meshes.h"
#include "techniques/scene/scene.h"

namespace sightlines {

struct GltfNode {
    std::string name;
    int parent = -1;
    std::optional<mat4> matrix;  ///< else translation * rotation * scale
    vec3 translation{0.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
    vec3 scale{1.0f};
    int mesh = -1, skin = -1, camera = -1, light = -1;
    std::vector<float> weights;  ///< empty: the mesh's
    bool visible = false;        ///< reached from the scene's roots
    bool moves = false;          ///< it or a node above it is animated
    bool morphs = false;         ///< its weights are animated
};

struct GltfSkin {
    std::vector<std::uint32_t> joints;  ///< nodes
    std::vector<mat4> joint_from_mesh;  ///< [joints], the inverse bind matrices
};

enum class NodeProperty { translation, rotation, scale, weights };

struct GltfChannel {
    std::uint32_t node = 0;
    NodeProperty property = NodeProperty::translation;
    AnimationCurve curve;
};

/// One visible node's mesh.
struct GltfInstance {
    std::uint32_t node = 0, mesh = 0;
    int skin = -1;            ///< -1 also where the mesh has no joints
    std::uint32_t shape = 0;  ///< Part::mesh: equal where the same vertices move rigidly
    bool deforms = false;
};

/// Immutable once loaded; scenes at different moments are made from it on any thread.
struct GltfScene {
    std::string file, name;
    std::vector<GltfNode> nodes;
    std::vector<std::uint32_t> parents_first;  ///< all nodes, each after its parent
    std::vector<GltfMesh> meshes;
    std::vector<GltfSkin> skins;
    std::vector<GltfInstance> instances;
    std::vector<GltfChannel> channels;
    double duration_s = 0.0;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Camera> cameras;            ///< lens and name only; the node places them
    std::vector<Light> lights;              ///< colour, intensity and cone only
    std::vector<Camera> automatic_cameras;  ///< where the file has none: those at time 0, at all times
    Box3 moving_bounds;                     ///< gltf_moving_bounds of this; empty until it has been asked
    std::vector<std::string> notes;
};

/// Everything in the world at `time_s` (looped). InputError where the nodes carry a vertex out of range.
Scene gltf_scene_at(const GltfScene& model, double time_s);

/// What moving and deforming instances reach, at 32 even times and 2 % about; empty where nothing moves.
Box3 gltf_moving_bounds(const GltfScene& model);

}  // namespace sightlines
