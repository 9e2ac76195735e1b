#include "techniques/scene/builtin_blob.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sightlines {
namespace {

constexpr std::uint32_t no_vertex = 0xffffffffu;

/// Polynomial smooth minimum (Quilez).
float melted(float a, float b, float blend_m) {
    const float h = std::max(blend_m - std::abs(a - b), 0.0f) / blend_m;
    return std::min(a, b) - 0.25f * h * h * blend_m;
}

/// The field at the corners of a grid of cells.
struct Field {
    vec3 origin{0.0f};
    float cell_m = 1.0f;
    ivec3 size{0};  ///< corners
    std::vector<float> distance;

    std::size_t index(ivec3 at) const {
        return static_cast<std::size_t>(at.x) +
               static_cast<std::size_t>(size.x) *
                   (static_cast<std::size_t>(at.y) + static_cast<std::size_t>(size.y) * static_cast<std::size_t>(at.z));
    }
    vec3 corner(ivec3 at) const { return origin + cell_m * vec3(at); }
};

Field sampled(std::span<const RoundCone> cones, float blend_m, float cell_m) {
    Box3 box;
    for (const RoundCone& cone : cones) {
        for (const auto& [end, radius] : {std::pair{cone.from, cone.from_radius}, std::pair{cone.to, cone.to_radius}}) {
            box.add(end - radius - blend_m - 2.0f * cell_m);
            box.add(end + radius + blend_m + 2.0f * cell_m);
        }
    }
    Field field{box.lowest, cell_m, ivec3(box.size() / cell_m) + 2, {}};
    const ivec3 n = field.size;
    field.distance.assign(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z),
                          10.0f);
    for (const RoundCone& cone : cones) {
        const float reach = std::max(cone.from_radius, cone.to_radius) + blend_m + 2.0f * cell_m;
        const ivec3 low = glm::max(ivec3((glm::min(cone.from, cone.to) - reach - field.origin) / cell_m), ivec3(0));
        const ivec3 high = glm::min(ivec3((glm::max(cone.from, cone.to) + reach - field.origin) / cell_m) + 1, n - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    float& value = field.distance[field.index({x, y, z})];
                    value = melted(value, distance_to(cone, field.corner({x, y, z})), blend_m);
                }
    }
    return field;
}

/// One vertex in each cell that the surface passes through, at the mean of where it cuts the cell's edges.
std::vector<std::uint32_t> place_vertices(const Field& field, Mesh& mesh) {
    std::vector<std::uint32_t> vertex_of_cell(field.distance.size(), no_vertex);
    const ivec3 n = field.size;
    for (int z = 0; z + 1 < n.z; ++z)
        for (int y = 0; y + 1 < n.y; ++y)
            for (int x = 0; x + 1 < n.x; ++x) {
                vec3 sum(0.0f);
                int cuts = 0;
                for (int axis = 0; axis < 3; ++axis)
                    for (int edge = 0; edge < 4; ++edge) {
                        ivec3 a(x, y, z);
                        a[(axis + 1) % 3] += edge & 1;
                        a[(axis + 2) % 3] += edge >> 1;
                        ivec3 b = a;
                        ++b[axis];
                        const float da = field.distance[field.index(a)], db = field.distance[field.index(b)];
                        if ((da < 0.0f) == (db < 0.0f)) continue;
                        sum += glm::mix(field.corner(a), field.corner(b), da / (da - db));
                        ++cuts;
                    }
                if (cuts > 0)
                    vertex_of_cell[field.index({x, y, z})] =
                        add_vertex(mesh, sum / static_cast<float>(cuts), vec3(0.0f));
            }
    return vertex_of_cell;
}

void add_blob_quad(Mesh& mesh, std::array<std::uint32_t, 4> corners,
                   const std::function<std::uint32_t(vec3)>& material_of) {
    const auto at = [&](std::size_t i) { return mesh.positions[corners[i]]; };
    // Along the shorter diagonal.
    if (glm::distance(at(0), at(2)) > glm::distance(at(1), at(3)))
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    const std::uint32_t material = material_of(0.25f * (at(0) + at(1) + at(2) + at(3)));
    add_triangle(mesh, {corners[0], corners[1], corners[2]}, material);
    add_triangle(mesh, {corners[0], corners[2], corners[3]}, material);
}

/// A quad about every edge of the grid that the surface cuts.
void join_vertices(const Field& field, const std::vector<std::uint32_t>& vertex_of_cell, Mesh& mesh,
                   const std::function<std::uint32_t(vec3)>& material_of) {
    const ivec3 n = field.size;
    for (int z = 1; z + 1 < n.z; ++z)
        for (int y = 1; y + 1 < n.y; ++y)
            for (int x = 1; x + 1 < n.x; ++x)
                for (int axis = 0; axis < 3; ++axis) {
                    const ivec3 a(x, y, z);
                    ivec3 b = a;
                    ++b[axis];
                    const bool inside = field.distance[field.index(a)] < 0.0f;
                    if (inside == (field.distance[field.index(b)] < 0.0f)) continue;
                    ivec3 u(0), v(0);
                    u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
                    std::array<std::uint32_t, 4> corners = {
                        vertex_of_cell[field.index(a - u - v)], vertex_of_cell[field.index(a - v)],
                        vertex_of_cell[field.index(a)], vertex_of_cell[field.index(a - u)]};
                    if (!inside) std::swap(corners[1], corners[3]);
                    add_blob_quad(mesh, corners, material_of);
                }
}

}  // namespace

float distance_to(const RoundCone& cone, vec3 point) {
    const vec3 along = cone.to - cone.from;
    const float squared = glm::dot(along, along);
    const float t = squared > 0.0f ? std::clamp(glm::dot(point - cone.from, along) / squared, 0.0f, 1.0f) : 0.0f;
    return glm::distance(point, cone.from + t * along) - glm::mix(cone.from_radius, cone.to_radius, t);
}

Mesh blob_mesh(std::span<const RoundCone> cones, float blend_m, float cell_m,
               const std::function<std::uint32_t(vec3)>& material_of) {
    const Field field = sampled(cones, blend_m, cell_m);
    Mesh mesh;
    const std::vector<std::uint32_t> vertex_of_cell = place_vertices(field, mesh);
    join_vertices(field, vertex_of_cell, mesh, material_of);
    for (const uvec3 triangle : mesh.triangles) {
        const vec3 a = mesh.positions[triangle.x];
        const vec3 face = glm::cross(mesh.positions[triangle.y] - a, mesh.positions[triangle.z] - a);
        for (int i = 0; i < 3; ++i) mesh.normals[triangle[i]] += face;
    }
    for (vec3& normal : mesh.normals)
        normal = glm::dot(normal, normal) > 0.0f ? glm::normalize(normal) : vec3(0.0f, 1.0f, 0.0f);
    return mesh;
}

}  // namespace sightlines
