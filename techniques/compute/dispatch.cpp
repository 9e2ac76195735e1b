#include "techniques/compute/dispatch.h"

#include <cassert>
#include <chrono>

#include "techniques/base/error.h"

namespace sightlines::compute {
namespace {

/// One primary command buffer, given back to its pool at the end.
struct OneTimeCommands {
    explicit OneTimeCommands(const Device& device_) : device(device_) {
        VkCommandBufferAllocateInfo create{};
        create.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        create.commandPool = device.command_pool.get();
        create.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        create.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device.logical.get(), &create, &handle), device, "making a command buffer");
    }
    ~OneTimeCommands() { vkFreeCommandBuffers(device.logical.get(), device.command_pool.get(), 1, &handle); }
    OneTimeCommands(const OneTimeCommands&) = delete;
    OneTimeCommands& operator=(const OneTimeCommands&) = delete;

    const Device& device;
    VkCommandBuffer handle = VK_NULL_HANDLE;
};

DeviceOwned<VkQueryPool, vkDestroyQueryPool> make_timestamps(const Device& device) {
    VkQueryPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    create.queryType = VK_QUERY_TYPE_TIMESTAMP;
    create.queryCount = 2;
    VkQueryPool pool = VK_NULL_HANDLE;
    check(vkCreateQueryPool(device.logical.get(), &create, nullptr, &pool), device, "making timestamps");
    return {pool, {device.logical.get()}};
}

DeviceOwned<VkFence, vkDestroyFence> make_fence(const Device& device) {
    VkFenceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    check(vkCreateFence(device.logical.get(), &create, nullptr, &fence), device, "making a fence");
    return {fence, {device.logical.get()}};
}

/// Everything written before is seen by everything after, the CPU included.
void full_barrier(VkCommandBuffer commands) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0,
                         nullptr);
}

void record_timed(const Device& device, VkCommandBuffer commands, VkQueryPool timestamps,
                  const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), device, "recording commands");
    if (timestamps) {
        vkCmdResetQueryPool(commands, timestamps, 0, 2);
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps, 0);
    }
    full_barrier(commands);
    record(commands);
    full_barrier(commands);
    if (timestamps) vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps, 1);
    check(vkEndCommandBuffer(commands), device, "recording commands");
}

DeviceOwned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> make_set_layout(const Device& device,
                                                                                 std::uint32_t texel_buffers) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (std::uint32_t binding = 0; binding < texel_buffers; ++binding)
        bindings.push_back({binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    VkDescriptorSetLayoutCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    create.bindingCount = texel_buffers;
    create.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device.logical.get(), &create, nullptr, &layout), device, "making a layout");
    return {layout, {device.logical.get()}};
}

DeviceOwned<VkPipelineLayout, vkDestroyPipelineLayout> make_layout(const Device& device, std::uint32_t push_bytes,
                                                                   VkDescriptorSetLayout set_layout) {
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes};
    VkPipelineLayoutCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    create.setLayoutCount = set_layout ? 1 : 0;
    create.pSetLayouts = &set_layout;
    create.pushConstantRangeCount = push_bytes > 0 ? 1 : 0;
    create.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.logical.get(), &create, nullptr, &layout), device, "making a pipeline layout");
    return {layout, {device.logical.get()}};
}

DeviceOwned<VkBufferView, vkDestroyBufferView> make_view(const Device& device, const TexelSource& source) {
    VkBufferViewCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    create.buffer = source.buffer->handle.get();
    create.format = source.format;
    create.offset = source.first_byte;
    create.range = source.buffer->bytes - source.first_byte;
    VkBufferView view = VK_NULL_HANDLE;
    check(vkCreateBufferView(device.logical.get(), &create, nullptr, &view), device, "making a texel view");
    return {view, {device.logical.get()}};
}

}  // namespace

DeviceOwned<VkShaderModule, vkDestroyShaderModule> make_module(const Device& device,
                                                               std::span<const std::uint32_t> spirv) {
    VkShaderModuleCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    create.codeSize = spirv.size_bytes();
    create.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device.logical.get(), &create, nullptr, &module), device, "loading a shader");
    return {module, {device.logical.get()}};
}

Pipeline make_pipeline(const std::shared_ptr<const Device>& device, std::span<const std::uint32_t> spirv,
                       std::uint32_t push_constant_bytes, std::span<const SpecializationConstant> constants,
                       std::uint32_t texel_buffers) {
    assert(push_constant_bytes <= 128 && push_constant_bytes % 4 == 0);
    std::vector<VkSpecializationMapEntry> entries;
    for (const SpecializationConstant& constant : constants) {
        const auto index = static_cast<std::uint32_t>(entries.size());
        entries.push_back(
            {constant.id, static_cast<std::uint32_t>(index * sizeof constant + offsetof(SpecializationConstant, value)),
             sizeof constant.value});
    }
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size_bytes(), constants.data()};
    const auto module = make_module(*device, spirv);
    Pipeline pipeline;
    pipeline.device = device;
    pipeline.push_constant_bytes = push_constant_bytes;
    pipeline.texel_buffers = texel_buffers;
    if (texel_buffers > 0) pipeline.set_layout = make_set_layout(*device, texel_buffers);
    pipeline.layout = make_layout(*device, push_constant_bytes, pipeline.set_layout.get());
    VkComputePipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    create.layout = pipeline.layout.get();
    create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    create.stage.module = module.get();
    create.stage.pName = "main";
    create.stage.pSpecializationInfo = &specialization;
    VkPipeline handle = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device->logical.get(), VK_NULL_HANDLE, 1, &create, nullptr, &handle), *device,
          "compiling a shader");
    pipeline.handle = {handle, {device->logical.get()}};
    return pipeline;
}

double submit(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
    const std::lock_guard lock(device.submission);
    const OneTimeCommands commands(device);
    const bool timed = device.seconds_per_tick > 0.0;
    const auto timestamps = timed ? make_timestamps(device) : DeviceOwned<VkQueryPool, vkDestroyQueryPool>();
    const auto fence = make_fence(device);
    record_timed(device, commands.handle, timestamps.get(), record);
    VkSubmitInfo submission{};
    submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submission.commandBufferCount = 1;
    submission.pCommandBuffers = &commands.handle;
    const auto started = std::chrono::steady_clock::now();
    check(vkQueueSubmit(device.queue, 1, &submission, fence.get()), device, "submitting work");
    const VkFence waited = fence.get();
    check(vkWaitForFences(device.logical.get(), 1, &waited, VK_TRUE, UINT64_MAX), device, "waiting for it");
    if (!timed) return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    std::uint64_t ticks[2] = {};
    check(vkGetQueryPoolResults(device.logical.get(), timestamps.get(), 0, 2, sizeof ticks, ticks, sizeof ticks[0],
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          device, "reading timestamps");
    return static_cast<double>(ticks[1] - ticks[0]) * device.seconds_per_tick;
}

bool fits_as_texels(const Device& device, std::uint64_t bytes, std::uint64_t texel_bytes, std::uint64_t first_byte) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.physical, &properties);
    return bytes % texel_bytes == 0 && bytes / texel_bytes <= properties.limits.maxTexelBufferElements &&
           first_byte % properties.limits.minTexelBufferOffsetAlignment == 0;
}

BoundTexels bind_texels(const Pipeline& pipeline, std::span<const TexelSource> sources) {
    assert(sources.size() == pipeline.texel_buffers);
    const Device& device = *pipeline.device;
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, pipeline.texel_buffers};
    VkDescriptorPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    create.maxSets = 1;
    create.poolSizeCount = 1;
    create.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device.logical.get(), &create, nullptr, &pool), device, "making a descriptor pool");
    BoundTexels bound;
    bound.pool = {pool, {device.logical.get()}};

    const VkDescriptorSetLayout layout = pipeline.set_layout.get();
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    check(vkAllocateDescriptorSets(device.logical.get(), &allocate, &bound.set), device, "making a descriptor set");
    for (std::uint32_t binding = 0; binding < sources.size(); ++binding) {
        bound.views.push_back(make_view(device, sources[binding]));
        const VkBufferView view = bound.views.back().get();
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = bound.set;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        write.pTexelBufferView = &view;
        vkUpdateDescriptorSets(device.logical.get(), 1, &write, 0, nullptr);
    }
    return bound;
}

double dispatch(const Pipeline& pipeline, std::span<const std::byte> push_constants, uvec3 groups,
                const BoundTexels* texels) {
    assert(push_constants.size() == pipeline.push_constant_bytes);
    assert((texels != nullptr) == (pipeline.texel_buffers > 0));
    return submit(*pipeline.device, [&](VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle.get());
        if (!push_constants.empty())
            vkCmdPushConstants(commands, pipeline.layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                               pipeline.push_constant_bytes, push_constants.data());
        if (texels)
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout.get(), 0, 1, &texels->set,
                                    0, nullptr);
        vkCmdDispatch(commands, groups.x, groups.y, groups.z);
    });
}

}  // namespace sightlines::compute
