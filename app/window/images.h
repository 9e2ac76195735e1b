// Vulkan images of our own, and what is drawn into.
#pragma once

#include "app/window/graphics.h"

namespace sightlines {

/// An image of one level with its memory and a view of it, uninitialised.
struct OwnedImage {
    DeviceOwned<VkDeviceMemory, vkFreeMemory> memory;
    DeviceOwned<VkImage, vkDestroyImage> image;
    DeviceOwned<VkImageView, vkDestroyImageView> view;
};

OwnedImage make_image(const compute::Device& device, ImageSize size, VkFormat format, VkImageUsageFlags usage);

DeviceOwned<VkImageView, vkDestroyImageView> make_view(const compute::Device& device, VkImage image, VkFormat format);

DeviceOwned<VkFramebuffer, vkDestroyFramebuffer> make_framebuffer(const compute::Device& device, VkImageView view,
                                                                  ImageSize size, VkRenderPass render_pass);

/// The whole of an image's one level, for barriers and copies.
constexpr VkImageSubresourceRange whole_image{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
VkBufferImageCopy whole_copy(ImageSize size);

}  // namespace sightlines
