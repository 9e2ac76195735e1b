#include "app/window/graphics.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "techniques/base/error.h"
#include "techniques/compute/instance.h"

namespace sightlines {
namespace {

constexpr const char* driver_remedy = "install a Vulkan driver, for example the Debian package mesa-vulkan-drivers";

compute::OwnedInstance make_window_instance() {
    std::uint32_t count = 0;
    const char** const extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!extensions) throw EnvironmentError("Vulkan", "no driver for windows found" + glfw_error_text(), driver_remedy);
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "sightlines";
    application.apiVersion = VK_API_VERSION_1_3;
    const char* const validation_layer = "VK_LAYER_KHRONOS_validation";
    VkInstanceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    create.pApplicationInfo = &application;
    create.enabledExtensionCount = count;
    create.ppEnabledExtensionNames = extensions;
    // Without a messenger of ours the layer writes what it finds to standard output.
    create.enabledLayerCount = compute::validation_wanted() ? 1 : 0;
    create.ppEnabledLayerNames = &validation_layer;
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&create, nullptr, &instance);
    if (result != VK_SUCCESS)
        throw EnvironmentError("Vulkan", "cannot start (" + compute::result_name(result) + ")", driver_remedy);
    return compute::OwnedInstance(instance);
}

OwnedSurface make_surface(VkInstance instance, GLFWwindow* window) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(instance, window, nullptr, &surface);
    if (result != VK_SUCCESS)
        throw EnvironmentError(
            "Vulkan", "cannot draw on this display (" + compute::result_name(result) + ")" + glfw_error_text());
    return {surface, {instance}};
}

bool has_swapchains(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions, [](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
    });
}

/// A queue family that draws and presents on the surface.
std::optional<std::uint32_t> presenting_family(VkPhysicalDevice physical, VkSurfaceKHR surface) {
    if (!has_swapchains(physical)) return {};
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    for (std::uint32_t family = 0; family < count; ++family) {
        VkBool32 presents = VK_FALSE;
        vkGetPhysicalDeviceSurfaceSupportKHR(physical, family, surface, &presents);
        if (presents && (families[family].queueFlags & VK_QUEUE_GRAPHICS_BIT)) return family;
    }
    return {};
}

void choose_device(compute::Device& device, VkSurfaceKHR surface) {
    std::string seen;
    for (compute::FoundDevice& found : compute::find_devices(device.instance.get())) {
        seen += (seen.empty() ? "" : ", ") + found.info.name;
        const std::optional<std::uint32_t> family = presenting_family(found.physical, surface);
        if (!family || !found.info.lacks.empty()) continue;
        if (found.info.kind == compute::DeviceKind::cpu && found.info.name.find("512 bits") != std::string::npos)
            throw EnvironmentError("Vulkan device " + found.info.name, "cannot draw at this vector width",
                                   "set LP_NATIVE_VECTOR_WIDTH=256");
        device.physical = found.physical;
        device.info = std::move(found.info);
        device.queue_family = *family;
        vkGetPhysicalDeviceMemoryProperties(device.physical, &device.memory);
        return;
    }
    if (seen.empty()) throw EnvironmentError("Vulkan", "no device found", driver_remedy);
    throw EnvironmentError("Vulkan", "no device can draw on this display (found: " + seen + ")", driver_remedy);
}

compute::OwnedLogicalDevice make_logical_device(const compute::Device& device) {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = device.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan12Features features_12{};
    features_12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features_12.bufferDeviceAddress = VK_TRUE;  // compute::make_buffer asks every buffer for its address
    features_12.scalarBlockLayout = VK_TRUE;
    const char* const extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = &features_12;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = 1;
    create.ppEnabledExtensionNames = &extension;
    VkDevice logical = VK_NULL_HANDLE;
    compute::check(vkCreateDevice(device.physical, &create, nullptr, &logical), device, "opening it");
    return compute::OwnedLogicalDevice(logical);
}

DeviceOwned<VkCommandPool, vkDestroyCommandPool> make_command_pool(const compute::Device& device) {
    VkCommandPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    create.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT | VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    create.queueFamilyIndex = device.queue_family;
    VkCommandPool pool = VK_NULL_HANDLE;
    compute::check(vkCreateCommandPool(device.logical.get(), &create, nullptr, &pool), device, "making a command pool");
    return {pool, {device.logical.get()}};
}

}  // namespace

Graphics make_graphics(GLFWwindow* window) {
    Graphics graphics{std::make_shared<compute::Device>(), {}};
    compute::Device& device = *graphics.device;
    prepare_drivers();
    device.instance = make_window_instance();
    graphics.surface = make_surface(device.instance.get(), window);
    choose_device(device, graphics.surface.get());
    device.logical = make_logical_device(device);
    vkGetDeviceQueue(device.logical.get(), device.queue_family, 0, &device.queue);
    device.command_pool = make_command_pool(device);
    return graphics;
}

void check_drawing(VkResult result, const compute::Device& device, std::string_view action) {
    const std::string where = "Vulkan device " + device.info.name;
    const char* const remedy = "start again; the session is saved";
    if (result == VK_ERROR_DEVICE_LOST) throw EnvironmentError(where, "the graphics device was lost", remedy);
    if (result == VK_ERROR_SURFACE_LOST_KHR) {
        glfwPollEvents();  // if the display itself is gone, the X library notices here and ends the process
        throw EnvironmentError(where, "the window's surface was lost", remedy);
    }
    compute::check(result, device, action);
}

VkCommandBuffer make_command_buffer(const compute::Device& device) {
    VkCommandBufferAllocateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    create.commandPool = device.command_pool.get();
    create.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    create.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check_drawing(vkAllocateCommandBuffers(device.logical.get(), &create, &commands), device, "making commands");
    return commands;
}

DeviceOwned<VkFence, vkDestroyFence> make_fence(const compute::Device& device) {
    VkFenceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    check_drawing(vkCreateFence(device.logical.get(), &create, nullptr, &fence), device, "making a fence");
    return {fence, {device.logical.get()}};
}

DeviceOwned<VkSemaphore, vkDestroySemaphore> make_semaphore(const compute::Device& device) {
    VkSemaphoreCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check_drawing(vkCreateSemaphore(device.logical.get(), &create, nullptr, &semaphore), device, "making a semaphore");
    return {semaphore, {device.logical.get()}};
}

void begin_commands(const compute::Device& device, VkCommandBuffer commands) {
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_drawing(vkBeginCommandBuffer(commands, &begin), device, "recording commands");
}

}  // namespace sightlines
