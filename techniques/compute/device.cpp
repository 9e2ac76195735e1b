#include "techniques/compute/device.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>

#include "techniques/base/error.h"
#include "techniques/compute/instance.h"

namespace sightlines::compute {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL on_validation_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                     VkDebugUtilsMessageTypeFlagsEXT,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* errors) {
    if (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) ++*static_cast<std::atomic<int>*>(errors);
    std::fprintf(stderr, "Vulkan validation: %s\n", data->pMessage);
    return VK_FALSE;
}

OwnedMessenger make_messenger(VkInstance instance, std::atomic<int>& errors) {
    VkDebugUtilsMessengerCreateInfoEXT create{};
    create.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    create.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    create.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    create.pfnUserCallback = on_validation_message;
    create.pUserData = &errors;
    const auto make = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    if (!make || make(instance, &create, nullptr, &messenger) != VK_SUCCESS) return {};
    return OwnedMessenger(messenger, MessengerDeleter{instance});
}

/// The device that `name` asks for, or the first usable one.
FoundDevice choose(std::vector<FoundDevice> found, const std::string& name) {
    if (found.empty())
        throw EnvironmentError("Vulkan", "no device found", "install a driver, for example mesa-vulkan-drivers");
    FoundDevice* chosen = nullptr;
    std::vector<std::string> names;
    for (FoundDevice& device : found) {
        if (!chosen && (name.empty() || device.info.name == name)) chosen = &device;
        names.push_back(device.info.name);
    }
    if (!chosen) {
        const std::string nearest = nearest_name(name, names);
        throw InputError("--device", "", "no Vulkan device is called `" + name + "`",
                         "did you mean `" + (nearest.empty() ? names.front() : nearest) + "`?");
    }
    if (!chosen->info.lacks.empty())
        throw EnvironmentError("Vulkan device " + chosen->info.name, "lacks " + chosen->info.lacks,
                               "use the CPU backend, or a newer driver");
    return std::move(*chosen);
}

/// A family with compute and, where there is one, without graphics: such a queue leaves the window's alone.
std::uint32_t choose_queue_family(VkPhysicalDevice physical, std::uint32_t& timestamp_bits) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    std::uint32_t chosen = count;
    for (std::uint32_t family = 0; family < count; ++family) {
        const VkQueueFlags flags = families[family].queueFlags;
        if (!(flags & VK_QUEUE_COMPUTE_BIT)) continue;
        if (chosen == count || !(flags & VK_QUEUE_GRAPHICS_BIT)) chosen = family;
    }
    timestamp_bits = families[chosen].timestampValidBits;
    return chosen;
}

OwnedLogicalDevice make_logical_device(const Device& device) {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = device.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan12Features features_12{};
    features_12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features_12.bufferDeviceAddress = VK_TRUE;
    features_12.scalarBlockLayout = VK_TRUE;
    VkPhysicalDeviceVulkan13Features features_13{};
    features_13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    features_13.maintenance4 = VK_TRUE;  // glslc writes workgroup sizes as LocalSizeId; every Vulkan 1.3 device has it
    features_12.pNext = &features_13;
    VkPhysicalDeviceRayQueryFeaturesKHR queries{};
    queries.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    queries.rayQuery = VK_TRUE;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures{};
    structures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    structures.accelerationStructure = VK_TRUE;
    structures.pNext = &queries;
    std::vector<const char*> extensions;
    if (device.info.imports_host_memory) extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
    if (device.info.queries_rays) {
        extensions.insert(extensions.end(), ray_query_extensions.begin(), ray_query_extensions.end());
        features_13.pNext = &structures;
    }
    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = &features_12;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    VkDevice logical = VK_NULL_HANDLE;
    check(vkCreateDevice(device.physical, &create, nullptr, &logical), device, "opening it");
    return OwnedLogicalDevice(logical);
}

void read_limits(Device& device, std::uint32_t timestamp_bits) {
    VkPhysicalDeviceExternalMemoryHostPropertiesEXT host_memory{};
    host_memory.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT;
    VkPhysicalDeviceAccelerationStructurePropertiesKHR structures{};
    structures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    if (device.info.imports_host_memory) properties.pNext = &host_memory;
    if (device.info.queries_rays) structures.pNext = std::exchange(properties.pNext, &structures);
    vkGetPhysicalDeviceProperties2(device.physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(device.physical, &device.memory);
    device.import_alignment_bytes = host_memory.minImportedHostPointerAlignment;
    device.most_query_triangles = structures.maxPrimitiveCount;
    device.scratch_alignment_bytes =
        std::max<std::uint64_t>(structures.minAccelerationStructureScratchOffsetAlignment, 1);
    if (timestamp_bits == 64) device.seconds_per_tick = 1.0e-9 * properties.properties.limits.timestampPeriod;
}

}  // namespace

void MessengerDeleter::operator()(VkDebugUtilsMessengerEXT messenger) const {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    if (destroy) destroy(instance, messenger, nullptr);
}

std::shared_ptr<const Device> open_device(const std::string& name) {
    const auto device = std::make_shared<Device>();
    const bool validated = validation_wanted();
    device->instance = make_instance(validated);
    if (!device->instance)
        throw EnvironmentError("Vulkan", "no driver found", "install one, for example mesa-vulkan-drivers");
    if (validated) device->messenger = make_messenger(device->instance.get(), device->validation_errors);
    FoundDevice chosen = choose(find_devices(device->instance.get()), name);
    device->physical = chosen.physical;
    device->info = std::move(chosen.info);
    std::uint32_t timestamp_bits = 0;
    device->queue_family = choose_queue_family(device->physical, timestamp_bits);
    device->logical = make_logical_device(*device);
    read_limits(*device, timestamp_bits);
    vkGetDeviceQueue(device->logical.get(), device->queue_family, 0, &device->queue);

    VkCommandPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    create.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    create.queueFamilyIndex = device->queue_family;
    VkCommandPool pool = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device->logical.get(), &create, nullptr, &pool), *device, "making a command pool");
    device->command_pool = {pool, {device->logical.get()}};
    return device;
}

void check(VkResult result, const Device& device, std::string_view action) {
    if (result != VK_SUCCESS)
        throw EnvironmentError("Vulkan device " + device.info.name,
                               std::string(action) + " failed (" + result_name(result) + ")");
}

std::string bytes_text(std::uint64_t bytes) {
    constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB"};
    double value = static_cast<double>(bytes);
    int unit = 0;
    for (; value >= 1000.0 && unit < 4; ++unit) value /= 1000.0;
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %s", value, units[unit]);
    return text;
}

}  // namespace sightlines::compute
