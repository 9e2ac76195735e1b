// Algorithm 4 on a Vulkan device, by the GLSL compilation of the kernel.
#pragma once

#include <memory>

#include "techniques/rays/reference.h"
#include "techniques/technique.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/vulkan_objects.h"

namespace sightlines::voxel_rows {

/// The array's rows and frames where the device's shaders reach them, and the pipelines that ask them.
struct VulkanRows;

/// Takes the array's words over without a copy where the device can; the array must then outlive the result.
/// EnvironmentError where there is no device.
std::shared_ptr<const VulkanRows> give_to_vulkan(const RowArray& array, Progress& progress);

/// As render_on_cpu.
RenderResult render_on_vulkan(const VulkanRows& rows, const RowArray& array, const RenderRequest& request,
                              Progress& progress, const ObjectsOnDevice& objects = {});

/// As count_blocked_on_cpu.
QueryCount count_blocked_on_vulkan(const VulkanRows& rows, const RowArray& array, const RenderRequest& request,
                                   const ObjectsOnDevice& objects = {});

}  // namespace sightlines::voxel_rows
