// The view inside as data for ParaView.
#pragma once

#include <filesystem>
#include <vector>

#include "visualizers/voxel_row_picture.h"

namespace sightlines {

/// Writes into `folder`, world space, metres: voxel-row-voxels.vtp (all faces of the voxelization as quads; cell data
/// u, v, w), voxel-row-bits.vtp (the row's N cells as six quads each; cell data u, set, kept), voxel-row-ray.vtp (the
/// ray and its twin as lines; cell data twin), where objects move voxel-row-objects.vtp (all faces of those whose rows
/// were asked; cell data instance, blocked, u, v, w), voxel-row-scene.vtp (triangles, point normals), and last
/// voxel-row.vtm, which names them. Gives the files, the .vtm first. EnvironmentError where one cannot be written.
std::vector<std::filesystem::path> write_voxel_row_vtk(const VoxelRowPicture& picture,
                                                       const std::filesystem::path& folder);

}  // namespace sightlines
