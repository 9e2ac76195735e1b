#include <algorithm>
#include <cmath>
#include <span>

#include <glm/gtc/matrix_transform.hpp>

#include "techniques/base/error.h"
#include "techniques/scene/automatic_cameras.h"
#include "techniques/scene/gltf_limits.h"
#include "techniques/scene/gltf_scene.h"

namespace sightlines {
namespace {

/// Where every node is, and how far every node's mesh is morphed.
struct Pose {
    std::vector<mat4> world_from_node;        ///< [N]
    std::vector<std::vector<float>> weights;  ///< [N], empty without morph targets
};

Pose pose_at(const GltfScene& model, double time_s) {
    struct Local {
        vec3 translation;
        glm::quat rotation;
        vec3 scale;
    };
    Pose pose{std::vector<mat4>(model.nodes.size()), std::vector<std::vector<float>>(model.nodes.size())};
    std::vector<Local> locals;
    locals.reserve(model.nodes.size());
    for (const GltfNode& node : model.nodes) locals.push_back({node.translation, node.rotation, node.scale});
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const GltfNode& node = model.nodes[i];
        if (node.mesh >= 0)
            pose.weights[i] =
                node.weights.empty() ? model.meshes[static_cast<std::size_t>(node.mesh)].weights : node.weights;
    }
    for (const GltfChannel& channel : model.channels) {
        switch (channel.property) {
            case NodeProperty::translation:
                locals[channel.node].translation = sample_vector(channel.curve, time_s);
                break;
            case NodeProperty::rotation:
                locals[channel.node].rotation = sample_rotation(channel.curve, time_s);
                break;
            case NodeProperty::scale:
                locals[channel.node].scale = sample_vector(channel.curve, time_s);
                break;
            case NodeProperty::weights:
                sample_curve(channel.curve, time_s, pose.weights[channel.node]);
                break;
        }
    }
    for (const std::uint32_t index : model.parents_first) {
        const GltfNode& node = model.nodes[index];
        const Local& local = locals[index];
        const mat4 parent_from_node = node.matrix
                                          ? *node.matrix
                                          : glm::translate(mat4(1.0f), local.translation) *
                                                glm::mat4_cast(local.rotation) * glm::scale(mat4(1.0f), local.scale);
        pose.world_from_node[index] =
            node.parent < 0 ? parent_from_node
                            : pose.world_from_node[static_cast<std::size_t>(node.parent)] * parent_from_node;
    }
    return pose;
}

vec3 transformed(const mat4& matrix, vec3 point) { return vec3(matrix * vec4(point, 1.0f)); }

vec3 unit(vec3 vector) {
    const float length = glm::length(vector);
    return length > 0.0f && std::isfinite(length) ? vector / length : vec3(0.0f, 1.0f, 0.0f);
}

/// Turns normals as the matrix turns surfaces: the transposed inverse up to a positive factor, also where the matrix
/// flattens space.
mat3 normal_matrix(const mat4& matrix) {
    const mat3 linear(matrix);
    float largest = 0.0f;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) largest = std::max(largest, std::abs(linear[column][row]));
    const mat3 m = largest > 0.0f ? linear * (1.0f / largest) : linear;
    const mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(m[0], cofactors[0]) < 0.0f ? -1.0f * cofactors : cofactors;
}

bool mirrors(const mat4& matrix) {
    return glm::dot(vec3(matrix[0]), glm::cross(vec3(matrix[1]), vec3(matrix[2]))) < 0.0f;
}

/// The vertices of one primitive, on their way into the world.
struct Vertices {
    std::vector<vec3> positions, normals;
};

Vertices morphed(const GltfPrimitive& primitive, std::span<const float> weights) {
    Vertices vertices{primitive.positions, primitive.normals};
    for (std::size_t target = 0; target < primitive.targets.size(); ++target) {
        const float weight = weights[target];
        if (weight == 0.0f) continue;
        const MorphTarget& by = primitive.targets[target];
        for (std::size_t i = 0; i < by.positions.size(); ++i) vertices.positions[i] += weight * by.positions[i];
        for (std::size_t i = 0; i < by.normals.size(); ++i) vertices.normals[i] += weight * by.normals[i];
    }
    return vertices;
}

void place_rigidly(Vertices& vertices, const mat4& world_from_mesh) {
    const mat3 turn = normal_matrix(world_from_mesh);
    for (vec3& position : vertices.positions) position = transformed(world_from_mesh, position);
    for (vec3& normal : vertices.normals) normal = unit(turn * normal);
}

/// Linear blend skinning: the node's own transform does not count (glTF 2.0, 3.7.3.3).
void place_by_skin(Vertices& vertices, const GltfPrimitive& primitive, std::span<const mat4> world_from_mesh_by_joint) {
    const std::size_t each = primitive.joints_per_vertex;
    for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
        mat4 world_from_mesh(0.0f);
        for (std::size_t k = i * each; k < (i + 1) * each; ++k)
            if (primitive.joint_weights[k] > 0.0f)
                world_from_mesh += primitive.joint_weights[k] * world_from_mesh_by_joint[primitive.joints[k]];
        vertices.positions[i] = transformed(world_from_mesh, vertices.positions[i]);
        vertices.normals[i] = unit(normal_matrix(world_from_mesh) * vertices.normals[i]);
    }
}

std::vector<mat4> skin_matrices(const GltfSkin& skin, const Pose& pose) {
    std::vector<mat4> world_from_mesh(skin.joints.size());
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
        world_from_mesh[i] = pose.world_from_node[skin.joints[i]] * skin.joint_from_mesh[i];
    return world_from_mesh;
}

void append(Scene& scene, const GltfPrimitive& primitive, const Vertices& vertices, bool mirrored) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), vertices.positions.begin(), vertices.positions.end());
    scene.normals.insert(scene.normals.end(), vertices.normals.begin(), vertices.normals.end());
    for (int set = 0; set < 2; ++set) {
        const auto& coordinates = primitive.texture_coordinates[set];
        auto& all = scene.texture_coordinates[set];
        if (coordinates.empty() && all.empty()) continue;
        all.resize(first, vec2(0.0f));
        all.insert(all.end(), coordinates.begin(), coordinates.end());
        all.resize(scene.positions.size(), vec2(0.0f));
    }
    for (const uvec3& triangle : primitive.triangles)
        scene.triangles.push_back(first + (mirrored ? uvec3(triangle.x, triangle.z, triangle.y) : triangle));
    scene.triangle_materials.insert(scene.triangle_materials.end(), primitive.triangles.size(), primitive.material);
}

/// In a mirrored or deformed triangle without normals of its own the normal follows the corners, as in the mesh.
void flatten_normals(Vertices& vertices, const GltfPrimitive& primitive, bool mirrored) {
    for (const uvec3& triangle : primitive.triangles) {
        const vec3 normal = triangle_normal(vertices.positions[triangle.x], vertices.positions[triangle.y],
                                            vertices.positions[triangle.z]);
        for (int corner = 0; corner < 3; ++corner) vertices.normals[triangle[corner]] = mirrored ? -normal : normal;
    }
}

void append_instance(Scene& scene, const GltfScene& model, const GltfInstance& instance, const Pose& pose) {
    const GltfNode& node = model.nodes[instance.node];
    const GltfMesh& mesh = model.meshes[instance.mesh];
    const mat4& world_from_node = pose.world_from_node[instance.node];
    const bool skinned = instance.skin >= 0;
    const std::vector<mat4> by_joint =
        skinned ? skin_matrices(model.skins[static_cast<std::size_t>(instance.skin)], pose) : std::vector<mat4>{};
    Part part;
    part.name = node.name.empty() ? mesh.name : node.name;
    part.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    part.mesh = instance.shape;
    part.deforms = instance.deforms;
    part.moves = !skinned && !instance.deforms && node.moves;
    part.world_from_part = skinned || instance.deforms ? mat4(1.0f) : world_from_node;
    for (const GltfPrimitive& primitive : mesh.primitives) {
        Vertices vertices = morphed(primitive, pose.weights[instance.node]);
        const bool by_skin = skinned && primitive.joints_per_vertex > 0;
        const bool mirrored = !by_skin && mirrors(world_from_node);
        if (by_skin)
            place_by_skin(vertices, primitive, by_joint);
        else
            place_rigidly(vertices, world_from_node);
        if (primitive.flat_normals) flatten_normals(vertices, primitive, mirrored);
        append(scene, primitive, vertices, mirrored);
    }
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size()) - part.first_triangle;
    scene.parts.push_back(part);
}

void check_coordinates(const GltfScene& model, const Scene& scene) {
    const auto outside = [](vec3 p) {
        constexpr float limit = gltf_limits::coordinate_m;
        return !(std::abs(p.x) <= limit && std::abs(p.y) <= limit && std::abs(p.z) <= limit);
    };
    if (std::ranges::any_of(scene.positions, outside))
        throw InputError(model.file, "nodes", "place a vertex farther than the limit of 1,000,000 km from the origin",
                         "check units and scales");
}

void place_cameras_and_lights(Scene& scene, const GltfScene& model, const Pose& pose) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const GltfNode& node = model.nodes[i];
        if (!node.visible || (node.camera < 0 && node.light < 0)) continue;
        const mat4& world_from_node = pose.world_from_node[i];
        const vec3 position(world_from_node[3]);
        const vec3 axis(world_from_node[2]);
        const vec3 forward = glm::length(axis) > 0.0f ? -unit(axis) : vec3(0.0f, 0.0f, -1.0f);
        if (node.camera >= 0) {
            Camera camera = model.cameras[static_cast<std::size_t>(node.camera)];
            const float distance = scene.bounds.empty() ? 1.0f : glm::distance(position, scene.bounds.centre());
            camera.position = position;
            camera.target = position + forward * std::max(distance, 0.01f);
            camera.up = unit(vec3(world_from_node[1]));
            scene.cameras.push_back(camera);
        }
        if (node.light >= 0) {
            Light light = model.lights[static_cast<std::size_t>(node.light)];
            light.position = position;
            light.direction = forward;
            scene.lights.push_back(light);
        }
    }
    if (scene.cameras.empty())
        scene.cameras = model.automatic_cameras.empty() ? automatic_cameras(scene) : model.automatic_cameras;
}

Box3 united(Box3 box, const Box3& other) {
    if (other.empty()) return box;
    box.add(other.lowest);
    box.add(other.highest);
    return box;
}

/// Of the instance's vertices in the world, its deformed ones one by one, a rigid one's by the corners of its box.
Box3 instance_bounds(const GltfScene& model, const GltfInstance& instance, const Pose& pose, const Box3& mesh_bounds) {
    Box3 bounds;
    const mat4& world_from_node = pose.world_from_node[instance.node];
    if (!instance.deforms && instance.skin < 0) {
        for (int corner = 0; corner < 8; ++corner) {
            const glm::bvec3 high((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
            bounds.add(transformed(world_from_node, glm::mix(mesh_bounds.lowest, mesh_bounds.highest, high)));
        }
        return bounds;
    }
    const std::vector<mat4> by_joint = instance.skin >= 0
                                           ? skin_matrices(model.skins[static_cast<std::size_t>(instance.skin)], pose)
                                           : std::vector<mat4>{};
    for (const GltfPrimitive& primitive : model.meshes[instance.mesh].primitives) {
        Vertices vertices = morphed(primitive, pose.weights[instance.node]);
        if (!by_joint.empty() && primitive.joints_per_vertex > 0)
            place_by_skin(vertices, primitive, by_joint);
        else
            place_rigidly(vertices, world_from_node);
        for (const vec3 position : vertices.positions) bounds.add(position);
    }
    return bounds;
}

/// A texture is looked up only where the scene has the coordinates that it asks for.
void drop_lookups_without_coordinates(Scene& scene) {
    for (Material& material : scene.materials)
        for (auto* lookup : {&material.base_color_texture, &material.emissive_texture})
            if (*lookup && scene.texture_coordinates[(*lookup)->coordinate_set].empty()) lookup->reset();
}

}  // namespace

Scene gltf_scene_at(const GltfScene& model, double time_s) {
    const Pose pose = pose_at(model, looped_time_s(time_s, model.duration_s));
    Scene scene;
    scene.name = model.name;
    scene.time_s = time_s;
    scene.materials = model.materials;
    scene.textures = model.textures;
    scene.notes = model.notes;
    for (const GltfInstance& instance : model.instances) append_instance(scene, model, instance, pose);
    check_coordinates(model, scene);
    for (const vec3& position : scene.positions) scene.bounds.add(position);
    scene.motion_bounds = united(scene.bounds, model.moving_bounds);
    scene.light_volume = scene.bounds;
    drop_lookups_without_coordinates(scene);
    place_cameras_and_lights(scene, model, pose);
    return scene;
}

Box3 gltf_moving_bounds(const GltfScene& model) {
    constexpr int times = 32;
    constexpr float margin = 0.02f;
    std::vector<const GltfInstance*> moving;
    for (const GltfInstance& instance : model.instances)
        if (instance.deforms || model.nodes[instance.node].moves) moving.push_back(&instance);
    Box3 reached;
    if (moving.empty() || !(model.duration_s > 0.0)) return reached;
    std::vector<Box3> mesh_bounds(model.meshes.size());
    for (std::size_t i = 0; i < model.meshes.size(); ++i)
        for (const GltfPrimitive& primitive : model.meshes[i].primitives)
            for (const vec3 position : primitive.positions) mesh_bounds[i].add(position);
    for (int i = 0; i < times; ++i) {
        const Pose pose = pose_at(model, model.duration_s * i / times);
        for (const GltfInstance* instance : moving)
            reached = united(reached, instance_bounds(model, *instance, pose, mesh_bounds[instance->mesh]));
    }
    const vec3 about = margin * reached.size(), farthest(gltf_limits::coordinate_m);
    return {glm::max(reached.lowest - about, -farthest), glm::min(reached.highest + about, farthest)};
}

}  // namespace sightlines
