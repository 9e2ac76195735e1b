#include "techniques/scene/builtin_mesh.h"

#include <array>
#include <cmath>
#include <numbers>

namespace sightlines {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Unit vector square to `direction`.
vec3 any_perpendicular(vec3 direction) {
    const vec3 axis = std::abs(direction.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    return glm::normalize(glm::cross(direction, axis));
}

/// Smooth normals of a grid of (divisions.x + 1) x (divisions.y + 1) points, row by row in v: area-weighted means over
/// the cells around each point. Points of a row that all coincide (a pole) share theirs.
std::vector<vec3> grid_normals(const std::vector<vec3>& points, ivec2 divisions, bool closed_u) {
    const int width = divisions.x + 1;
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(j * width + i); };
    std::vector<vec3> normals(points.size(), vec3(0.0f));
    for (int j = 0; j < divisions.y; ++j) {
        for (int i = 0; i < divisions.x; ++i) {
            const std::array<std::size_t, 4> corners = {at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)};
            const vec3 face =
                glm::cross(points[corners[3]] - points[corners[0]], points[corners[2]] - points[corners[1]]);
            for (const std::size_t corner : corners) normals[corner] += face;
        }
    }
    for (int j = 0; j <= divisions.y; ++j) {
        if (closed_u) normals[at(0, j)] = normals[at(divisions.x, j)] = normals[at(0, j)] + normals[at(divisions.x, j)];
        if (glm::distance(points[at(0, j)], points[at(divisions.x / 2, j)]) < 1e-6f &&
            glm::distance(points[at(0, j)], points[at(1, j)]) < 1e-6f) {
            vec3 sum(0.0f);
            for (int i = 0; i < divisions.x; ++i) sum += normals[at(i, j)];
            for (int i = 0; i <= divisions.x; ++i) normals[at(i, j)] = sum;
        }
    }
    for (vec3& normal : normals) normal = glm::normalize(normal);
    return normals;
}

}  // namespace

std::uint32_t add_vertex(Mesh& mesh, vec3 position, vec3 normal) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_triangle(Mesh& mesh, uvec3 vertices, std::uint32_t material) {
    const vec3 a = mesh.positions[vertices.x], b = mesh.positions[vertices.y], c = mesh.positions[vertices.z];
    if (glm::length(glm::cross(b - a, c - a)) < 1e-7f) return;
    mesh.triangles.push_back(vertices);
    mesh.materials.push_back(material);
}

void add_quad(Mesh& mesh, vec3 corner, vec3 edge_u, vec3 edge_v, ivec2 divisions,
              const std::function<std::uint32_t(ivec2)>& material_of) {
    const vec3 normal = glm::normalize(glm::cross(edge_u, edge_v));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto width = static_cast<std::uint32_t>(divisions.x + 1);
    for (int j = 0; j <= divisions.y; ++j) {
        for (int i = 0; i <= divisions.x; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(divisions.x);
            const float v = static_cast<float>(j) / static_cast<float>(divisions.y);
            add_vertex(mesh, corner + u * edge_u + v * edge_v, normal);
        }
    }
    for (int j = 0; j < divisions.y; ++j) {
        for (int i = 0; i < divisions.x; ++i) {
            const std::uint32_t a = first + static_cast<std::uint32_t>(j) * width + static_cast<std::uint32_t>(i);
            const std::uint32_t material = material_of({i, j});
            add_triangle(mesh, {a, a + 1, a + width + 1}, material);
            add_triangle(mesh, {a, a + width + 1, a + width}, material);
        }
    }
}

void add_quad(Mesh& mesh, vec3 corner, vec3 edge_u, vec3 edge_v, std::uint32_t material) {
    add_quad(mesh, corner, edge_u, edge_v, {1, 1}, [material](ivec2) { return material; });
}

void add_polygon(Mesh& mesh, std::span<const vec3> corners, std::uint32_t material) {
    vec3 normal(0.0f);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    normal = glm::normalize(normal);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const vec3 corner : corners) add_vertex(mesh, corner, normal);
    for (std::uint32_t i = 1; i + 1 < corners.size(); ++i)
        add_triangle(mesh, {first, first + i, first + i + 1}, material);
}

void add_box(Mesh& mesh, const Box3& box, std::uint32_t material) {
    const vec3 size = box.size();
    for (int axis = 0; axis < 3; ++axis) {
        vec3 edge_u(0.0f), edge_v(0.0f);
        edge_u[(axis + 1) % 3] = size[(axis + 1) % 3];
        edge_v[(axis + 2) % 3] = size[(axis + 2) % 3];
        add_quad(mesh, box.lowest, edge_v, edge_u, material);
        vec3 far_corner = box.lowest;
        far_corner[axis] = box.highest[axis];
        add_quad(mesh, far_corner, edge_u, edge_v, material);
    }
}

void add_tile(Mesh& mesh, const Box3& box, float bevel_m, std::uint32_t material) {
    const vec3 low = box.lowest, high = box.highest;
    const std::array<vec2, 4> outline = {vec2(low.x, low.z), vec2(low.x, high.z), vec2(high.x, high.z),
                                         vec2(high.x, low.z)};
    const vec2 middle = 0.5f * (outline[0] + outline[2]);
    std::array<vec3, 4> top, bottom;
    for (std::size_t i = 0; i < 4; ++i) {
        const vec2 inner = outline[i] + bevel_m * glm::sign(middle - outline[i]);
        top[i] = {inner.x, high.y, inner.y};
        bottom[i] = {outline[i].x, low.y, outline[i].y};
    }
    add_polygon(mesh, top, material);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        add_polygon(mesh, std::array<vec3, 4>{bottom[i], bottom[next], top[next], top[i]}, material);
    }
}

void add_surface(Mesh& mesh, ivec2 divisions, bool closed_u, const std::function<vec3(vec2)>& point,
                 std::uint32_t material) {
    std::vector<vec3> points;
    for (int j = 0; j <= divisions.y; ++j) {
        for (int i = 0; i <= divisions.x; ++i) {
            const float u = static_cast<float>(closed_u ? i % divisions.x : i) / static_cast<float>(divisions.x);
            points.push_back(point({u, static_cast<float>(j) / static_cast<float>(divisions.y)}));
        }
    }
    const std::vector<vec3> normals = grid_normals(points, divisions, closed_u);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto width = static_cast<std::uint32_t>(divisions.x + 1);
    for (std::size_t i = 0; i < points.size(); ++i) add_vertex(mesh, points[i], normals[i]);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(divisions.y); ++j) {
        for (std::uint32_t i = 0; i + 1 < width; ++i) {
            const std::uint32_t a = first + j * width + i;
            add_triangle(mesh, {a, a + 1, a + width + 1}, material);
            add_triangle(mesh, {a, a + width + 1, a + width}, material);
        }
    }
}

void add_revolution(Mesh& mesh, std::span<const vec2> profile, int segments, std::uint32_t material) {
    const float smooth_cosine = std::cos(40.0f * pi / 180.0f);
    const auto outward = [&](std::size_t i) {
        const vec2 along = glm::normalize(profile[i + 1] - profile[i]);
        return vec2(along.y, -along.x);
    };
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        vec2 lower = outward(i), upper = lower;
        if (i > 0 && glm::dot(outward(i - 1), lower) > smooth_cosine) lower = glm::normalize(outward(i - 1) + lower);
        if (i + 2 < profile.size() && glm::dot(outward(i + 1), upper) > smooth_cosine)
            upper = glm::normalize(outward(i + 1) + upper);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k <= segments; ++k) {
            const float angle = 2.0f * pi * static_cast<float>(k % segments) / static_cast<float>(segments);
            const float c = std::cos(angle), s = std::sin(angle);
            const vec2 a = profile[i], b = profile[i + 1];
            add_vertex(mesh, {a.x * c, a.y, a.x * s}, glm::normalize(vec3(lower.x * c, lower.y, lower.x * s)));
            add_vertex(mesh, {b.x * c, b.y, b.x * s}, glm::normalize(vec3(upper.x * c, upper.y, upper.x * s)));
        }
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(segments); ++k) {
            const std::uint32_t a = first + 2 * k;
            add_triangle(mesh, {a, a + 1, a + 3}, material);
            add_triangle(mesh, {a, a + 3, a + 2}, material);
        }
    }
}

void add_tube(Mesh& mesh, std::span<const TubeRing> rings, int sides, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto width = static_cast<std::uint32_t>(sides);
    vec3 across(0.0f);
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const vec3 along =
            glm::normalize(rings[std::min(i + 1, rings.size() - 1)].centre - rings[i > 0 ? i - 1 : 0].centre);
        // Carried from ring to ring, so that the tube does not twist.
        across = i == 0 ? any_perpendicular(along) : glm::normalize(across - along * glm::dot(across, along));
        const vec3 up = glm::cross(along, across);
        for (std::uint32_t k = 0; k < width; ++k) {
            const float angle = 2.0f * pi * static_cast<float>(k) / static_cast<float>(sides);
            const vec3 normal = std::cos(angle) * across + std::sin(angle) * up;
            add_vertex(mesh, rings[i].centre + rings[i].radius * normal, normal);
        }
    }
    for (std::uint32_t i = 0; i + 1 < rings.size(); ++i) {
        for (std::uint32_t k = 0; k < width; ++k) {
            const std::uint32_t a = first + i * width + k, b = first + i * width + (k + 1) % width;
            add_triangle(mesh, {a, b, b + width}, material);
            add_triangle(mesh, {a, b + width, a + width}, material);
        }
    }
}

void add_leaf(Mesh& mesh, vec3 base, vec3 direction, vec3 side, float length_m, float width_m, std::uint32_t material) {
    const vec3 up = glm::normalize(glm::cross(side, direction));
    const vec3 tip = base + length_m * direction;
    const vec3 middle = base + 0.45f * length_m * direction + 0.3f * width_m * up;
    const std::uint32_t first = add_vertex(mesh, base, up);
    add_vertex(mesh, tip, up);
    for (const float sign : {-1.0f, 1.0f}) {
        const vec3 edge = middle + 0.5f * width_m * sign * side;
        const vec3 face = sign * glm::cross(edge - base, direction);
        const std::uint32_t corner = add_vertex(mesh, edge, glm::normalize(face));
        add_triangle(mesh, sign < 0.0f ? uvec3(first, first + 1, corner) : uvec3(first, corner, first + 1), material);
    }
}

void append(Mesh& mesh, const Mesh& added, const mat4& mesh_from_added) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const mat3 turn(mesh_from_added);
    for (std::size_t i = 0; i < added.positions.size(); ++i)
        add_vertex(mesh, vec3(mesh_from_added * vec4(added.positions[i], 1.0f)),
                   glm::normalize(turn * added.normals[i]));
    for (const uvec3 triangle : added.triangles) mesh.triangles.push_back(triangle + first);
    mesh.materials.insert(mesh.materials.end(), added.materials.begin(), added.materials.end());
}

void add_part(Scene& scene, const Mesh& mesh, const std::string& name, std::uint32_t mesh_number,
              const mat4& world_from_part) {
    Part part;
    part.name = name;
    part.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    part.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    part.mesh = mesh_number;
    part.world_from_part = world_from_part;
    scene.parts.push_back(part);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const mat3 turn(world_from_part);
    const float inverse_scale = 1.0f / glm::length(turn[0]);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        scene.positions.push_back(vec3(world_from_part * vec4(mesh.positions[i], 1.0f)));
        scene.normals.push_back(inverse_scale * (turn * mesh.normals[i]));
    }
    for (const uvec3 triangle : mesh.triangles) scene.triangles.push_back(triangle + first);
    scene.triangle_materials.insert(scene.triangle_materials.end(), mesh.materials.begin(), mesh.materials.end());
}

Box3 tight_bounds(const Scene& scene) {
    Box3 bounds;
    for (const uvec3 triangle : scene.triangles) {
        for (int i = 0; i < 3; ++i) bounds.add(scene.positions[triangle[i]]);
    }
    return bounds;
}

Material diffuse(const std::string& name, vec3 base_color, float roughness) {
    Material material;
    material.name = name;
    material.base_color = base_color;
    material.roughness = roughness;
    return material;
}

mat4 placed(vec3 position, float turn_deg, float scale) {
    const float angle = turn_deg * pi / 180.0f;
    const float c = scale * std::cos(angle), s = scale * std::sin(angle);
    return {vec4(c, 0.0f, -s, 0.0f), vec4(0.0f, scale, 0.0f, 0.0f), vec4(s, 0.0f, c, 0.0f), vec4(position, 1.0f)};
}

}  // namespace sightlines
