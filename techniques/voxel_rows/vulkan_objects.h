// Algorithm 5 on a Vulkan device: a second dispatch asks the objects for the rays that pass what stands still.
#pragma once

#include <memory>

#include "shaders/voxel_row_objects_data.h"
#include "techniques/compute/buffer.h"
#include "techniques/compute/dispatch.h"
#include "techniques/voxel_rows/object_rows.h"

namespace sightlines::voxel_rows {

/// The arrays of all types of objects where the device's shaders reach them, and the pipelines that ask them.
struct VulkanObjects;

/// As give_to_vulkan; all types have the same resolution. The arrays must outlive the result.
std::shared_ptr<const VulkanObjects> give_objects_to_vulkan(std::span<const RowArray> types, Progress& progress);

/// Objects and where their arrays lie on the device; null without objects. Both must outlive it.
struct ObjectsOnDevice {
    const VulkanObjects* on_device = nullptr;
    Objects objects;

    bool empty() const { return on_device == nullptr || objects.empty(); }
};

/// Memory and pipeline for asking the objects of one picture. The buffers of the job's addresses are the caller's.
struct ObjectAsker {
    const compute::Pipeline* pipeline = nullptr;
    compute::Buffer table;
    ObjectLightingJob job{};
};

/// `kind_of_all_lights` as the shader takes it. The job lacks the addresses but for that of the objects.
ObjectAsker make_object_asker(const ObjectsOnDevice& objects, const ParameterValues& parameters, bool shade,
                              std::uint32_t kind_of_all_lights, float reach_m, const Progress& progress);

/// Asks for the rays of lights first to end - 1. Returns the device's seconds.
double ask_objects(ObjectAsker& asker, std::uint32_t first_light, std::uint32_t end_light, std::uint32_t groups);

}  // namespace sightlines::voxel_rows
