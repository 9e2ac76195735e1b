#include "techniques/compute/ray_scene.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <vector>

#include "techniques/compute/dispatch.h"

namespace sightlines::compute {
namespace {

/// The loader does not export calls of extensions.
template <class Call>
Call call_named(const Device& device, const char* name) {
    const auto call = reinterpret_cast<Call>(vkGetDeviceProcAddr(device.logical.get(), name));
    assert(call != nullptr);  // the device was opened with the extension
    return call;
}

VkAccelerationStructureGeometryKHR geometry_of(const TriangleList& list) {
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    // Without a flag against it a candidate may be offered twice: that costs another look at it and changes nothing.
    geometry.flags = list.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : 0;
    VkAccelerationStructureGeometryTrianglesDataKHR& triangles = geometry.geometry.triangles;
    triangles.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    triangles.vertexData.deviceAddress = list.corners->address;
    triangles.vertexStride = list.stride_bytes;
    triangles.maxVertex = 3 * list.count - 1;
    triangles.indexType = VK_INDEX_TYPE_NONE_KHR;
    return geometry;
}

VkAccelerationStructureGeometryKHR geometry_of(const Buffer& instances) {
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    geometry.geometry.instances.data.deviceAddress = instances.address;
    return geometry;
}

AccelerationStructure make_structure(const std::shared_ptr<const Device>& device, VkAccelerationStructureTypeKHR type,
                                     std::uint64_t bytes) {
    AccelerationStructure made;
    made.memory =
        make_buffer(device, bytes, MemoryPlace::device, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
    VkAccelerationStructureCreateInfoKHR create{};
    create.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
    create.buffer = made.memory.handle.get();
    create.size = bytes;
    create.type = type;
    VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
    check(call_named<PFN_vkCreateAccelerationStructureKHR>(*device, "vkCreateAccelerationStructureKHR")(
              device->logical.get(), &create, nullptr, &handle),
          *device, "making an acceleration structure");
    const auto destroy =
        call_named<PFN_vkDestroyAccelerationStructureKHR>(*device, "vkDestroyAccelerationStructureKHR");
    made.handle = {handle, {device->logical.get(), destroy}};
    VkAccelerationStructureDeviceAddressInfoKHR address{};
    address.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
    address.accelerationStructure = handle;
    made.address = call_named<PFN_vkGetAccelerationStructureDeviceAddressKHR>(
        *device, "vkGetAccelerationStructureDeviceAddressKHR")(device->logical.get(), &address);
    return made;
}

/// `counts`: primitives of each geometry.
AccelerationStructure build(const std::shared_ptr<const Device>& device, VkAccelerationStructureTypeKHR type,
                            std::span<const VkAccelerationStructureGeometryKHR> geometries,
                            std::span<const std::uint32_t> counts) {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    info.type = type;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = static_cast<std::uint32_t>(geometries.size());
    info.pGeometries = geometries.data();
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    call_named<PFN_vkGetAccelerationStructureBuildSizesKHR>(*device, "vkGetAccelerationStructureBuildSizesKHR")(
        device->logical.get(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, counts.data(), &sizes);
    AccelerationStructure made = make_structure(device, type, sizes.accelerationStructureSize);
    const std::uint64_t alignment = device->scratch_alignment_bytes;
    const Buffer scratch = make_buffer(device, sizes.buildScratchSize + alignment, MemoryPlace::device);
    info.dstAccelerationStructure = made.handle.get();
    info.scratchData.deviceAddress = (scratch.address + alignment - 1) / alignment * alignment;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges(counts.size());
    for (std::size_t k = 0; k < counts.size(); ++k) ranges[k].primitiveCount = counts[k];
    const VkAccelerationStructureBuildRangeInfoKHR* first_range = ranges.data();
    const auto record =
        call_named<PFN_vkCmdBuildAccelerationStructuresKHR>(*device, "vkCmdBuildAccelerationStructuresKHR");
    submit(*device, [&](VkCommandBuffer commands) { record(commands, 1, &info, &first_range); });
    return made;
}

}  // namespace

RayScene build_ray_scene(const std::shared_ptr<const Device>& device, std::span<const TriangleList> lists) {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<std::uint32_t> counts;
    std::uint64_t triangles = 0;
    for (const TriangleList& list : lists) {
        if (list.count == 0) continue;
        geometries.push_back(geometry_of(list));
        counts.push_back(list.count);
        triangles += list.count;
    }
    assert(triangles <= device->most_query_triangles);
    RayScene made;
    VkAccelerationStructureInstanceKHR instance{};
    if (triangles > 0) {
        made.triangles = build(device, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometries, counts);
        for (int axis = 0; axis < 3; ++axis) instance.transform.matrix[axis][axis] = 1.0f;
        instance.mask = 0xff;
        instance.accelerationStructureReference = made.triangles.address;
    }
    const Buffer instances = make_buffer(device, sizeof instance, MemoryPlace::host, holds_triangles);
    std::memcpy(instances.mapped.data(), &instance, sizeof instance);
    const VkAccelerationStructureGeometryKHR geometry = geometry_of(instances);
    const std::uint32_t count = triangles > 0 ? 1 : 0;
    made.scene =
        build(device, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, std::span(&geometry, 1), std::span(&count, 1));
    return made;
}

}  // namespace sightlines::compute
