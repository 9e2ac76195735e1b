// The array of voxelizations on a Vulkan device, as those that ask it there see it.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "shaders/voxel_rows_data.h"
#include "techniques/compute/buffer.h"
#include "techniques/compute/dispatch.h"

namespace sightlines::voxel_rows {

constexpr std::uint32_t texel_buffers = 3;  ///< of a pipeline that reads texels: frames, rows, indices

/// What a pipeline that asks lights is compiled for, besides the array.
struct PipelineKey {
    int subrays = 1, clip = 0;
    std::uint32_t shade = 1, kind_of_all_lights = 3;  ///< 3: mixed

    auto operator<=>(const PipelineKey&) const = default;
};

struct VulkanRows {
    std::shared_ptr<const compute::Device> device;
    std::shared_ptr<void> words_owner;  ///< keeps the words alive as long as `rows`, which may be the same memory
    compute::Buffer rows, frames;
    bool as_texels = false;  ///< rows and frames are read by texel fetches instead of by address
    RowShape shape{};
    // Pipelines are compiled when first asked for: compiling takes longer than a frame.
    mutable std::mutex pipelines_mutex;
    mutable std::map<PipelineKey, compute::Pipeline> pipelines;
    mutable std::optional<compute::Pipeline> first_hits;
};

/// The frames and rows for a pipeline that reads them as texels; nothing where it reads them by address. The rows must
/// outlive it.
std::optional<compute::BoundTexels> bind_rows(const VulkanRows& rows, const compute::Pipeline& pipeline);

}  // namespace sightlines::voxel_rows
