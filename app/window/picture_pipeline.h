// How pictures get onto the screen: the Vulkan side of texture.h.
#pragma once

#include <array>
#include <deque>

#include "app/window/images.h"
#include "app/window/texture.h"
#include "techniques/compute/buffer.h"

namespace sightlines {

/// Draws quads inside the window's render pass.
struct PicturePipeline {
    DeviceOwned<VkSampler, vkDestroySampler> nearest, linear;
    DeviceOwned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> set_layout;
    DeviceOwned<VkPipelineLayout, vkDestroyPipelineLayout> layout;
    DeviceOwned<VkPipeline, vkDestroyPipeline> handle;
};

PicturePipeline make_picture_pipeline(const compute::Device& device, VkRenderPass render_pass);

/// An image and the staging memory that its bytes come through, which stays mapped.
struct WindowTexture::Objects {
    std::shared_ptr<const compute::Device> device;  ///< first: the handles below go before it
    ImageSize size{0, 0};
    compute::Buffer staging;
    OwnedImage image;
    DeviceOwned<VkDescriptorPool, vkDestroyDescriptorPool> pool;  ///< of its two sets
    std::array<VkDescriptorSet, 2> sets{};                        ///< by Sampling
    bool copy_pending = false;                                    ///< the staging memory is newer
};

std::shared_ptr<WindowTexture::Objects> make_texture_objects(const std::shared_ptr<const compute::Device>& device,
                                                             const PicturePipeline& pipeline, ImageSize size);

/// Records the copy from staging memory to image, for use by fragment shaders. Outside a render pass.
void record_copy(WindowTexture::Objects& texture, VkCommandBuffer commands);

/// One rectangle of the frame; keeps its texture until the frame is done.
struct QuadDraw {
    const PicturePipeline* pipeline = nullptr;
    const VkCommandBuffer* commands = nullptr;          ///< of the frame, when it is recorded
    const ImageSize* framebuffer = nullptr;             ///< likewise
    std::shared_ptr<WindowTexture::Objects> texture{};  ///< null: filled with `colour`
    ImVec2 corner, size, uv0{}, uv1{};
    Sampling sampling = Sampling::linear;
    ImU32 colour = 0;
};

/// An ImDrawList's callback; its user data is a QuadDraw.
void record_quad(const ImDrawList* list, const ImDrawCmd* command);

}  // namespace sightlines
