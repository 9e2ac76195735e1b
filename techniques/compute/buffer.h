// Memory that shaders reach by address.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "techniques/base/progress.h"
#include "techniques/compute/device.h"

namespace sightlines::compute {

/// A buffer in an allocation of its own, usable by its device address (16-byte aligned) and for copies.
struct Buffer {
    std::shared_ptr<const Device> device;
    DeviceOwned<VkDeviceMemory, vkFreeMemory> memory;
    DeviceOwned<VkBuffer, vkDestroyBuffer> handle;
    VkDeviceAddress address = 0;
    std::uint64_t bytes = 0;
    std::span<std::byte> mapped;  ///< coherent; empty where the CPU cannot reach it
};

enum class MemoryPlace {
    host,    ///< the CPU reads and writes it; the device reaches it, perhaps slowly
    device,  ///< fastest for the device; mapped too where its memory is the CPU's (software and integrated devices)
};

/// Uninitialised. EnvironmentError: larger than the device allows, or out of memory (says how much was asked).
/// `also`: uses besides those of every buffer.
Buffer make_buffer(const std::shared_ptr<const Device>& device, std::uint64_t bytes, MemoryPlace place,
                   VkBufferUsageFlags also = 0);

/// The host's memory itself as a buffer, without a copy; nothing where the device cannot (no extension, or `bytes` does
/// not start on the alignment it wants). The memory must outlive the buffer, and shaders may only read it.
std::optional<Buffer> import_host_memory(const std::shared_ptr<const Device>& device, std::span<const std::byte> bytes);

/// `bytes` for shaders to read, in the cheapest way: imported where device and CPU share their memory, else copied. The
/// memory must outlive the buffer.
Buffer give_to_device(const std::shared_ptr<const Device>& device, std::span<const std::byte> bytes,
                      const Progress& progress);

/// Copies to the buffer's start or from it, through a staging buffer where it is not mapped; in pieces, so that it can
/// be cancelled. Waits until done.
void upload(const Buffer& buffer, std::span<const std::byte> bytes, const Progress& progress);
void download(const Buffer& buffer, std::span<std::byte> bytes, const Progress& progress);

}  // namespace sightlines::compute
