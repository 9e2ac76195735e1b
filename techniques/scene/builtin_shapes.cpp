#include "techniques/scene/builtin_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace sightlines {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

vec3 square_to(vec3 direction) {
    const vec3 helper = std::abs(direction.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    return glm::normalize(glm::cross(direction, helper));
}

vec3 any_direction(Draws& draws) {
    const float u = draws.unit();
    return sphere_direction(u, draws.unit());
}

}  // namespace

mat4 framed(vec3 x, vec3 y, vec3 z, vec3 origin) {
    return {vec4(x, 0.0f), vec4(y, 0.0f), vec4(z, 0.0f), vec4(origin, 1.0f)};
}

mat4 turned_about(vec3 axis, float angle_rad) { return glm::rotate(mat4(1.0f), angle_rad, axis); }

void add_outline(Mesh& mesh, std::span<const vec3> corners, std::uint32_t material) {
    vec3 normal(0.0f);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    normal = glm::normalize(normal);
    std::vector<std::uint32_t> left;
    for (const vec3 corner : corners) left.push_back(add_vertex(mesh, corner, normal));
    const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return glm::dot(normal,
                        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
    };
    // Ears are cut off one by one: corners that stick out and hold no other corner.
    while (left.size() >= 3) {
        bool cut = false;
        for (std::size_t i = 0; i < left.size() && !cut; ++i) {
            const std::uint32_t a = left[(i + left.size() - 1) % left.size()], b = left[i],
                                c = left[(i + 1) % left.size()];
            if (turn(a, b, c) <= 0.0f) continue;
            const bool holds = std::ranges::any_of(left, [&](std::uint32_t p) {
                return p != a && p != b && p != c && turn(a, b, p) >= 0.0f && turn(b, c, p) >= 0.0f &&
                       turn(c, a, p) >= 0.0f;
            });
            if (holds) continue;
            add_triangle(mesh, {a, b, c}, material);
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
            cut = true;
        }
        if (!cut) return;
    }
}

void add_beam(Mesh& mesh, vec3 from, vec3 to, float width_m, float height_m, std::uint32_t material, vec3 up) {
    const vec3 along = glm::normalize(to - from);
    const vec3 across = glm::cross(along, up);
    const vec3 side = glm::dot(across, across) > 1e-6f ? glm::normalize(across) : square_to(along);
    const vec3 top = glm::cross(side, along);
    Mesh box;
    const float half = 0.5f * glm::distance(from, to);
    add_box(box, {{-half, -0.5f * height_m, -0.5f * width_m}, {half, 0.5f * height_m, 0.5f * width_m}}, material);
    append(mesh, box, framed(along, top, side, 0.5f * (from + to)));
}

void add_rod(Mesh& mesh, vec3 from, vec3 to, float radius_m, int sides, std::uint32_t material) {
    const float length = glm::distance(from, to);
    const vec3 along = (to - from) / length, x = square_to(along);
    Mesh rod;
    const std::array<vec2, 4> profile = {vec2(0.0f), vec2(radius_m, 0.0f), vec2(radius_m, length), vec2(0.0f, length)};
    add_revolution(rod, profile, sides, material);
    append(mesh, rod, framed(x, along, glm::cross(x, along), from));
}

void add_ball(Mesh& mesh, vec3 centre, vec3 radii, int segments, std::uint32_t material) {
    add_surface(
        mesh, {segments, std::max(segments / 2, 2)}, true,
        [=](vec2 uv) {
            const float azimuth = -2.0f * pi * uv.x, height = pi * (uv.y - 0.5f);
            const float ring = uv.y <= 0.0f || uv.y >= 1.0f ? 0.0f : std::cos(height);
            return centre + radii * vec3(ring * std::cos(azimuth), std::sin(height), ring * std::sin(azimuth));
        },
        material);
}

void add_octahedron(Mesh& mesh, vec3 centre, float radius_m, std::uint32_t material) {
    const std::array<vec3, 6> axes = {vec3(1, 0, 0),  vec3(0, 1, 0),  vec3(0, 0, 1),
                                      vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1)};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const vec3 axis : axes) add_vertex(mesh, centre + radius_m * axis, axis);
    for (std::uint32_t x = 0; x < 6; x += 3)
        for (std::uint32_t y = 1; y < 6; y += 3)
            for (std::uint32_t z = 2; z < 6; z += 3) {
                const bool mirrored = ((x == 3) + (y == 4) + (z == 5)) % 2 != 0;
                mesh.triangles.push_back(first + (mirrored ? uvec3(x, z, y) : uvec3(x, y, z)));
                mesh.materials.push_back(material);
            }
}

void add_cushion(Mesh& mesh, const Box3& box, float radius_m, int steps, std::uint32_t material) {
    const vec3 half = 0.5f * box.size();
    const float radius = std::min(radius_m, 0.98f * std::min({half.x, half.y, half.z}));
    const vec3 core = half - radius;
    const int segments = 4 * steps + 4, rings = 2 * steps + 1;
    // A ball pulled apart: its four quarters round, its two halves up and down.
    add_surface(
        mesh, {segments, rings}, true,
        [&](vec2 uv) {
            const int column = static_cast<int>(std::lround(uv.x * static_cast<float>(segments))) % segments;
            const int row = static_cast<int>(std::lround(uv.y * static_cast<float>(rings)));
            const int quarter = column / (steps + 1), step = column % (steps + 1);
            const float azimuth =
                -0.5f * pi * (static_cast<float>(quarter) + static_cast<float>(step) / static_cast<float>(steps));
            const bool upper = row > steps;
            const float share = static_cast<float>(upper ? row - steps - 1 : row) / static_cast<float>(steps);
            const float height = 0.5f * pi * (upper ? share : share - 1.0f);
            const bool pole = row == 0 || row == rings;
            const float ring = pole ? 0.0f : std::cos(height);
            const vec3 corner((quarter == 0 || quarter == 3) ? 1.0f : -1.0f, upper ? 1.0f : -1.0f,
                              quarter < 2 ? -1.0f : 1.0f);
            const vec3 direction(ring * std::cos(azimuth), std::sin(height), ring * std::sin(azimuth));
            return box.centre() + corner * core + radius * direction;
        },
        material);
    // Poles are flat rectangles there, not points: the two lids.
    const vec3 c = box.centre();
    add_quad(mesh, c + vec3(-core.x, half.y, -core.z), {0.0f, 0.0f, 2.0f * core.z}, {2.0f * core.x, 0.0f, 0.0f},
             material);
    add_quad(mesh, c + vec3(-core.x, -half.y, -core.z), {2.0f * core.x, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f * core.z},
             material);
}

void add_sweep(Mesh& mesh, std::span<const vec3> path, vec3 binormal, std::span<const vec2> profile, bool closed_path,
               std::uint32_t material) {
    const std::size_t count = path.size();
    const auto frame_at = [&](std::size_t i) {
        const vec3 before = path[i > 0 ? i - 1 : closed_path ? count - 1 : 0];
        const vec3 after = path[i + 1 < count ? i + 1 : closed_path ? 0 : count - 1];
        const vec3 along = glm::normalize(after - before);
        const vec3 across = glm::normalize(glm::cross(along, binormal));
        return std::pair{across, glm::cross(across, along)};
    };
    const std::size_t spans = closed_path ? count : count - 1;
    for (std::size_t edge = 0; edge < profile.size(); ++edge) {
        const vec2 a = profile[edge], b = profile[(edge + 1) % profile.size()];
        const vec2 outward = glm::normalize(vec2(b.y - a.y, a.x - b.x));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::size_t i = 0; i <= spans; ++i) {
            const std::size_t at = i % count;
            const auto [across, up] = frame_at(at);
            const vec3 normal = outward.x * across + outward.y * up;
            add_vertex(mesh, path[at] + a.x * across + a.y * up, normal);
            add_vertex(mesh, path[at] + b.x * across + b.y * up, normal);
        }
        for (std::uint32_t i = 0; i < spans; ++i) {
            const std::uint32_t at = first + 2 * i;
            add_triangle(mesh, {at, at + 3, at + 1}, material);
            add_triangle(mesh, {at, at + 2, at + 3}, material);
        }
    }
    if (closed_path) return;
    for (const bool end : {false, true}) {
        const std::size_t at = end ? count - 1 : 0;
        const auto [across, up] = frame_at(at);
        std::vector<vec3> corners;
        for (std::size_t k = 0; k < profile.size(); ++k) {
            const vec2 p = profile[end ? profile.size() - 1 - k : k];
            corners.push_back(path[at] + p.x * across + p.y * up);
        }
        add_outline(mesh, corners, material);
    }
}

void add_prism(Mesh& mesh, std::span<const vec2> outline, float low_y, float high_y, std::uint32_t wall,
               std::uint32_t top) {
    std::vector<vec3> lid;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const vec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        lid.push_back({a.x, high_y, a.y});
        add_polygon(mesh,
                    std::array<vec3, 4>{vec3(a.x, low_y, a.y), vec3(b.x, low_y, b.y), vec3(b.x, high_y, b.y),
                                        vec3(a.x, high_y, a.y)},
                    wall);
    }
    add_polygon(mesh, lid, top);
}

void add_leaf_cover(Mesh& mesh, const LeafCover& cover, Draws& draws, const std::function<SurfaceSpot(Draws&)>& spot) {
    for (std::uint32_t i = 0; i < cover.count; ++i) {
        const SurfaceSpot on = spot(draws);
        const vec3 random = any_direction(draws);
        const vec3 flat = random - on.normal * glm::dot(random, on.normal);
        const vec3 tangent = glm::dot(flat, flat) > 1e-4f ? glm::normalize(flat) : square_to(on.normal);
        const vec3 direction = glm::normalize(tangent + cover.steepness * draws.between(0.1f, 1.0f) * on.normal);
        const vec3 side = glm::normalize(glm::cross(direction, on.normal) + 0.5f * any_direction(draws));
        const vec3 across = glm::normalize(side - direction * glm::dot(side, direction));
        const float length = cover.length_m * draws.between(0.7f, 1.25f);
        add_leaf(mesh, on.point + draws.between(-0.2f, 1.0f) * cover.lift_m * on.normal, direction, across, length,
                 cover.width_share * length, cover.first + draws.below(cover.tones));
    }
}

SurfaceSpot spot_on_box(const Box3& box, Draws& draws) {
    const vec3 size = box.size();
    const float top = size.x * size.z, front = size.x * size.y, side = size.z * size.y;
    float pick = draws.unit() * (top + 2.0f * front + 2.0f * side);
    const vec3 unit(draws.unit(), draws.unit(), draws.unit());
    vec3 point = box.lowest + unit * size;
    if ((pick -= top) < 0.0f) {
        point.y = box.highest.y;
        return {point, {0.0f, 1.0f, 0.0f}};
    }
    const int axis = pick < 2.0f * front ? 2 : 0;
    const bool high = draws.unit() < 0.5f;
    point[axis] = high ? box.highest[axis] : box.lowest[axis];
    vec3 normal(0.0f);
    normal[axis] = high ? 1.0f : -1.0f;
    return {point, normal};
}

SurfaceSpot spot_on_cone(vec3 foot, float radius_m, float height_m, Draws& draws) {
    const float down = std::sqrt(draws.unit()), azimuth = 2.0f * pi * draws.unit();
    const vec3 outward(std::cos(azimuth), 0.0f, std::sin(azimuth));
    const vec3 normal = glm::normalize(height_m * outward + vec3(0.0f, radius_m, 0.0f));
    return {foot + radius_m * down * outward + vec3(0.0f, height_m * (1.0f - down), 0.0f), normal};
}

SurfaceSpot spot_on_ball(vec3 centre, vec3 radii, Draws& draws) {
    const vec3 direction = any_direction(draws);
    return {centre + radii * direction, glm::normalize(direction / radii)};
}

Mesh tree_mesh(const TreeShape& shape, std::uint32_t seed) {
    Mesh mesh;
    Draws draws{seed};
    const float bare = 0.32f * shape.height_m;
    const vec3 crown(0.0f, bare + 0.5f * (shape.height_m - bare), 0.0f);
    const vec3 radii(shape.crown_radius_m, 0.5f * (shape.height_m - bare), shape.crown_radius_m);
    std::vector<TubeRing> trunk;
    for (int i = 0; i <= 8; ++i) {
        const float t = static_cast<float>(i) / 8.0f;
        const vec3 sway(0.12f * std::sin(2.1f * t + static_cast<float>(seed)), 0.0f, 0.12f * std::sin(2.7f * t + 1.0f));
        trunk.push_back({t * (sway + vec3(0.0f, 0.86f * shape.height_m, 0.0f)),
                         shape.trunk_radius_m * (i == 0 ? 1.4f : 1.05f - 0.85f * t)});
    }
    add_tube(mesh, trunk, 10, shape.bark);
    // Clouds of leaves at the boughs' ends, on a spiral over the crown and inside it.
    constexpr int clouds = 26;
    for (int k = 0; k < clouds; ++k) {
        const float height = 1.0f - 2.0f * (static_cast<float>(k) + 0.5f) / clouds;
        const float azimuth = 2.39996f * static_cast<float>(k) + draws.between(-0.3f, 0.3f);
        const float ring = std::sqrt(1.0f - height * height);
        const vec3 unit(ring * std::cos(azimuth), height, ring * std::sin(azimuth));
        const vec3 middle = crown + draws.between(0.55f, 0.82f) * radii * unit;
        const float from = std::clamp(0.75f * (middle.y - 0.25f * radii.y) / (0.86f * shape.height_m), 0.30f, 0.95f);
        const auto ring_at = static_cast<std::size_t>(8.0f * from);
        const vec3 start = trunk[ring_at].centre;
        const vec3 bend = glm::mix(start, middle, 0.5f) + vec3(0.0f, 0.25f, 0.0f);
        const float thick = 0.4f * trunk[ring_at].radius;
        const std::array<TubeRing, 3> bough = {TubeRing{start, thick}, TubeRing{bend, 0.6f * thick},
                                               TubeRing{middle, 0.012f}};
        add_tube(mesh, bough, 3, shape.bark);
        const vec3 cloud =
            draws.between(0.36f, 0.5f) * vec3(shape.crown_radius_m, 0.8f * radii.y, shape.crown_radius_m);
        for (std::uint32_t i = static_cast<std::uint32_t>(k); i < shape.leaves; i += clouds) {
            const vec3 off = std::cbrt(draws.between(0.15f, 1.0f)) * any_direction(draws);
            const vec3 direction = glm::normalize(off + 0.8f * any_direction(draws) - vec3(0.0f, 0.25f, 0.0f));
            const vec3 level = glm::cross(direction, vec3(0.0f, 1.0f, 0.0f) + 0.6f * any_direction(draws));
            const vec3 side = glm::dot(level, level) > 1e-4f ? glm::normalize(level) : square_to(direction);
            const float length = shape.leaf_length_m * draws.between(0.75f, 1.25f);
            add_leaf(mesh, middle + cloud * off, direction, side, length, 0.56f * length,
                     shape.first_leaf + draws.below(shape.tones));
        }
    }
    return mesh;
}

float smooth_noise(vec2 place, std::uint32_t seed) {
    const vec2 cell = glm::floor(place), part = place - cell;
    const vec2 eased = part * part * (3.0f - 2.0f * part);
    const auto at = [&](float x, float y) {
        const auto column = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell.x + x));
        const auto row = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell.y + y));
        return random_unit(seed, column, row);
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), eased.x), glm::mix(at(0, 1), at(1, 1), eased.x), eased.y);
}

}  // namespace sightlines
