// Triangles that shaders ask by ray queries, on devices that have them (DeviceInfo::queries_rays).
#pragma once

#include <span>

#include "techniques/compute/buffer.h"

namespace sightlines::compute {

/// What a buffer must also be for its triangles to be given to build_ray_scene.
constexpr VkBufferUsageFlags holds_triangles = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

/// Some of a scene's triangles, three corners each, one after the other. Shaders know them by the list's number among
/// those that are not empty (the geometry), and their own (the primitive).
struct TriangleList {
    const Buffer* corners = nullptr;  ///< [count][3], m; each three floats at the start of `stride_bytes`
    std::uint64_t stride_bytes = 12;
    std::uint32_t count = 0;  ///< of triangles
    bool opaque = true;       ///< else shaders are asked which hits count
};

struct AccelerationStructureDeleter {
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkDestroyAccelerationStructureKHR destroy = nullptr;
    void operator()(VkAccelerationStructureKHR handle) const { destroy(device, handle, nullptr); }
};

/// Boxes over triangles, or over other such structures, by the driver.
struct AccelerationStructure {
    Buffer memory;
    std::unique_ptr<VkAccelerationStructureKHR_T, AccelerationStructureDeleter> handle;
    VkDeviceAddress address = 0;
};

/// What shaders ask: in GLSL `accelerationStructureEXT(address)`.
struct RayScene {
    AccelerationStructure triangles;  ///< empty without triangles
    AccelerationStructure scene;

    VkDeviceAddress address() const { return scene.address; }
    std::uint64_t bytes() const { return triangles.memory.bytes + scene.memory.bytes; }
};

/// Waits until it is built, in one piece; the lists' buffers may go then. At most device->most_query_triangles in all.
/// EnvironmentError: out of memory.
RayScene build_ray_scene(const std::shared_ptr<const Device>& device, std::span<const TriangleList> lists);

}  // namespace sightlines::compute
