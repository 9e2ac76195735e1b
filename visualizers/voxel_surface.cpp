#include "visualizers/voxel_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightlines {
namespace {

/// Minecraft-style corner occlusion: of the three voxels round a corner of a face, on its open side, how many are
/// clear. Two set edges shut the corner whatever the diagonal is.
float corner_openness(bool edge_a, bool edge_b, bool diagonal) {
    if (edge_a && edge_b) return 0.0f;
    return 1.0f - (static_cast<float>(edge_a) + static_cast<float>(edge_b) + static_cast<float>(diagonal)) / 3.0f;
}

VoxelFace face_of(const VoxelRowPicture& picture, const VoxelBox& box, ivec3 voxel, int axis, bool towards_higher) {
    const int across = (axis + 1) % 3, along = (axis + 2) % 3;
    const auto shown = [&](ivec3 at) { return box.contains(at) && is_set(picture, at); };
    ivec3 outside = voxel;
    outside[axis] += towards_higher ? 1 : -1;
    VoxelFace face;
    face.axis = static_cast<std::uint8_t>(axis);
    face.towards_higher = towards_higher;
    constexpr int round[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
        face.corners[i] = voxel;
        face.corners[i][axis] += towards_higher ? 1 : 0;
        face.corners[i][across] += round[i][0];
        face.corners[i][along] += round[i][1];
        ivec3 edge_a = outside, edge_b = outside;
        edge_a[across] += round[i][0] == 1 ? 1 : -1;
        edge_b[along] += round[i][1] == 1 ? 1 : -1;
        ivec3 diagonal = edge_a;
        diagonal[along] = edge_b[along];
        face.openness[i] = corner_openness(shown(edge_a), shown(edge_b), shown(diagonal));
    }
    return face;
}

}  // namespace

Cut cut_away(const VoxelRowPicture& picture, const ViewState& state, vec3 forward) {
    const int last = picture.resolution - 1;
    Cut cut;
    cut.box.lowest = ivec3(std::clamp(state.slice_first, 0, last), 0, 0);
    cut.box.highest = ivec3(std::clamp(state.slice_last, 0, last), last, last);
    const float along_v = glm::dot(forward, glm::normalize(vec3(picture.world_from_voxels[1])));
    const float along_w = glm::dot(forward, glm::normalize(vec3(picture.world_from_voxels[2])));
    cut.axis = std::abs(along_v) >= std::abs(along_w) ? 1 : 2;
    cut.keeps_higher = (cut.axis == 1 ? along_v : along_w) > 0.0f;
    if (state.cut_away == CutAway::none) return cut;
    const int row = cut.axis == 1 ? picture.v : picture.w, layers = std::max(state.slab_voxels, 1);
    cut.box.lowest[cut.axis] = cut.keeps_higher ? row + 1 : std::max(row - layers, 0);
    cut.box.highest[cut.axis] = cut.keeps_higher ? std::min(row + layers, last) : row - 1;
    return cut;
}

CutPlane cut_plane(const VoxelRowPicture& picture, const Cut& cut) {
    vec3 on_cut(0.0f);
    // A hair behind the voxels' section, so that the two do not flicker through each other.
    const float hair = cut.keeps_higher ? 1.05f : -0.05f;
    on_cut[cut.axis] = static_cast<float>(cut.axis == 1 ? picture.v : picture.w) + hair;
    const vec3 higher = glm::normalize(vec3(picture.world_from_voxels[cut.axis]));
    return {world_point(picture, on_cut), cut.keeps_higher ? higher : -higher};
}

std::vector<VoxelFace> voxel_faces(const VoxelRowPicture& picture, const VoxelBox& box) {
    std::vector<VoxelFace> faces;
    const VoxelBox whole{ivec3(0), ivec3(picture.resolution - 1)};
    for (int w = box.lowest.z; w <= box.highest.z; ++w)
        for (int v = box.lowest.y; v <= box.highest.y; ++v)
            for (int u = box.lowest.x; u <= box.highest.x; ++u) {
                const ivec3 voxel{u, v, w};
                if (!is_set(picture, voxel)) continue;
                for (int side = 0; side < 6; ++side) {
                    const int axis = side / 2;
                    const bool towards_higher = side % 2 == 1;
                    ivec3 neighbour = voxel;
                    neighbour[axis] += towards_higher ? 1 : -1;
                    const bool neighbour_set = whole.contains(neighbour) && is_set(picture, neighbour);
                    if (neighbour_set && box.contains(neighbour)) continue;
                    faces.push_back(face_of(picture, box, voxel, axis, towards_higher));
                    faces.back().section = neighbour_set;
                }
            }
    return faces;
}

std::optional<MetVoxel> first_set_voxel(const VoxelRowPicture& picture, const VoxelBox& box, vec3 origin,
                                        vec3 direction) {
    if (box.empty()) return std::nullopt;
    const dvec3 from(origin), step(direction);
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.lowest[axis], high = box.highest[axis] + 1.0;
        if (step[axis] == 0.0) {
            if (from[axis] < low || from[axis] >= high) return std::nullopt;
            continue;
        }
        const double a = (low - from[axis]) / step[axis], b = (high - from[axis]) / step[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    if (enter >= leave) return std::nullopt;

    ivec3 voxel(0);
    for (int axis = 0; axis < 3; ++axis) {
        // On the face where the line enters, rounding must not put the voxel outside the box.
        const double at = from[axis] + enter * step[axis];
        voxel[axis] = std::clamp(static_cast<int>(std::floor(at)), box.lowest[axis], box.highest[axis]);
    }
    for (double distance = enter; box.contains(voxel);) {
        if (is_set(picture, voxel)) return MetVoxel{voxel, static_cast<float>(distance)};
        int next_axis = 0;
        double next = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            if (step[axis] == 0.0) continue;
            const double wall = voxel[axis] + (step[axis] > 0.0 ? 1.0 : 0.0);
            const double reach = (wall - from[axis]) / step[axis];
            if (reach < next) {
                next = reach;
                next_axis = axis;
            }
        }
        voxel[next_axis] += step[next_axis] > 0.0 ? 1 : -1;
        distance = next;
    }
    return std::nullopt;
}

}  // namespace sightlines
