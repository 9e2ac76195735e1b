// How an instance is made and its devices are looked at; between device.cpp and list_devices only.
#pragma once

#include <array>

#include "techniques/compute/device.h"

namespace sightlines::compute {

/// What ray queries need; all or none are asked for.
inline constexpr std::array<const char*, 3> ray_query_extensions{VK_KHR_RAY_QUERY_EXTENSION_NAME,
                                                                 VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                                                 VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

/// The validation layer is installed, and asked for (see open_device).
bool validation_wanted();

/// An instance of Vulkan 1.3; null where the machine has no Vulkan driver. EnvironmentError for any other failure.
OwnedInstance make_instance(bool with_validation);

/// A physical device with what list_devices says of it.
struct FoundDevice {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    DeviceInfo info;
};

/// In the order of preference.
std::vector<FoundDevice> find_devices(VkInstance instance);

/// "VK_ERROR_OUT_OF_DEVICE_MEMORY", or the number where it has no name here.
std::string result_name(VkResult result);

}  // namespace sightlines::compute
