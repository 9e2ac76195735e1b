#include "techniques/compute/buffer.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "techniques/base/error.h"
#include "techniques/compute/dispatch.h"

namespace sightlines::compute {
namespace {

constexpr std::uint64_t staging_bytes = 16u << 20u;
constexpr std::uint64_t page_bytes = 4096;
constexpr std::uint32_t no_memory_type = VK_MAX_MEMORY_TYPES;

DeviceOwned<VkBuffer, vkDestroyBuffer> make_handle(const Device& device, std::uint64_t bytes, VkBufferUsageFlags also,
                                                   const void* next) {
    VkBufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    create.pNext = next;
    create.size = bytes;
    create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                   VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                   VK_BUFFER_USAGE_TRANSFER_DST_BIT | also;
    VkBuffer handle = VK_NULL_HANDLE;
    check(vkCreateBuffer(device.logical.get(), &create, nullptr, &handle), device,
          "making a buffer of " + bytes_text(bytes));
    return {handle, {device.logical.get()}};
}

/// The first of the allowed memory types that has all `needed` properties, preferring one with all `wanted` too.
std::uint32_t memory_type(const Device& device, std::uint32_t allowed, VkMemoryPropertyFlags needed,
                          VkMemoryPropertyFlags wanted) {
    for (const VkMemoryPropertyFlags flags : {needed | wanted, needed})
        for (std::uint32_t type = 0; type < device.memory.memoryTypeCount; ++type)
            if ((allowed >> type & 1u) && (device.memory.memoryTypes[type].propertyFlags & flags) == flags) return type;
    return no_memory_type;
}

DeviceOwned<VkDeviceMemory, vkFreeMemory> allocate(const Device& device, std::uint64_t bytes, std::uint32_t type,
                                                   const void* next) {
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.pNext = next;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    create.pNext = &flags;
    create.allocationSize = bytes;
    create.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device.logical.get(), &create, nullptr, &memory), device, "allocating " + bytes_text(bytes));
    return {memory, {device.logical.get()}};
}

void bind(Buffer& buffer) {
    const Device& device = *buffer.device;
    check(vkBindBufferMemory(device.logical.get(), buffer.handle.get(), buffer.memory.get(), 0), device,
          "binding memory");
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = buffer.handle.get();
    buffer.address = vkGetBufferDeviceAddress(device.logical.get(), &address);
}

/// The memory types that the device would import this pointer as; 0: none.
std::uint32_t importable_types(const Device& device, const void* pointer) {
    const auto query = reinterpret_cast<PFN_vkGetMemoryHostPointerPropertiesEXT>(
        vkGetDeviceProcAddr(device.logical.get(), "vkGetMemoryHostPointerPropertiesEXT"));
    VkMemoryHostPointerPropertiesEXT properties{};
    properties.sType = VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT;
    const bool known = query && query(device.logical.get(), VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT,
                                      pointer, &properties) == VK_SUCCESS;
    return known ? properties.memoryTypeBits : 0;
}

void copy(const Device& device, VkBuffer from, std::uint64_t from_offset, VkBuffer to, std::uint64_t to_offset,
          std::uint64_t bytes) {
    submit(device, [&](VkCommandBuffer commands) {
        const VkBufferCopy region{from_offset, to_offset, bytes};
        vkCmdCopyBuffer(commands, from, to, 1, &region);
    });
}

}  // namespace

Buffer make_buffer(const std::shared_ptr<const Device>& device, std::uint64_t bytes, MemoryPlace place,
                   VkBufferUsageFlags also) {
    assert(bytes > 0);
    if (bytes > device->info.largest_allocation_bytes)
        throw EnvironmentError("Vulkan device " + device->info.name,
                               bytes_text(bytes) + " are needed in one piece, it allows " +
                                   bytes_text(device->info.largest_allocation_bytes),
                               "use the CPU backend, or a lower resolution");
    Buffer buffer;
    buffer.device = device;
    buffer.bytes = bytes;
    buffer.handle = make_handle(*device, bytes, also, nullptr);
    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(device->logical.get(), buffer.handle.get(), &requirements);
    const VkMemoryPropertyFlags reachable = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const std::uint32_t type =
        place == MemoryPlace::host
            ? memory_type(*device, requirements.memoryTypeBits, reachable, VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
            : memory_type(*device, requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, reachable);
    assert(type != no_memory_type);  // Vulkan promises both kinds for buffers
    buffer.memory = allocate(*device, requirements.size, type, nullptr);
    bind(buffer);
    if ((device->memory.memoryTypes[type].propertyFlags & reachable) == reachable) {
        void* pointer = nullptr;
        check(vkMapMemory(device->logical.get(), buffer.memory.get(), 0, VK_WHOLE_SIZE, 0, &pointer), *device,
              "mapping " + bytes_text(bytes));
        buffer.mapped = {static_cast<std::byte*>(pointer), bytes};
    }
    return buffer;
}

std::optional<Buffer> import_host_memory(const std::shared_ptr<const Device>& device,
                                         std::span<const std::byte> bytes) {
    const std::uint64_t alignment = device->import_alignment_bytes;
    // The size may be rounded up only within the last page: that much is there whenever its first byte is.
    if (alignment == 0 || alignment > page_bytes || bytes.empty()) return {};
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignment != 0) return {};
    const std::uint64_t whole = (bytes.size() + alignment - 1) / alignment * alignment;
    const std::uint32_t types = importable_types(*device, bytes.data());

    VkExternalMemoryBufferCreateInfo external{};
    external.sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO;
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
    Buffer buffer;
    buffer.device = device;
    buffer.bytes = bytes.size();
    buffer.handle = make_handle(*device, whole, 0, &external);
    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(device->logical.get(), buffer.handle.get(), &requirements);
    const std::uint32_t type = memory_type(*device, requirements.memoryTypeBits & types, 0, 0);
    if (type == no_memory_type || requirements.size > whole) return {};

    VkImportMemoryHostPointerInfoEXT import{};
    import.sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT;
    import.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
    import.pHostPointer = const_cast<std::byte*>(bytes.data());  // Vulkan has no read-only import; shaders only read
    buffer.memory = allocate(*device, whole, type, &import);
    bind(buffer);
    return buffer;
}

Buffer give_to_device(const std::shared_ptr<const Device>& device, std::span<const std::byte> bytes,
                      const Progress& progress) {
    // A discrete GPU could import too, but would read across the bus at every access.
    if (device->info.kind == DeviceKind::cpu || device->info.kind == DeviceKind::integrated_gpu)
        if (std::optional<Buffer> imported = import_host_memory(device, bytes)) return std::move(*imported);
    Buffer buffer = make_buffer(device, bytes.size(), MemoryPlace::device);
    upload(buffer, bytes, progress);
    return buffer;
}

void upload(const Buffer& buffer, std::span<const std::byte> bytes, const Progress& progress) {
    assert(bytes.size() <= buffer.bytes);
    const bool direct = !buffer.mapped.empty();
    Buffer staging;
    if (!direct) staging = make_buffer(buffer.device, std::min(staging_bytes, bytes.size()), MemoryPlace::host);
    for (std::uint64_t offset = 0; offset < bytes.size(); offset += staging_bytes) {
        progress.check();
        const std::uint64_t piece = std::min(staging_bytes, bytes.size() - offset);
        std::byte* target = direct ? buffer.mapped.data() + offset : staging.mapped.data();
        std::memcpy(target, bytes.data() + offset, piece);
        if (!direct) copy(*buffer.device, staging.handle.get(), 0, buffer.handle.get(), offset, piece);
    }
}

void download(const Buffer& buffer, std::span<std::byte> bytes, const Progress& progress) {
    assert(bytes.size() <= buffer.bytes);
    const bool direct = !buffer.mapped.empty();
    Buffer staging;
    if (!direct) staging = make_buffer(buffer.device, std::min(staging_bytes, bytes.size()), MemoryPlace::host);
    for (std::uint64_t offset = 0; offset < bytes.size(); offset += staging_bytes) {
        progress.check();
        const std::uint64_t piece = std::min(staging_bytes, bytes.size() - offset);
        if (!direct) copy(*buffer.device, buffer.handle.get(), offset, staging.handle.get(), 0, piece);
        const std::byte* source = direct ? buffer.mapped.data() + offset : staging.mapped.data();
        std::memcpy(bytes.data() + offset, source, piece);
    }
}

}  // namespace sightlines::compute
