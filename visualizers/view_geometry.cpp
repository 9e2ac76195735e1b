#include "visualizers/view_geometry.h"

#include <algorithm>
#include <cmath>

namespace sightlines {
namespace {

/// How much of the light the ghosted scene shows: little, so that it stays behind.
constexpr float ghost_contrast = 0.45f;

/// Light that belongs to the world, not to the camera: sky above, a window on one side. Both sides of a surface alike.
float light_on(vec3 normal) {
    const vec3 side = glm::normalize(vec3(0.55f, 0.0f, 0.83f));
    return 0.80f + 0.17f * normal.y + 0.10f * (std::abs(glm::dot(normal, side)) - 0.5f);
}

glm::u8vec3 bytes(vec3 colour) { return glm::u8vec3(glm::clamp(colour, 0.0f, 1.0f) * 255.0f + 0.5f); }

/// Unit normals of the voxel grid's three axes in the world (its box may be oblong, its axes stay square to each
/// other).
mat3 world_axes(const VoxelRowPicture& picture) {
    const mat3 m(picture.world_from_voxels);
    return mat3(glm::normalize(m[0]), glm::normalize(m[1]), glm::normalize(m[2]));
}

void add_quad(ColouredTriangles& out, const std::array<vec3, 4>& corners, const std::array<vec3, 4>& colours,
              bool other_diagonal) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (std::size_t i = 0; i < 4; ++i) {
        out.positions.push_back(corners[i]);
        out.colours.push_back(bytes(colours[i]));
    }
    const std::uint32_t turn = other_diagonal ? 1 : 0;
    out.triangles.push_back(uvec3(turn, turn + 1, turn + 2) + first);
    out.triangles.push_back(uvec3(turn, turn + 2, (turn + 3) % 4) + first);
}

/// A box between two points in voxel coordinates.
void add_box(ColouredTriangles& out, const VoxelRowPicture& picture, vec3 low, vec3 high, vec3 colour) {
    const mat3 axes = world_axes(picture);
    for (int axis = 0; axis < 3; ++axis)
        for (const bool higher : {false, true}) {
            const int across = (axis + 1) % 3, along = (axis + 2) % 3;
            std::array<vec3, 4> corners;
            for (std::size_t i = 0; i < 4; ++i) {
                vec3 corner;
                corner[axis] = higher ? high[axis] : low[axis];
                corner[across] = i == 1 || i == 2 ? high[across] : low[across];
                corner[along] = i >= 2 ? high[along] : low[along];
                corners[i] = world_point(picture, corner);
            }
            const vec3 lit = colour * glm::mix(1.0f, light_on(higher ? axes[axis] : -axes[axis]), 0.7f);
            add_quad(out, corners, {lit, lit, lit, lit}, false);
        }
}

/// The twelve edges of a box as bars of `thickness` (voxels), inside it.
void add_frame(ColouredTriangles& out, const VoxelRowPicture& picture, vec3 low, vec3 high, float thickness,
               vec3 colour) {
    for (int axis = 0; axis < 3; ++axis) {
        const int across = (axis + 1) % 3, along = (axis + 2) % 3;
        for (int corner = 0; corner < 4; ++corner) {
            vec3 from = low, to = high;
            from[across] = corner % 2 == 0 ? low[across] : high[across] - thickness;
            to[across] = from[across] + thickness;
            from[along] = corner / 2 == 0 ? low[along] : high[along] - thickness;
            to[along] = from[along] + thickness;
            add_box(out, picture, from, to, colour);
        }
    }
}

bool is_kept(const VoxelRowPicture& picture, int u, bool mark_extent) {
    return !mark_extent || (u >= picture.first && u <= picture.last);
}

}  // namespace

ColouredTriangles ghost_triangles(const Scene& scene, const CutPlane& cut, const Palette& colours) {
    ColouredTriangles out;
    out.positions = scene.positions;
    const auto is_behind = [&](std::uint32_t vertex) {
        return glm::dot(scene.positions[vertex] - cut.origin, cut.normal) >= 0.0f;
    };
    for (const uvec3& triangle : scene.triangles)
        if (is_behind(triangle.x) || is_behind(triangle.y) || is_behind(triangle.z)) out.triangles.push_back(triangle);
    out.colours.reserve(scene.positions.size());
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
        const vec3 normal = i < scene.normals.size() ? scene.normals[i] : vec3(0.0f, 1.0f, 0.0f);
        out.colours.push_back(bytes(colours.ghost * glm::mix(1.0f, light_on(normal), ghost_contrast)));
    }
    return out;
}

ColouredTriangles voxel_triangles(const VoxelRowPicture& picture, const VoxelBox& box, const Palette& colours) {
    ColouredTriangles out;
    const mat3 axes = world_axes(picture);
    for (const VoxelFace& face : voxel_faces(picture, box)) {
        const vec3 normal = face.towards_higher ? axes[face.axis] : -axes[face.axis];
        const vec3 lit = (face.section ? colours.section : colours.voxel) * light_on(normal);
        std::array<vec3, 4> corners, shaded;
        for (std::size_t i = 0; i < 4; ++i) {
            corners[i] = world_point(picture, vec3(face.corners[i]));
            shaded[i] = lit * (face.section ? 1.0f : 0.62f + 0.38f * face.openness[i]);
        }
        // Splits along the diagonal that keeps the shading even (no bright or dark seam).
        const bool other = face.openness[0] + face.openness[2] < face.openness[1] + face.openness[3];
        add_quad(out, corners, shaded, other);
    }
    return out;
}

void add_quad(ColouredTriangles& out, const std::array<vec3, 4>& corners, vec3 colour) {
    const vec3 normal = glm::cross(corners[2] - corners[0], corners[3] - corners[1]);
    const float length = glm::length(normal);
    const vec3 lit = colour * glm::mix(1.0f, light_on(length > 0.0f ? normal / length : vec3(0.0f)), 0.7f);
    add_quad(out, corners, {lit, lit, lit, lit}, false);
}

ColouredTriangles box_triangles(std::span<const ColouredBox> boxes) {
    constexpr float inset = 0.03f;  // of a side
    VoxelRowPicture world;          // a voxel is a metre
    ColouredTriangles out;
    for (const ColouredBox& each : boxes) {
        const vec3 margin = inset * each.box.size();
        add_box(out, world, each.box.lowest + margin, each.box.highest - margin, each.colour);
    }
    return out;
}

CellBox row_cell(const VoxelRowPicture& picture, int u, bool mark_extent) {
    const vec3 low(static_cast<float>(u), static_cast<float>(picture.v), static_cast<float>(picture.w));
    const float inset = is_kept(picture, u, mark_extent) ? 0.02f : 0.22f;
    return {low + vec3(0.02f, inset, inset), low + vec3(0.98f, 1.0f - inset, 1.0f - inset)};
}

ColouredTriangles row_triangles(const VoxelRowPicture& picture, const Palette& colours, bool mark_extent) {
    ColouredTriangles out;
    for (int u = 0; u < picture.resolution; ++u) {
        const bool kept = is_kept(picture, u, mark_extent);
        const CellBox cell = row_cell(picture, u, mark_extent);
        if (is_set(picture, {u, picture.v, picture.w})) {
            const vec3 colour = kept ? colours.set_bit : colours.set_bit_clipped;
            add_box(out, picture, cell.low + 0.02f, cell.high - 0.02f, colour);
            add_frame(out, picture, cell.low, cell.high, 0.08f, colour * 0.66f);
        } else {
            add_frame(out, picture, cell.low, cell.high, kept ? 0.07f : 0.05f,
                      kept ? colours.clear_bit : colours.clear_bit_clipped);
        }
    }
    return out;
}

}  // namespace sightlines
