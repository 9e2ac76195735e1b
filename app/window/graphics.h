// The Vulkan device that draws the window, and what is drawn into: one frame in flight, done before the next begins.
#pragma once

#include <memory>

#include "app/window/glfw_window.h"
#include "techniques/compute/device.h"

namespace sightlines {

using compute::DeviceOwned;

struct SurfaceDeleter {
    VkInstance instance = VK_NULL_HANDLE;
    void operator()(VkSurfaceKHR surface) const { vkDestroySurfaceKHR(instance, surface, nullptr); }
};
using OwnedSurface = std::unique_ptr<std::remove_pointer_t<VkSurfaceKHR>, SurfaceDeleter>;

/// A device of its own beside the one that computes, and the window's surface. Textures share the device.
struct Graphics {
    std::shared_ptr<compute::Device> device;
    OwnedSurface surface;
};

/// The first device in the order of preference (real GPUs first) that can draw on this window. EnvironmentError: no
/// driver, or none that can.
Graphics make_graphics(GLFWwindow* window);

/// As compute::check, but a lost device or surface says that nothing is lost with it.
void check_drawing(VkResult result, const compute::Device& device, std::string_view action);

/// Runs `record` on a command buffer of its own and waits until the device is done.
template <class Record>
void run_once(const compute::Device& device, const Record& record);

VkCommandBuffer make_command_buffer(const compute::Device& device);
DeviceOwned<VkFence, vkDestroyFence> make_fence(const compute::Device& device);
DeviceOwned<VkSemaphore, vkDestroySemaphore> make_semaphore(const compute::Device& device);
void begin_commands(const compute::Device& device, VkCommandBuffer commands);

template <class Record>
void run_once(const compute::Device& device, const Record& record) {
    const VkCommandBuffer commands = make_command_buffer(device);
    begin_commands(device, commands);
    record(commands);
    check_drawing(vkEndCommandBuffer(commands), device, "recording commands");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check_drawing(vkQueueSubmit(device.queue, 1, &submit, VK_NULL_HANDLE), device, "submitting commands");
    check_drawing(vkQueueWaitIdle(device.queue), device, "waiting");
    vkFreeCommandBuffers(device.logical.get(), device.command_pool.get(), 1, &commands);
}

}  // namespace sightlines
