// Where rays first hit, on a Vulkan device, by the GLSL compilation of the kernel.
#pragma once

#include <span>

#include "techniques/base/progress.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/vulkan_backend.h"

namespace sightlines::voxel_rows {

/// As first_hits but for rounding, of the array that `rows` was made from. In dispatches that are short enough for the
/// window, between which it looks whether it is cancelled.
void first_hits_on_vulkan(const VulkanRows& rows, const RowShape& query, std::span<const Segment> segments,
                          std::span<const vec3> normals, std::span<float> distances_m, const Progress& progress);

}  // namespace sightlines::voxel_rows
