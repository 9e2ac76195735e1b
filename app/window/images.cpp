#include "app/window/images.h"

#include <cassert>

namespace sightlines {
namespace {

DeviceOwned<VkDeviceMemory, vkFreeMemory> make_image_memory(const compute::Device& device, VkImage image) {
    VkMemoryRequirements requirements{};
    vkGetImageMemoryRequirements(device.logical.get(), image, &requirements);
    VkMemoryAllocateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    create.allocationSize = requirements.size;
    while (create.memoryTypeIndex < device.memory.memoryTypeCount &&
           (!(requirements.memoryTypeBits >> create.memoryTypeIndex & 1u) ||
            !(device.memory.memoryTypes[create.memoryTypeIndex].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)))
        ++create.memoryTypeIndex;
    assert(create.memoryTypeIndex < device.memory.memoryTypeCount);  // Vulkan promises one for such images
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check_drawing(vkAllocateMemory(device.logical.get(), &create, nullptr, &memory), device,
                  "allocating " + compute::bytes_text(requirements.size));
    DeviceOwned<VkDeviceMemory, vkFreeMemory> owned{memory, {device.logical.get()}};
    check_drawing(vkBindImageMemory(device.logical.get(), image, memory, 0), device, "binding memory");
    return owned;
}

}  // namespace

OwnedImage make_image(const compute::Device& device, ImageSize size, VkFormat format, VkImageUsageFlags usage) {
    VkImageCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = format;
    create.extent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1};
    create.mipLevels = create.arrayLayers = 1;
    create.samples = VK_SAMPLE_COUNT_1_BIT;
    create.tiling = VK_IMAGE_TILING_OPTIMAL;
    create.usage = usage;
    VkImage image = VK_NULL_HANDLE;
    check_drawing(vkCreateImage(device.logical.get(), &create, nullptr, &image), device, "making an image");
    OwnedImage made;
    made.image = {image, {device.logical.get()}};
    made.memory = make_image_memory(device, image);
    made.view = make_view(device, image, format);
    return made;
}

DeviceOwned<VkImageView, vkDestroyImageView> make_view(const compute::Device& device, VkImage image, VkFormat format) {
    VkImageViewCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    create.image = image;
    create.viewType = VK_IMAGE_VIEW_TYPE_2D;
    create.format = format;
    create.subresourceRange = whole_image;
    VkImageView view = VK_NULL_HANDLE;
    check_drawing(vkCreateImageView(device.logical.get(), &create, nullptr, &view), device, "making a view");
    return {view, {device.logical.get()}};
}

DeviceOwned<VkFramebuffer, vkDestroyFramebuffer> make_framebuffer(const compute::Device& device, VkImageView view,
                                                                  ImageSize size, VkRenderPass render_pass) {
    VkFramebufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    create.renderPass = render_pass;
    create.attachmentCount = 1;
    create.pAttachments = &view;
    create.width = static_cast<std::uint32_t>(size.width);
    create.height = static_cast<std::uint32_t>(size.height);
    create.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    check_drawing(vkCreateFramebuffer(device.logical.get(), &create, nullptr, &framebuffer), device,
                  "making a framebuffer");
    return {framebuffer, {device.logical.get()}};
}

VkBufferImageCopy whole_copy(ImageSize size) {
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1};
    return region;
}

}  // namespace sightlines
