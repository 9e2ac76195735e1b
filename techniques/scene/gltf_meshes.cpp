#include "techniques/scene/gltf_meshes.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>

#include "techniques/base/error.h"
#include "techniques/scene/gltf_accessors.h"
#include "techniques/scene/gltf_limits.h"

namespace sightlines {
namespace {

/// What all primitives together have taken from the limits.
struct Totals {
    std::uint64_t vertices_read = 0, vertices = 0, triangles = 0;
};

void take(const GltfSource& source, const std::string& place, std::uint64_t& used, std::uint64_t more,
          std::uint64_t limit, const char* what) {
    used += more;
    if (used > limit)
        throw InputError(source.file, place, "brings the file above the limit of " + std::to_string(limit) + " " + what,
                         "split the scene");
}

std::optional<int> attribute(const std::map<std::string, int>& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::uint32_t> corner_indices(const GltfSource& source, const tinygltf::Primitive& primitive,
                                          std::size_t vertex_count, const std::string& place) {
    std::vector<std::uint32_t> corners;
    if (primitive.indices < 0) {
        corners.resize(vertex_count);
        std::iota(corners.begin(), corners.end(), 0u);
        return corners;
    }
    require_type(source, primitive.indices, TINYGLTF_TYPE_SCALAR, "indices");
    corners = read_unsigned(source, primitive.indices);
    const auto bad = std::ranges::find_if(corners, [&](std::uint32_t corner) { return corner >= vertex_count; });
    if (bad != corners.end())
        throw InputError(source.file, place + ".indices",
                         "element " + std::to_string(bad - corners.begin()) + " is " + std::to_string(*bad) +
                             "; there are " + std::to_string(vertex_count) + " vertices",
                         "the file is damaged: export it again");
    return corners;
}

/// glTF 2.0, 3.7.2.1: the order of corners that keeps every triangle's front where the strip's or fan's is.
std::vector<uvec3> assemble_triangles(const std::vector<std::uint32_t>& corners, int mode) {
    std::vector<uvec3> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(corners.size() / 3);
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
            triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
        return triangles;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const uvec3 triangle = mode == TINYGLTF_MODE_TRIANGLE_FAN
                                   ? uvec3(corners[i + 1], corners[i + 2], corners[0])
                                   : uvec3(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
        const bool stitch = triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x;
        if (!stitch) triangles.push_back(triangle);
    }
    return triangles;
}

/// The vertices that triangles use, in order of first use, and the triangles renumbered to them. `apart`: every corner
/// becomes a vertex of its own.
std::vector<std::uint32_t> renumber(std::vector<uvec3>& triangles, std::size_t vertex_count, bool apart) {
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> order, renumbered(apart ? 0 : vertex_count, unused);
    for (uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t old = triangle[corner];
            const bool first_use = apart || renumbered[old] == unused;
            const std::uint32_t renumbered_to = first_use ? static_cast<std::uint32_t>(order.size()) : renumbered[old];
            if (first_use) order.push_back(old);
            if (!apart) renumbered[old] = renumbered_to;
            triangle[corner] = renumbered_to;
        }
    }
    return order;
}

template <class Value>
std::vector<Value> gathered(const std::vector<Value>& values, const std::vector<std::uint32_t>& order,
                            std::size_t each = 1) {
    std::vector<Value> result(order.size() * each);
    for (std::size_t i = 0; i < order.size(); ++i)
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(order[i] * each), each,
                    result.begin() + static_cast<std::ptrdiff_t>(i * each));
    return result;
}

/// Reads one attribute of one primitive: type and length checked, only the vertices in `order`.
struct AttributeReader {
    const GltfSource& source;
    Totals& totals;
    std::string place;
    std::size_t vertex_count;
    const std::vector<std::uint32_t>& order;

    void check(int accessor, int type, const std::string& name) const {
        require_type(source, accessor, type, name);
        const std::size_t count = source.document.accessors[static_cast<std::size_t>(accessor)].count;
        if (count != vertex_count)
            throw InputError(
                source.file, place + "." + name,
                "has " + std::to_string(count) + " elements for " + std::to_string(vertex_count) + " vertices",
                "export the mesh again");
        take(source, place, totals.vertices_read, count, gltf_limits::vertices_read,
             "vertices read, shared ones counted anew");
    }
    template <class Element>
    std::vector<Element> read(int accessor, int type, const std::string& name) const {
        check(accessor, type, name);
        return gathered(read_elements<Element>(source, accessor), order);
    }
};

/// Normals of length 0 become the sum of their triangles' normals.
void repair_normals(GltfPrimitive& primitive, std::vector<std::string>& notes) {
    std::vector<bool> bad(primitive.normals.size(), false);
    bool any = false;
    for (std::size_t i = 0; i < bad.size(); ++i) {
        const float length = glm::length(primitive.normals[i]);
        bad[i] = !(length > 1e-6f && length < 1e18f);
        primitive.normals[i] = bad[i] ? vec3(0.0f) : primitive.normals[i] / length;
        any = any || bad[i];
    }
    if (!any) return;
    add_note(notes, "vertex normals without a direction are replaced by their triangles' normals");
    for (const uvec3& triangle : primitive.triangles) {
        const vec3 normal = triangle_normal(primitive.positions[triangle.x], primitive.positions[triangle.y],
                                            primitive.positions[triangle.z]);
        for (int corner = 0; corner < 3; ++corner)
            if (bad[triangle[corner]]) primitive.normals[triangle[corner]] += normal;
    }
    for (std::size_t i = 0; i < bad.size(); ++i) {
        const float length = glm::length(primitive.normals[i]);
        if (bad[i]) primitive.normals[i] = length > 1e-6f ? primitive.normals[i] / length : vec3(0.0f, 1.0f, 0.0f);
    }
}

void make_flat_normals(GltfPrimitive& primitive) {
    primitive.flat_normals = true;
    primitive.normals.resize(primitive.positions.size());
    for (const uvec3& triangle : primitive.triangles) {
        const vec3 normal = triangle_normal(primitive.positions[triangle.x], primitive.positions[triangle.y],
                                            primitive.positions[triangle.z]);
        for (int corner = 0; corner < 3; ++corner) primitive.normals[triangle[corner]] = normal;
    }
}

void normalise_joint_weights(const AttributeReader& reader, GltfPrimitive& primitive) {
    const std::size_t each = primitive.joints_per_vertex;
    for (std::size_t vertex = 0; vertex < primitive.positions.size(); ++vertex) {
        const std::span<float> weights(primitive.joint_weights.data() + vertex * each, each);
        if (std::ranges::any_of(weights, [](float weight) { return weight < 0.0f || weight > 1e6f; }))
            throw InputError(reader.source.file, reader.place, "a joint weight is negative or huge",
                             "normalise the skin's weights");
        const float sum = std::accumulate(weights.begin(), weights.end(), 0.0f);
        if (sum > 0.0f)
            for (float& weight : weights) weight /= sum;
        else
            weights[0] = 1.0f;
    }
}

/// JOINTS_0, WEIGHTS_0 and, where there are more, the sets that follow.
void read_joints(const AttributeReader& reader, const tinygltf::Primitive& given, GltfPrimitive& primitive) {
    std::vector<std::vector<std::uint32_t>> joint_sets;
    std::vector<std::vector<float>> weight_sets;
    for (std::uint32_t set = 0; set < gltf_limits::joint_sets; ++set) {
        const auto joints = attribute(given.attributes, "JOINTS_" + std::to_string(set));
        const auto weights = attribute(given.attributes, "WEIGHTS_" + std::to_string(set));
        if (!joints || !weights) break;
        reader.check(*joints, TINYGLTF_TYPE_VEC4, "JOINTS");
        reader.check(*weights, TINYGLTF_TYPE_VEC4, "WEIGHTS");
        if (reader.source.document.accessors[static_cast<std::size_t>(*joints)].componentType ==
            TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            throw InputError(reader.source.file, reader.place + ".JOINTS", "are 32-bit integers",
                             "glTF allows 8 and 16 bits");
        joint_sets.push_back(gathered(read_unsigned(reader.source, *joints), reader.order, 4));
        weight_sets.push_back(gathered(read_floats(reader.source, *weights), reader.order, 4));
    }
    if (joint_sets.empty()) return;
    primitive.joints_per_vertex = static_cast<std::uint32_t>(4 * joint_sets.size());
    for (std::size_t vertex = 0; vertex < reader.order.size(); ++vertex) {
        for (std::size_t set = 0; set < joint_sets.size(); ++set) {
            for (std::size_t k = 4 * vertex; k < 4 * vertex + 4; ++k) {
                primitive.joints.push_back(joint_sets[set][k]);
                primitive.joint_weights.push_back(weight_sets[set][k]);
            }
        }
    }
    normalise_joint_weights(reader, primitive);
}

void read_targets(const AttributeReader& reader, const tinygltf::Primitive& given, GltfPrimitive& primitive) {
    for (std::size_t i = 0; i < given.targets.size(); ++i) {
        take(reader.source, reader.place, reader.totals.vertices, reader.order.size(), gltf_limits::vertices,
             "vertices, morph targets counted");
        MorphTarget target;
        if (const auto accessor = attribute(given.targets[i], "POSITION"))
            target.positions =
                reader.read<vec3>(*accessor, TINYGLTF_TYPE_VEC3, "targets[" + std::to_string(i) + "].POSITION");
        if (const auto accessor = attribute(given.targets[i], "NORMAL"); accessor && !primitive.flat_normals)
            target.normals =
                reader.read<vec3>(*accessor, TINYGLTF_TYPE_VEC3, "targets[" + std::to_string(i) + "].NORMAL");
        primitive.targets.push_back(std::move(target));
    }
}

bool all_have_data(const GltfSource& source, const tinygltf::Primitive& given) {
    const auto present = [&](const auto& attribute) { return has_data(source, attribute.second); };
    return (given.indices < 0 || has_data(source, given.indices)) && std::ranges::all_of(given.attributes, present) &&
           std::ranges::all_of(given.targets, [&](const auto& target) { return std::ranges::all_of(target, present); });
}

/// Everything that belongs to vertices, for those in the reader's order.
void read_attributes(GltfSource& source, const AttributeReader& reader, const tinygltf::Primitive& given,
                     GltfPrimitive& primitive) {
    primitive.positions = reader.read<vec3>(given.attributes.at("POSITION"), TINYGLTF_TYPE_VEC3, "POSITION");
    if (const auto normal = attribute(given.attributes, "NORMAL")) {
        primitive.normals = reader.read<vec3>(*normal, TINYGLTF_TYPE_VEC3, "NORMAL");
        repair_normals(primitive, source.notes);
    } else {
        make_flat_normals(primitive);
    }
    for (int set = 0; set < 2; ++set) {
        const std::string name = "TEXCOORD_" + std::to_string(set);
        if (const auto coordinates = attribute(given.attributes, name))
            primitive.texture_coordinates[set] = reader.read<vec2>(*coordinates, TINYGLTF_TYPE_VEC2, name);
    }
    read_joints(reader, given, primitive);
    read_targets(reader, given, primitive);
}

void note_approximations(std::vector<std::string>& notes, const tinygltf::Primitive& given, std::size_t corner_count) {
    if (given.mode == TINYGLTF_MODE_TRIANGLES && corner_count % 3 != 0)
        add_note(notes, "corners that make no whole triangle are left out");
    if (given.material < 0) add_note(notes, "primitives without a material are matte light grey");
    if (!given.attributes.contains("NORMAL"))
        add_note(notes, "meshes without normals are shaded flat, by their triangles");
    if (given.attributes.contains("COLOR_0")) add_note(notes, "vertex colours are not used");
}

/// Without triangles where the primitive is made of points or lines: all of it is checked all the same.
GltfPrimitive load_primitive(GltfSource& source, Totals& totals, const tinygltf::Primitive& given,
                             const std::string& place) {
    const auto position = attribute(given.attributes, "POSITION");
    if (!position || !all_have_data(source, given)) {
        add_note(source.notes, position ? "primitives whose buffer comes without data are left out"
                                        : "primitives without positions are left out");
        return {};
    }
    require_type(source, *position, TINYGLTF_TYPE_VEC3, "POSITION");
    const std::size_t vertex_count = source.document.accessors[static_cast<std::size_t>(*position)].count;
    if (vertex_count > gltf_limits::vertices)
        throw InputError(
            source.file, place,
            "has " + std::to_string(vertex_count) + " vertices; the limit is " + std::to_string(gltf_limits::vertices),
            "split the mesh");
    const std::uint64_t corner_count =
        given.indices < 0 ? vertex_count : source.document.accessors[static_cast<std::size_t>(given.indices)].count;
    take(source, place, totals.vertices_read, corner_count, gltf_limits::vertices_read, "indices and vertices read");
    std::vector<std::uint32_t> order = corner_indices(source, given, vertex_count, place);
    GltfPrimitive primitive;
    primitive.material = static_cast<std::uint32_t>(
        given.material >= 0 ? given.material : static_cast<int>(source.document.materials.size()));
    if (given.mode >= TINYGLTF_MODE_TRIANGLES) {
        note_approximations(source.notes, given, order.size());
        primitive.triangles = assemble_triangles(order, given.mode);
        order = renumber(primitive.triangles, vertex_count, !given.attributes.contains("NORMAL"));
    } else {
        add_note(source.notes, "points and lines are left out");
    }
    take(source, place, totals.triangles, primitive.triangles.size(), gltf_limits::triangles, "triangles");
    take(source, place, totals.vertices, order.size(), gltf_limits::vertices, "vertices, morph targets counted");
    read_attributes(source, AttributeReader{source, totals, place, vertex_count, order}, given, primitive);
    return primitive;
}

GltfMesh load_mesh(GltfSource& source, Totals& totals, std::size_t index) {
    const tinygltf::Mesh& given = source.document.meshes[index];
    const std::string place = gltf_place("meshes", index);
    GltfMesh mesh;
    mesh.name = given.name.empty() ? "mesh " + std::to_string(index) : given.name;
    mesh.target_count = given.primitives.front().targets.size();
    for (std::size_t i = 0; i < given.primitives.size(); ++i) {
        const std::string spot = place + "." + gltf_place("primitives", i);
        if (given.primitives[i].targets.size() != mesh.target_count)
            throw InputError(source.file, spot + ".targets", "differ in number from the mesh's first primitive",
                             "export the mesh again");
        GltfPrimitive primitive = load_primitive(source, totals, given.primitives[i], spot);
        for (const std::uint32_t joint : primitive.joints) mesh.joints_needed = std::max(mesh.joints_needed, joint + 1);
        if (!primitive.triangles.empty()) mesh.primitives.push_back(std::move(primitive));
    }
    if (!given.weights.empty() && given.weights.size() != mesh.target_count)
        throw InputError(source.file, place + ".weights",
                         "holds " + std::to_string(given.weights.size()) + " weights for " +
                             std::to_string(mesh.target_count) + " morph targets");
    mesh.weights.assign(mesh.target_count, 0.0f);
    std::ranges::transform(given.weights, mesh.weights.begin(),
                           [](double weight) { return static_cast<float>(weight); });
    return mesh;
}

}  // namespace

vec3 triangle_normal(vec3 a, vec3 b, vec3 c) {
    // In double precision: the squares of small or large edges leave the range of floats.
    const dvec3 normal = glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
    const double length = glm::length(normal);
    return length > 0.0 ? vec3(normal / length) : vec3(0.0f, 1.0f, 0.0f);
}

std::vector<GltfMesh> load_gltf_meshes(GltfSource& source, Progress& progress) {
    std::vector<GltfMesh> meshes;
    Totals totals;
    progress.begin("reading meshes", static_cast<std::int64_t>(source.document.meshes.size()));
    for (std::size_t i = 0; i < source.document.meshes.size(); ++i) {
        meshes.push_back(load_mesh(source, totals, i));
        progress.advance();
    }
    return meshes;
}

}  // namespace sightlines
