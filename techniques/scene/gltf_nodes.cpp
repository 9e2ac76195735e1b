#include "techniques/scene/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <glm/gtc/type_ptr.hpp>

#include "techniques/base/error.h"
#include "techniques/scene/gltf_accessors.h"
#include "techniques/scene/gltf_limits.h"

namespace sightlines {
namespace {

vec3 vector_of(const std::vector<double>& values) {
    return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
}

glm::quat rotation_of(const GltfSource& source, const std::vector<double>& values, std::size_t index) {
    const glm::dquat rotation(values[3], values[0], values[1], values[2]);
    const double length = glm::length(rotation);
    if (!(length > 1e-6))
        throw InputError(source.file, gltf_place("nodes", index) + ".rotation", "is not a unit quaternion",
                         "no rotation is [0, 0, 0, 1]");
    return glm::quat(rotation / length);
}

GltfNode node_of(const GltfSource& source, std::size_t index) {
    const tinygltf::Node& given = source.document.nodes[index];
    GltfNode node;
    node.name = given.name;
    if (!given.matrix.empty()) node.matrix = mat4(glm::make_mat4(given.matrix.data()));
    if (!given.translation.empty()) node.translation = vector_of(given.translation);
    if (!given.rotation.empty()) node.rotation = rotation_of(source, given.rotation, index);
    if (!given.scale.empty()) node.scale = vector_of(given.scale);
    node.mesh = given.mesh;
    node.skin = given.skin;
    node.camera = given.camera;
    if (const auto light = given.extensions.find("KHR_lights_punctual"); light != given.extensions.end())
        node.light = light->second.Get("light").GetNumberAsInt();
    std::ranges::transform(given.weights, std::back_inserter(node.weights),
                           [](double weight) { return static_cast<float>(weight); });
    return node;
}

void link_parents(const GltfSource& source, std::vector<GltfNode>& nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const int child : source.document.nodes[i].children) {
            GltfNode& node = nodes[static_cast<std::size_t>(child)];
            if (node.parent >= 0)
                throw InputError(
                    source.file, gltf_place("nodes", i) + ".children",
                    "node " + std::to_string(child) + " already is a child of node " + std::to_string(node.parent),
                    "give each node one parent");
            node.parent = static_cast<int>(i);
        }
    }
}

/// Breadth first from the roots. What is not reached from a root hangs in a loop.
std::vector<std::uint32_t> order_parents_first(const GltfSource& source, const std::vector<GltfNode>& nodes) {
    std::vector<std::uint32_t> order;
    std::vector<int> depth(nodes.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].parent < 0) order.push_back(static_cast<std::uint32_t>(i));
    for (std::size_t next = 0; next < order.size(); ++next) {
        for (const int child : source.document.nodes[order[next]].children) {
            depth[static_cast<std::size_t>(child)] = depth[order[next]] + 1;
            if (depth[static_cast<std::size_t>(child)] > gltf_limits::node_depth)
                throw InputError(
                    source.file, gltf_place("nodes", static_cast<std::size_t>(child)),
                    "lies deeper in the hierarchy than the limit of " + std::to_string(gltf_limits::node_depth),
                    "flatten the hierarchy");
            order.push_back(static_cast<std::uint32_t>(child));
        }
    }
    if (order.size() == nodes.size()) return order;
    std::vector<bool> reached(nodes.size(), false);
    for (const std::uint32_t node : order) reached[node] = true;
    const auto lost = std::ranges::find(reached, false) - reached.begin();
    throw InputError(source.file, gltf_place("nodes", static_cast<std::size_t>(lost)), "is its own ancestor",
                     "break the loop of `children`");
}

void mark_visible(GltfSource& source, GltfScene& scene) {
    if (source.document.scenes.empty()) {
        if (!scene.nodes.empty()) add_note(source.notes, "the file names no scene: all its nodes are shown");
        for (GltfNode& node : scene.nodes) node.visible = true;
        return;
    }
    const int shown = std::max(source.document.defaultScene, 0);
    if (source.document.scenes.size() > 1)
        add_note(source.notes, "of " + std::to_string(source.document.scenes.size()) + " scenes number " +
                                   std::to_string(shown) + " is shown");
    for (const int root : source.document.scenes[static_cast<std::size_t>(shown)].nodes)
        scene.nodes[static_cast<std::size_t>(root)].visible = true;
    for (const std::uint32_t index : scene.parents_first) {
        GltfNode& node = scene.nodes[index];
        if (node.parent >= 0) node.visible = node.visible || scene.nodes[static_cast<std::size_t>(node.parent)].visible;
    }
}

GltfSkin skin_of(const GltfSource& source, std::size_t index) {
    const tinygltf::Skin& given = source.document.skins[index];
    GltfSkin skin;
    for (const int joint : given.joints) skin.joints.push_back(static_cast<std::uint32_t>(joint));
    if (given.inverseBindMatrices < 0) {
        skin.joint_from_mesh.assign(skin.joints.size(), mat4(1.0f));
        return skin;
    }
    const std::string place = gltf_place("skins", index) + ".inverseBindMatrices";
    require_type(source, given.inverseBindMatrices, TINYGLTF_TYPE_MAT4, "inverse bind matrices");
    const tinygltf::Accessor& accessor = source.document.accessors[static_cast<std::size_t>(given.inverseBindMatrices)];
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) throw InputError(source.file, place, "are not floats");
    if (accessor.count < skin.joints.size())
        throw InputError(
            source.file, place,
            "has " + std::to_string(accessor.count) + " matrices for " + std::to_string(skin.joints.size()) + " joints",
            "export the skin again");
    skin.joint_from_mesh = read_elements<mat4>(source, given.inverseBindMatrices);
    skin.joint_from_mesh.resize(skin.joints.size());
    return skin;
}

/// Two cameras of one name could not both be asked for.
std::string unique_name(std::set<std::string>& taken, const std::string& wanted) {
    std::string name = wanted;
    for (int number = 2; !taken.insert(name).second; ++number) name = wanted + " " + std::to_string(number);
    return name;
}

Camera lens_of(const tinygltf::Camera& given) {
    Camera camera;
    if (given.type == "orthographic") {
        camera.kind = CameraKind::orthographic;
        camera.orthographic_height_m = static_cast<float>(2.0 * std::abs(given.orthographic.ymag));
    } else {
        camera.vertical_field_of_view_deg = static_cast<float>(glm::degrees(given.perspective.yfov));
    }
    return camera;
}

/// One entry for each visible node with a camera; the node then points to it.
void load_cameras(GltfSource& source, GltfScene& scene) {
    std::set<std::string> taken;
    for (GltfNode& node : scene.nodes) {
        if (node.camera < 0) continue;
        const tinygltf::Camera& given = source.document.cameras[static_cast<std::size_t>(node.camera)];
        const std::string fallback = given.name.empty() ? "camera " + std::to_string(node.camera) : given.name;
        Camera camera = lens_of(given);
        node.camera = -1;
        if (!node.visible) continue;
        if (camera.kind == CameraKind::orthographic && !(camera.orthographic_height_m > 0.0f)) {
            add_note(source.notes, "an orthographic camera without height is left out");
            continue;
        }
        camera.name = unique_name(taken, node.name.empty() ? fallback : node.name);
        node.camera = static_cast<int>(scene.cameras.size());
        scene.cameras.push_back(camera);
    }
}

Light light_of(GltfSource& source, std::size_t index) {
    const tinygltf::Light& given = source.document.lights[index];
    const std::string place = gltf_place("extensions.KHR_lights_punctual.lights", index);
    Light light;
    if (given.type == "directional")
        light.kind = LightKind::directional;
    else if (given.type == "spot")
        light.kind = LightKind::spot;
    else if (given.type != "point")
        throw InputError(source.file, place + ".type", "`" + given.type + "` is not known",
                         "point, spot or directional");
    // Candela, lux and nit are taken for their radiometric counterparts one for one, here and in emission: what is left
    // is one factor for the whole picture, which exposure absorbs.
    light.intensity = (given.color.empty() ? vec3(1.0f) : vector_of(given.color)) * static_cast<float>(given.intensity);
    if (light.kind == LightKind::spot) {
        if (given.spot.innerConeAngle >= given.spot.outerConeAngle)
            throw InputError(source.file, place + ".spot", "its inner cone is not inside its outer one",
                             "make innerConeAngle smaller");
        light.inner_cone_deg = static_cast<float>(glm::degrees(given.spot.innerConeAngle));
        light.outer_cone_deg = static_cast<float>(glm::degrees(given.spot.outerConeAngle));
    }
    if (given.range > 0.0) add_note(source.notes, "the lights' range is not used: they fall off by distance alone");
    return light;
}

}  // namespace

void load_gltf_nodes(GltfSource& source, GltfScene& scene) {
    const std::size_t count = source.document.nodes.size();
    if (count > gltf_limits::nodes)
        throw InputError(source.file, "nodes",
                         "there are " + std::to_string(count) + "; the limit is " + std::to_string(gltf_limits::nodes));
    for (std::size_t i = 0; i < count; ++i) scene.nodes.push_back(node_of(source, i));
    link_parents(source, scene.nodes);
    scene.parents_first = order_parents_first(source, scene.nodes);
    mark_visible(source, scene);
    for (std::size_t i = 0; i < source.document.skins.size(); ++i) scene.skins.push_back(skin_of(source, i));
    load_cameras(source, scene);
    for (std::size_t i = 0; i < source.document.lights.size(); ++i) scene.lights.push_back(light_of(source, i));
}

void load_gltf_instances(GltfSource& source, GltfScene& scene) {
    std::uint64_t triangles = 0, vertices = 0;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const GltfNode& node = scene.nodes[i];
        if (node.mesh < 0) continue;
        const std::string place = gltf_place("nodes", i);
        const GltfMesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        if (!node.weights.empty() && node.weights.size() != mesh.target_count)
            throw InputError(source.file, place + ".weights",
                             "holds " + std::to_string(node.weights.size()) + " weights for " +
                                 std::to_string(mesh.target_count) + " morph targets");
        const bool has_joints =
            std::ranges::any_of(mesh.primitives, [](const GltfPrimitive& p) { return p.joints_per_vertex > 0; });
        GltfInstance instance{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(node.mesh),
                              has_joints ? node.skin : -1, static_cast<std::uint32_t>(node.mesh), node.morphs};
        if (node.skin >= 0) {
            const GltfSkin& skin = scene.skins[static_cast<std::size_t>(node.skin)];
            if (mesh.joints_needed > skin.joints.size())
                throw InputError(source.file, place,
                                 "its mesh uses joint " + std::to_string(mesh.joints_needed - 1) + " of a skin of " +
                                     std::to_string(skin.joints.size()),
                                 "export the skin again");
            if (!has_joints) add_note(source.notes, "skins on meshes without joints are not used");
            const bool partly_rigid =
                std::ranges::any_of(mesh.primitives, [](const GltfPrimitive& p) { return p.joints_per_vertex == 0; });
            instance.deforms |=
                has_joints &&
                ((partly_rigid && node.moves) ||
                 std::ranges::any_of(skin.joints, [&](std::uint32_t joint) { return scene.nodes[joint].moves; }));
        }
        // Another skin or other weights give the same mesh another shape.
        if (instance.skin >= 0 || node.morphs || (!node.weights.empty() && node.weights != mesh.weights))
            instance.shape = static_cast<std::uint32_t>(scene.meshes.size() + i);
        if (!node.visible) continue;
        for (const GltfPrimitive& primitive : mesh.primitives) {
            triangles += primitive.triangles.size();
            vertices += primitive.positions.size();
        }
        if (triangles > gltf_limits::triangles || vertices > gltf_limits::vertices)
            throw InputError(source.file, place,
                             "instancing brings the scene above the limit of " +
                                 std::to_string(gltf_limits::triangles) + " triangles or " +
                                 std::to_string(gltf_limits::vertices) + " vertices",
                             "show fewer instances");
        if (!mesh.primitives.empty()) scene.instances.push_back(instance);
    }
}

}  // namespace sightlines
