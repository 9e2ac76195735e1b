#include "app/window/picture_pipeline.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "shaders/spirv.h"
#include "shaders/window_picture_data.h"
#include "techniques/base/error.h"
#include "techniques/compute/dispatch.h"

namespace sightlines {
namespace {

DeviceOwned<VkSampler, vkDestroySampler> make_sampler(const compute::Device& device, VkFilter filter) {
    VkSamplerCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    create.magFilter = create.minFilter = filter;
    create.addressModeU = create.addressModeV = create.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkSampler sampler = VK_NULL_HANDLE;
    check_drawing(vkCreateSampler(device.logical.get(), &create, nullptr, &sampler), device, "making a sampler");
    return {sampler, {device.logical.get()}};
}

DeviceOwned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> make_set_layout(const compute::Device& device) {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                               VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    create.bindingCount = 1;
    create.pBindings = &binding;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check_drawing(vkCreateDescriptorSetLayout(device.logical.get(), &create, nullptr, &layout), device,
                  "making a layout");
    return {layout, {device.logical.get()}};
}

DeviceOwned<VkPipelineLayout, vkDestroyPipelineLayout> make_layout(const compute::Device& device,
                                                                   VkDescriptorSetLayout set_layout) {
    const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(PictureQuad)};
    VkPipelineLayoutCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    create.setLayoutCount = 1;
    create.pSetLayouts = &set_layout;
    create.pushConstantRangeCount = 1;
    create.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check_drawing(vkCreatePipelineLayout(device.logical.get(), &create, nullptr, &layout), device, "making a layout");
    return {layout, {device.logical.get()}};
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, VkShaderModule module) {
    VkPipelineShaderStageCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    create.stage = which;
    create.module = module;
    create.pName = "main";
    return create;
}

DeviceOwned<VkPipeline, vkDestroyPipeline> make_pipeline(const compute::Device& device, VkPipelineLayout layout,
                                                         VkRenderPass render_pass) {
    const auto vertex_module = compute::make_module(device, spirv::window_picture_vert());
    const auto fragment_module = compute::make_module(device, spirv::window_picture_frag());
    const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, vertex_module.get()),
                                                      stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment_module.get())};
    VkPipelineVertexInputStateCreateInfo vertices{};
    vertices.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = VK_CULL_MODE_NONE;
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(std::size(dynamic_states));
    dynamic.pDynamicStates = dynamic_states;
    VkGraphicsPipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    create.stageCount = static_cast<std::uint32_t>(std::size(stages));
    create.pStages = stages;
    create.pVertexInputState = &vertices;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &samples;
    create.pColorBlendState = &blend;
    create.pDynamicState = &dynamic;
    create.layout = layout;
    create.renderPass = render_pass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check_drawing(vkCreateGraphicsPipelines(device.logical.get(), VK_NULL_HANDLE, 1, &create, nullptr, &pipeline),
                  device, "making a pipeline");
    return {pipeline, {device.logical.get()}};
}

/// One set for each way of sampling: a choice in the shader would cost software devices both samples.
void make_descriptor_sets(WindowTexture::Objects& texture, const PicturePipeline& pipeline) {
    const compute::Device& device = *texture.device;
    const VkDescriptorPoolSize sizes{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2};
    VkDescriptorPoolCreateInfo create_pool{};
    create_pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    create_pool.maxSets = 2;
    create_pool.poolSizeCount = 1;
    create_pool.pPoolSizes = &sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check_drawing(vkCreateDescriptorPool(device.logical.get(), &create_pool, nullptr, &pool), device, "making a pool");
    texture.pool = {pool, {device.logical.get()}};
    const VkDescriptorSetLayout layouts[] = {pipeline.set_layout.get(), pipeline.set_layout.get()};
    VkDescriptorSetAllocateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    create.descriptorPool = pool;
    create.descriptorSetCount = 2;
    create.pSetLayouts = layouts;
    check_drawing(vkAllocateDescriptorSets(device.logical.get(), &create, texture.sets.data()), device, "making sets");
    for (const Sampling sampling : {Sampling::nearest, Sampling::linear}) {
        const VkSampler sampler = (sampling == Sampling::nearest ? pipeline.nearest : pipeline.linear).get();
        const VkDescriptorImageInfo image{sampler, texture.image.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = texture.sets[static_cast<std::size_t>(sampling)];
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        write.pImageInfo = &image;
        vkUpdateDescriptorSets(device.logical.get(), 1, &write, 0, nullptr);
    }
}

/// A rectangle (left, top, right, bottom) in ImGui's coordinates as whole pixels of the framebuffer, rounded as ImGui
/// rounds and cut off at its edges.
VkRect2D in_framebuffer(const ImDrawData& drawn, ImageSize framebuffer, const ImVec4& rectangle) {
    const auto along = [](float place, float origin, float scale, int end) {
        return static_cast<std::int32_t>(std::clamp((place - origin) * scale, 0.0f, static_cast<float>(end)));
    };
    const ImVec2 origin = drawn.DisplayPos, scale = drawn.FramebufferScale;
    const std::int32_t left = along(rectangle.x, origin.x, scale.x, framebuffer.width);
    const std::int32_t top = along(rectangle.y, origin.y, scale.y, framebuffer.height);
    const std::int32_t right = along(rectangle.z, origin.x, scale.x, framebuffer.width);
    const std::int32_t bottom = along(rectangle.w, origin.y, scale.y, framebuffer.height);
    return {
        {left, top},
        {static_cast<std::uint32_t>(std::max(right - left, 0)), static_cast<std::uint32_t>(std::max(bottom - top, 0))}};
}

void record_fill(const QuadDraw& draw, const ImDrawData& drawn, const ImVec4& clip) {
    const ImVec4 part(std::max(draw.corner.x, clip.x), std::max(draw.corner.y, clip.y),
                      std::min(draw.corner.x + draw.size.x, clip.z), std::min(draw.corner.y + draw.size.y, clip.w));
    const VkClearRect rectangle{in_framebuffer(drawn, *draw.framebuffer, part), 0, 1};
    if (rectangle.rect.extent.width == 0 || rectangle.rect.extent.height == 0) return;
    const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(draw.colour);
    const VkClearAttachment attachment{VK_IMAGE_ASPECT_COLOR_BIT, 0, {{{colour.x, colour.y, colour.z, 1.0f}}}};
    vkCmdClearAttachments(*draw.commands, 1, &attachment, 1, &rectangle);
}

void record_picture(const QuadDraw& draw, const ImDrawData& drawn, const ImVec4& clip) {
    const VkRect2D scissor = in_framebuffer(drawn, *draw.framebuffer, clip);
    if (scissor.extent.width == 0 || scissor.extent.height == 0) return;
    const float to_clip_x = 2.0f / drawn.DisplaySize.x, to_clip_y = 2.0f / drawn.DisplaySize.y;
    const PictureQuad quad{.corner_x = (draw.corner.x - drawn.DisplayPos.x) * to_clip_x - 1.0f,
                           .corner_y = (draw.corner.y - drawn.DisplayPos.y) * to_clip_y - 1.0f,
                           .size_x = draw.size.x * to_clip_x,
                           .size_y = draw.size.y * to_clip_y,
                           .corner_u = draw.uv0.x,
                           .corner_v = draw.uv0.y,
                           .size_u = draw.uv1.x - draw.uv0.x,
                           .size_v = draw.uv1.y - draw.uv0.y};
    const VkCommandBuffer commands = *draw.commands;
    const VkPipelineLayout layout = draw.pipeline->layout.get();
    const VkDescriptorSet set = draw.texture->sets[static_cast<std::size_t>(draw.sampling)];
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw.pipeline->handle.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof quad, &quad);
    vkCmdSetScissor(commands, 0, 1, &scissor);
    vkCmdDraw(commands, 4, 1, 0, 0);
}

}  // namespace

PicturePipeline make_picture_pipeline(const compute::Device& device, VkRenderPass render_pass) {
    PicturePipeline pipeline;
    pipeline.nearest = make_sampler(device, VK_FILTER_NEAREST);
    pipeline.linear = make_sampler(device, VK_FILTER_LINEAR);
    pipeline.set_layout = make_set_layout(device);
    pipeline.layout = make_layout(device, pipeline.set_layout.get());
    pipeline.handle = make_pipeline(device, pipeline.layout.get(), render_pass);
    return pipeline;
}

std::shared_ptr<WindowTexture::Objects> make_texture_objects(const std::shared_ptr<const compute::Device>& device,
                                                             const PicturePipeline& pipeline, ImageSize size) {
    auto texture = std::make_shared<WindowTexture::Objects>();
    texture->device = device;
    texture->size = size;
    texture->staging = compute::make_buffer(device, 4 * size.pixels(), compute::MemoryPlace::host);
    texture->image = make_image(*device, size, VK_FORMAT_R8G8B8A8_UNORM,
                                VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    make_descriptor_sets(*texture, pipeline);
    return texture;
}

void record_copy(WindowTexture::Objects& texture, VkCommandBuffer commands) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;  // all of it is written anew
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = texture.image.image.get();
    barrier.subresourceRange = whole_image;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    const VkBufferImageCopy region = whole_copy(texture.size);
    vkCmdCopyBufferToImage(commands, texture.staging.handle.get(), texture.image.image.get(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr,
                         0, nullptr, 1, &barrier);
    texture.copy_pending = false;
}

void record_quad(const ImDrawList*, const ImDrawCmd* command) {
    const auto& draw = *static_cast<const QuadDraw*>(command->UserCallbackData);
    (draw.texture ? record_picture : record_fill)(draw, *ImGui::GetDrawData(), command->ClipRect);
}

}  // namespace sightlines
