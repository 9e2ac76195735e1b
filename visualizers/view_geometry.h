// The solid part of the view as triangles with colours: what VTK is given. Lit here, once, so that orbiting costs
// nothing but drawing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "visualizers/theme.h"
#include "visualizers/voxel_row_picture.h"
#include "visualizers/voxel_surface.h"

namespace sightlines {

struct ColouredTriangles {
    std::vector<vec3> positions;       ///< world, m
    std::vector<glm::u8vec3> colours;  ///< [positions] sRGB
    std::vector<uvec3> triangles;
};

/// The scene's mesh in the theme's ghost colour, without the triangles that lie wholly on the cut plane's other side.
ColouredTriangles ghost_triangles(const Scene& scene, const CutPlane& cut, const Palette& colours);

/// The faces of the voxels in the box.
ColouredTriangles voxel_triangles(const VoxelRowPicture& picture, const VoxelBox& box, const Palette& colours);

/// Appends a flat patch, lit by its normal; corners in order.
void add_quad(ColouredTriangles& out, const std::array<vec3, 4>& corners, vec3 colour);

/// A box along the world's axes.
struct ColouredBox {
    Box3 box;  ///< m
    vec3 colour{0.0f};
};

/// Their faces, lit; a hair smaller than the boxes, so that neighbours can be told apart.
ColouredTriangles box_triangles(std::span<const ColouredBox> boxes);

/// A box in voxel coordinates.
struct CellBox {
    vec3 low{0.0f}, high{0.0f};
};
/// What is drawn for the row's cell u: a hair smaller than the voxel, and slimmer outside the extent.
CellBox row_cell(const VoxelRowPicture& picture, int u, bool mark_extent);

/// The row as a bar of N cells: set voxels are filled cubes, clear ones open frames; outside [first, last] both are
/// smaller and paler. `mark_extent` off: all alike.
ColouredTriangles row_triangles(const VoxelRowPicture& picture, const Palette& colours, bool mark_extent);

}  // namespace sightlines
