#include "techniques/compute/instance.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "techniques/base/error.h"

namespace sightlines::compute {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

std::string version_text(std::uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

DeviceKind kind_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return DeviceKind::discrete_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return DeviceKind::integrated_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return DeviceKind::virtual_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return DeviceKind::cpu;
        default:
            return DeviceKind::other;
    }
}

bool has_extension(VkPhysicalDevice physical, const char* name) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(),
                       [name](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
}

/// Ray queries in compute shaders, and what they are asked of.
bool queries_rays(VkPhysicalDevice physical) {
    for (const char* name : ray_query_extensions)
        if (!has_extension(physical, name)) return false;
    VkPhysicalDeviceRayQueryFeaturesKHR queries{};
    queries.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures{};
    structures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    structures.pNext = &queries;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &structures;
    vkGetPhysicalDeviceFeatures2(physical, &features);
    return queries.rayQuery && structures.accelerationStructure;
}

bool has_compute_queue(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    return std::any_of(families.begin(), families.end(),
                       [](const auto& family) { return (family.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0; });
}

/// What the device lacks of what every dispatch needs, as words for people.
std::string lacks(VkPhysicalDevice physical, std::uint32_t api_version) {
    if (api_version < VK_API_VERSION_1_3) return "Vulkan 1.3";
    VkPhysicalDeviceVulkan12Features features_12{};
    features_12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &features_12;
    vkGetPhysicalDeviceFeatures2(physical, &features);
    if (!features_12.bufferDeviceAddress) return "bufferDeviceAddress";
    if (!features_12.scalarBlockLayout) return "scalarBlockLayout";
    if (!has_compute_queue(physical)) return "a compute queue";
    return {};
}

/// While it lives, a lavapipe that starts up takes the processor's full vector width (16 lanes instead of 8 where there
/// is AVX-512: a quarter faster here on shadow rays). Mesa reads the variable once; what the user has set stays.
struct FullVectorWidth {
    FullVectorWidth() {
#ifdef __x86_64__
        if (__builtin_cpu_supports("avx512f") && std::getenv(variable) == nullptr) {
            setenv(variable, "512", 0);
            is_set = true;
        }
#endif
    }
    ~FullVectorWidth() {
        if (is_set) unsetenv(variable);
    }
    FullVectorWidth(const FullVectorWidth&) = delete;
    FullVectorWidth& operator=(const FullVectorWidth&) = delete;

    static constexpr const char* variable = "LP_NATIVE_VECTOR_WIDTH";
    bool is_set = false;
};

DeviceInfo describe(VkPhysicalDevice physical) {
    VkPhysicalDeviceVulkan12Properties properties_12{};
    properties_12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
    VkPhysicalDeviceVulkan11Properties properties_11{};
    properties_11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
    properties_11.pNext = &properties_12;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &properties_11;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);

    DeviceInfo info;
    info.name = properties.properties.deviceName;
    info.kind = kind_of(properties.properties.deviceType);
    info.driver = std::string(properties_12.driverName) + ", " + properties_12.driverInfo;
    info.vulkan_version = version_text(properties.properties.apiVersion);
    for (std::uint32_t heap = 0; heap < memory.memoryHeapCount; ++heap)
        if (memory.memoryHeaps[heap].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            info.memory_bytes = std::max<std::uint64_t>(info.memory_bytes, memory.memoryHeaps[heap].size);
    info.largest_allocation_bytes = properties_11.maxMemoryAllocationSize;
    info.largest_storage_range_bytes = properties.properties.limits.maxStorageBufferRange;
    info.subgroup_size = properties_11.subgroupSize;
    info.largest_workgroup = properties.properties.limits.maxComputeWorkGroupInvocations;
    info.imports_host_memory = has_extension(physical, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
    info.queries_rays = queries_rays(physical);
    info.lacks = lacks(physical, properties.properties.apiVersion);
    return info;
}

}  // namespace

std::string_view title(DeviceKind kind) {
    switch (kind) {
        case DeviceKind::discrete_gpu:
            return "discrete GPU";
        case DeviceKind::integrated_gpu:
            return "integrated GPU";
        case DeviceKind::virtual_gpu:
            return "virtual GPU";
        case DeviceKind::cpu:
            return "CPU";
        case DeviceKind::other:
            return "other";
    }
    return "other";
}

std::string result_name(VkResult result) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "VK_ERROR_OUT_OF_HOST_MEMORY";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "VK_ERROR_INITIALIZATION_FAILED";
        case VK_ERROR_DEVICE_LOST:
            return "VK_ERROR_DEVICE_LOST";
        case VK_ERROR_MEMORY_MAP_FAILED:
            return "VK_ERROR_MEMORY_MAP_FAILED";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "VK_ERROR_LAYER_NOT_PRESENT";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "VK_ERROR_EXTENSION_NOT_PRESENT";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "VK_ERROR_FEATURE_NOT_PRESENT";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "VK_ERROR_INCOMPATIBLE_DRIVER";
        case VK_ERROR_INVALID_EXTERNAL_HANDLE:
            return "VK_ERROR_INVALID_EXTERNAL_HANDLE";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "VK_ERROR_TOO_MANY_OBJECTS";
        default:
            return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

bool validation_wanted() {
    const char* asked = std::getenv("SIGHTLINES_VULKAN_VALIDATION");
#ifdef NDEBUG
    const bool wanted = asked && std::strcmp(asked, "1") == 0;
#else
    const bool wanted = !asked || std::strcmp(asked, "0") != 0;
#endif
    if (!wanted) return false;
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(),
                       [](const auto& layer) { return std::strcmp(layer.layerName, validation_layer) == 0; });
}

OwnedInstance make_instance(bool with_validation) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "sightlines";
    application.apiVersion = VK_API_VERSION_1_3;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    create.pApplicationInfo = &application;
    if (with_validation) {
        create.enabledLayerCount = 1;
        create.ppEnabledLayerNames = &validation_layer;
        create.enabledExtensionCount = 1;
        create.ppEnabledExtensionNames = &extension;
    }
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&create, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return {};
    if (result != VK_SUCCESS) throw EnvironmentError("Vulkan", "cannot start (" + result_name(result) + ")");
    return OwnedInstance(instance);
}

std::vector<FoundDevice> find_devices(VkInstance instance) {
    const FullVectorWidth full_width;
    std::uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> handles(count);
    vkEnumeratePhysicalDevices(instance, &count, handles.data());
    handles.resize(count);
    std::vector<FoundDevice> found;
    for (const VkPhysicalDevice physical : handles) found.push_back({physical, describe(physical)});
    // DeviceKind counts in the order of preference; a driver's own order decides among equals.
    std::stable_sort(found.begin(), found.end(), [](const FoundDevice& a, const FoundDevice& b) {
        if (a.info.lacks.empty() != b.info.lacks.empty()) return a.info.lacks.empty();
        return a.info.kind < b.info.kind;
    });
    return found;
}

std::vector<DeviceInfo> list_devices() {
    const OwnedInstance instance = make_instance(false);
    std::vector<DeviceInfo> infos;
    if (!instance) return infos;
    for (FoundDevice& device : find_devices(instance.get())) infos.push_back(std::move(device.info));
    return infos;
}

}  // namespace sightlines::compute
