// Compute pipelines from embedded SPIR-V, and running them.
#pragma once

#include <functional>
#include <span>

#include "techniques/base/types.h"
#include "techniques/compute/buffer.h"

namespace sightlines::compute {

/// A value for `layout(constant_id = id) const uint ...`.
struct SpecializationConstant {
    std::uint32_t id = 0;
    std::uint32_t value = 0;
};

/// A shader of any stage, loaded. EnvironmentError where the driver refuses it.
DeviceOwned<VkShaderModule, vkDestroyShaderModule> make_module(const Device& device,
                                                               std::span<const std::uint32_t> spirv);

/// One entry point, `main`. Memory is reached through device addresses in the push constants and, where asked for,
/// through uniform texel buffers: set 0, bindings 0 to texel_buffers - 1.
struct Pipeline {
    std::shared_ptr<const Device> device;
    DeviceOwned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> set_layout;  ///< null without texel buffers
    DeviceOwned<VkPipelineLayout, vkDestroyPipelineLayout> layout;
    DeviceOwned<VkPipeline, vkDestroyPipeline> handle;
    std::uint32_t push_constant_bytes = 0;  ///< at most 128, which every device offers
    std::uint32_t texel_buffers = 0;
};

/// EnvironmentError where the driver refuses it.
Pipeline make_pipeline(const std::shared_ptr<const Device>& device, std::span<const std::uint32_t> spirv,
                       std::uint32_t push_constant_bytes, std::span<const SpecializationConstant> constants = {},
                       std::uint32_t texel_buffers = 0);

/// A buffer from `first_byte` to its end, seen as an array of texels.
struct TexelSource {
    const Buffer* buffer = nullptr;
    VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
    std::uint64_t first_byte = 0;
};

/// Whether the device reads so many bytes, from `first_byte` of a buffer, as texels of `texel_bytes` each.
bool fits_as_texels(const Device& device, std::uint64_t bytes, std::uint64_t texel_bytes = 16,
                    std::uint64_t first_byte = 0);

/// The texel buffers of one or more dispatches. The buffers must outlive it.
struct BoundTexels {
    std::vector<DeviceOwned<VkBufferView, vkDestroyBufferView>> views;
    DeviceOwned<VkDescriptorPool, vkDestroyDescriptorPool> pool;
    VkDescriptorSet set = VK_NULL_HANDLE;  ///< lives as long as its pool
};

/// One source for each binding of the pipeline; each must fit (see fits_as_texels).
BoundTexels bind_texels(const Pipeline& pipeline, std::span<const TexelSource> sources);

/// Runs `groups` workgroups and waits. What the CPU wrote into mapped memory before is seen by the shader, what the
/// shader wrote is seen by the CPU after. Returns the device's seconds by timestamps (wall clock where it has none).
/// May be called from several threads. EnvironmentError: the device was lost.
/// `texels`: of bind_texels, where the pipeline has any.
double dispatch(const Pipeline& pipeline, std::span<const std::byte> push_constants, uvec3 groups,
                const BoundTexels* texels = nullptr);

/// Records commands, submits them and waits. Returns the device's seconds, as dispatch.
double submit(const Device& device, const std::function<void(VkCommandBuffer)>& record);

}  // namespace sightlines::compute
