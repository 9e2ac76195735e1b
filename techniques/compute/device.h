// A Vulkan device for compute: which ones there are, and one opened. Plain structs around Vulkan's own handles.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <vulkan/vulkan.h>

namespace sightlines::compute {

enum class DeviceKind { discrete_gpu, integrated_gpu, virtual_gpu, cpu, other };

/// "discrete GPU", "CPU" ...
std::string_view title(DeviceKind kind);

/// What people and programs want to know of a device.
struct DeviceInfo {
    std::string name;  ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
    DeviceKind kind = DeviceKind::other;
    std::string driver;              ///< "llvmpipe, Mesa 22.3.6"
    std::string vulkan_version;      ///< "1.3.230"
    std::uint64_t memory_bytes = 0;  ///< of the largest heap that is the device's own
    std::uint64_t largest_allocation_bytes = 0;
    std::uint64_t largest_storage_range_bytes = 0;  ///< of a bound buffer; device addresses reach further
    std::uint32_t subgroup_size = 0;
    std::uint32_t largest_workgroup = 0;  ///< invocations
    bool imports_host_memory = false;     ///< VK_EXT_external_memory_host
    bool queries_rays = false;            ///< VK_KHR_ray_query over VK_KHR_acceleration_structure
    std::string lacks;                    ///< what it lacks of what we need; empty: usable
};

/// Every Vulkan device of this machine in the order of preference: real GPUs first, the unusable last. Empty without a
/// Vulkan driver.
std::vector<DeviceInfo> list_devices();

// Vulkan's handles as unique_ptr. They are pointers to incomplete structs on every 64-bit platform.
static_assert(sizeof(void*) == 8);

struct InstanceDeleter {
    void operator()(VkInstance instance) const { vkDestroyInstance(instance, nullptr); }
};
struct MessengerDeleter {
    VkInstance instance = VK_NULL_HANDLE;
    void operator()(VkDebugUtilsMessengerEXT messenger) const;
};
struct LogicalDeviceDeleter {
    void operator()(VkDevice device) const { vkDestroyDevice(device, nullptr); }
};
template <auto destroy>
struct DeviceDeleter {
    VkDevice device = VK_NULL_HANDLE;
    template <class Handle>
    void operator()(Handle handle) const {
        destroy(device, handle, nullptr);
    }
};
template <class Handle, auto destroy>
using DeviceOwned = std::unique_ptr<std::remove_pointer_t<Handle>, DeviceDeleter<destroy>>;

using OwnedInstance = std::unique_ptr<std::remove_pointer_t<VkInstance>, InstanceDeleter>;
using OwnedMessenger = std::unique_ptr<std::remove_pointer_t<VkDebugUtilsMessengerEXT>, MessengerDeleter>;
using OwnedLogicalDevice = std::unique_ptr<std::remove_pointer_t<VkDevice>, LogicalDeviceDeleter>;

/// An opened device with one compute queue. Buffers and pipelines share its ownership.
struct Device {
    DeviceInfo info;
    std::atomic<int> validation_errors = 0;  ///< reported by the validation layer so far
    OwnedInstance instance;
    OwnedMessenger messenger;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    OwnedLogicalDevice logical;
    std::uint32_t queue_family = 0;
    VkQueue queue = VK_NULL_HANDLE;
    DeviceOwned<VkCommandPool, vkDestroyCommandPool> command_pool;
    VkPhysicalDeviceMemoryProperties memory{};
    std::uint64_t import_alignment_bytes = 0;   ///< of imported host memory's start and size; 0: cannot import
    std::uint64_t most_query_triangles = 0;     ///< in one acceleration structure; 0: no ray queries
    std::uint64_t scratch_alignment_bytes = 1;  ///< of memory that acceleration structures are built in
    double seconds_per_tick = 0.0;              ///< of timestamps; 0: the queue has none
    mutable std::mutex submission;  ///< held while recording and submitting: pool and queue are one thread's
};

/// Opens the device called `name`, or the most preferred one where `name` is empty. Needs Vulkan 1.3,
/// bufferDeviceAddress and scalarBlockLayout. With the environment variable SIGHTLINES_VULKAN_VALIDATION=1, and in
/// debug builds, the Khronos validation layer is on where it is installed; its messages go to standard error.
/// EnvironmentError: no driver, no usable device (says what is lacking); InputError: no device of that name.
std::shared_ptr<const Device> open_device(const std::string& name = {});

/// EnvironmentError where a Vulkan call failed: `action` ("allocating 2.1 GB") and the result's name.
void check(VkResult result, const Device& device, std::string_view action);

/// "2.12 GB", "64.0 MB": decimal units, three digits.
std::string bytes_text(std::uint64_t bytes);

}  // namespace sightlines::compute
