#include "app/window/swapchain.h"

#include <algorithm>
#include <array>
#include <limits>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

SwapchainImage make_swapchain_image(const compute::Device& device, VkImage image, ImageSize size, VkFormat format,
                                    VkRenderPass render_pass) {
    SwapchainImage made;
    made.view = make_view(device, image, format);
    made.framebuffer = make_framebuffer(device, made.view.get(), size, render_pass);
    made.drawn = make_semaphore(device);
    return made;
}

ImageSize surface_size(const VkSurfaceCapabilitiesKHR& surface, ImageSize window_size) {
    if (surface.currentExtent.width != std::numeric_limits<std::uint32_t>::max())
        return {static_cast<int>(surface.currentExtent.width), static_cast<int>(surface.currentExtent.height)};
    return {std::clamp(window_size.width, static_cast<int>(surface.minImageExtent.width),
                       static_cast<int>(surface.maxImageExtent.width)),
            std::clamp(window_size.height, static_cast<int>(surface.minImageExtent.height),
                       static_cast<int>(surface.maxImageExtent.height))};
}

/// In place of the old one; without images where the window has no pixels.
void remake(Swapchain& swapchain, const Graphics& graphics, ImageSize window_size, VkSurfaceFormatKHR format,
            VkRenderPass render_pass) {
    const compute::Device& device = *graphics.device;
    check_drawing(vkQueueWaitIdle(device.queue), device, "waiting for the screen");
    VkSurfaceCapabilitiesKHR surface{};
    check_drawing(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical, graphics.surface.get(), &surface), device,
                  "asking for the window's size");
    swapchain.images.clear();
    swapchain.size = surface_size(surface, window_size);
    if (swapchain.size.pixels() == 0) return;
    VkSwapchainCreateInfoKHR create{};
    create.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    create.surface = graphics.surface.get();
    create.minImageCount = std::max(surface.minImageCount, 2u);
    create.imageFormat = format.format;
    create.imageColorSpace = format.colorSpace;
    create.imageExtent = {static_cast<std::uint32_t>(swapchain.size.width),
                          static_cast<std::uint32_t>(swapchain.size.height)};
    create.imageArrayLayers = 1;
    create.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    create.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    create.preTransform = surface.currentTransform;
    create.compositeAlpha = surface.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    create.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    create.clipped = VK_TRUE;
    create.oldSwapchain = swapchain.handle.get();
    VkSwapchainKHR handle = VK_NULL_HANDLE;
    check_drawing(vkCreateSwapchainKHR(device.logical.get(), &create, nullptr, &handle), device, "making a swapchain");
    swapchain.handle = {handle, {device.logical.get()}};
    std::uint32_t count = 0;
    vkGetSwapchainImagesKHR(device.logical.get(), handle, &count, nullptr);
    std::vector<VkImage> images(count);
    check_drawing(vkGetSwapchainImagesKHR(device.logical.get(), handle, &count, images.data()), device,
                  "asking for the swapchain's images");
    for (const VkImage image : images)
        swapchain.images.push_back(make_swapchain_image(device, image, swapchain.size, format.format, render_pass));
    swapchain.outdated = false;
}

}  // namespace

VkSurfaceFormatKHR choose_format(const Graphics& graphics) {
    const compute::Device& device = *graphics.device;
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, graphics.surface.get(), &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    check_drawing(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, graphics.surface.get(), &count, formats.data()),
                  device, "asking for the window's formats");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
    throw EnvironmentError("Vulkan device " + device.info.name, "cannot show pictures of 8 bits a channel here");
}

DeviceOwned<VkRenderPass, vkDestroyRenderPass> make_render_pass(const compute::Device& device, VkFormat format,
                                                                VkImageLayout final_layout) {
    VkAttachmentDescription attachment{};
    attachment.format = format;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    attachment.finalLayout = final_layout;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    std::array<VkSubpassDependency, 2> dependencies{};
    dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].srcStageMask = dependencies[0].dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[0].dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;  // for those who copy the image afterwards
    dependencies[1].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    VkRenderPassCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    create.attachmentCount = 1;
    create.pAttachments = &attachment;
    create.subpassCount = 1;
    create.pSubpasses = &subpass;
    create.dependencyCount = static_cast<std::uint32_t>(dependencies.size());
    create.pDependencies = dependencies.data();
    VkRenderPass render_pass = VK_NULL_HANDLE;
    check_drawing(vkCreateRenderPass(device.logical.get(), &create, nullptr, &render_pass), device,
                  "making a render pass");
    return {render_pass, {device.logical.get()}};
}

std::optional<std::uint32_t> next_image(Swapchain& swapchain, const Graphics& graphics, ImageSize window_size,
                                        VkSurfaceFormatKHR format, VkRenderPass render_pass, VkSemaphore acquired) {
    const compute::Device& device = *graphics.device;
    // The window may change again between the making and the asking, so ask a few times, but not for ever.
    for (int attempt = 0; attempt < 3; ++attempt) {
        if (swapchain.outdated || swapchain.size != window_size)
            remake(swapchain, graphics, window_size, format, render_pass);
        if (swapchain.images.empty()) return {};
        std::uint32_t image = 0;
        const VkResult result =
            vkAcquireNextImageKHR(device.logical.get(), swapchain.handle.get(),
                                  std::numeric_limits<std::uint64_t>::max(), acquired, VK_NULL_HANDLE, &image);
        // Suboptimal images can still be shown; the next frame begins by asking for the size.
        if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) return image;
        if (result != VK_ERROR_OUT_OF_DATE_KHR) check_drawing(result, device, "asking for an image to draw into");
        swapchain.outdated = true;
    }
    return {};
}

void present(Swapchain& swapchain, const Graphics& graphics, std::uint32_t image) {
    const VkSemaphore drawn = swapchain.images[image].drawn.get();
    const VkSwapchainKHR handle = swapchain.handle.get();
    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &handle;
    info.pImageIndices = &image;
    const VkResult result = vkQueuePresentKHR(graphics.device->queue, &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR)
        swapchain.outdated = true;
    else if (result != VK_SUBOPTIMAL_KHR)
        check_drawing(result, *graphics.device, "showing the frame");
}

}  // namespace sightlines
