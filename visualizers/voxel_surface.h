// The voxels that are drawn, as exact faces between set and clear; and which of them a line of sight meets first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "visualizers/view_state.h"
#include "visualizers/voxel_row_picture.h"

namespace sightlines {

/// Voxels lowest <= index <= highest, per axis; empty where one of them is crossed.
struct VoxelBox {
    ivec3 lowest{0}, highest{-1};

    bool operator==(const VoxelBox&) const = default;
    bool empty() const { return lowest.x > highest.x || lowest.y > highest.y || lowest.z > highest.z; }
    bool contains(ivec3 voxel) const {
        return glm::all(glm::greaterThanEqual(voxel, lowest)) && glm::all(glm::lessThanEqual(voxel, highest));
    }
};

/// What the cut-away leaves, looking along `forward`. The cut is across the axis (v or w) that faces the camera most,
/// just behind the row, so that the row stands in front of it.
struct Cut {
    VoxelBox box;              ///< voxels that are drawn (the row's own come on top)
    int axis = 0;              ///< 1: v, 2: w; 0: nothing is cut
    bool keeps_higher = true;  ///< along the axis, whether the kept voxels have higher indices than the row

    bool operator==(const Cut&) const = default;
};
Cut cut_away(const VoxelRowPicture& picture, const ViewState& state, vec3 forward);

/// The plane between the row and what is kept behind it; the unit normal points to the kept side. World, m.
struct CutPlane {
    vec3 origin{0.0f}, normal{0.0f, 1.0f, 0.0f};

    bool operator==(const CutPlane&) const = default;
};
CutPlane cut_plane(const VoxelRowPicture& picture, const Cut& cut);

/// One face between a set voxel inside the box and what is clear or outside.
struct VoxelFace {
    std::array<ivec3, 4> corners;   ///< voxel coordinates, in order round the face
    std::array<float, 4> openness;  ///< ambient occlusion at the corners: 1 open, 0 shut in
    std::uint8_t axis = 0;          ///< 0 u, 1 v, 2 w
    bool towards_higher = false;    ///< the outward normal's sign
    bool section = false;           ///< the neighbour is set too, but cut away
};

/// All faces of the set voxels in the box, in index order.
std::vector<VoxelFace> voxel_faces(const VoxelRowPicture& picture, const VoxelBox& box);

/// A set voxel met by a line, and where: origin + distance * direction, in the units of `direction`.
struct MetVoxel {
    ivec3 voxel{0};
    float distance = 0.0f;
};

/// The first set voxel of the box along origin + t direction (voxel coordinates), t > 0; exact grid walk.
std::optional<MetVoxel> first_set_voxel(const VoxelRowPicture& picture, const VoxelBox& box, vec3 origin,
                                        vec3 direction);

}  // namespace sightlines
