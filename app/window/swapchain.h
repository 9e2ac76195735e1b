// The images that the window shows in turn.
#pragma once

#include <optional>
#include <vector>

#include "app/window/images.h"

namespace sightlines {

/// One of them, with what is needed to draw into it.
struct SwapchainImage {
    DeviceOwned<VkImageView, vkDestroyImageView> view;
    DeviceOwned<VkFramebuffer, vkDestroyFramebuffer> framebuffer;
    DeviceOwned<VkSemaphore, vkDestroySemaphore> drawn;  ///< presenting waits for it
};

struct Swapchain {
    DeviceOwned<VkSwapchainKHR, vkDestroySwapchainKHR> handle;
    std::vector<SwapchainImage> images;
    ImageSize size{0, 0};
    bool outdated = true;  ///< the surface has changed; made again before the next image
};

/// Bytes as they are: no conversion to sRGB on the way to the screen.
VkSurfaceFormatKHR choose_format(const Graphics& graphics);

/// Clears, is drawn into once, and leaves its image in `final_layout`.
DeviceOwned<VkRenderPass, vkDestroyRenderPass> make_render_pass(const compute::Device& device, VkFormat format,
                                                                VkImageLayout final_layout);

/// The index of the next image to draw into; `acquired` is signalled when it may be drawn into. Nothing where the
/// window has no pixels at the moment, or changes faster than it can be followed. Makes the images again where they
/// must be.
std::optional<std::uint32_t> next_image(Swapchain& swapchain, const Graphics& graphics, ImageSize window_size,
                                        VkSurfaceFormatKHR format, VkRenderPass render_pass, VkSemaphore acquired);

/// Shows the image once its `drawn` is signalled.
void present(Swapchain& swapchain, const Graphics& graphics, std::uint32_t image);

}  // namespace sightlines
