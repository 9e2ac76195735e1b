#include "techniques/voxel_rows/vulkan_first_hits.h"

#include <algorithm>
#include <array>
#include <limits>

#include "shaders/spirv.h"
#include "shaders/voxel_rows_first_hit_data.h"
#include "techniques/voxel_rows/vulkan_rows.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::uint32_t workgroup = 64;             ///< local_size_x of the shader
constexpr std::size_t most_rays = 1u << 17u;        ///< of a dispatch
constexpr std::size_t fewest_rays = 1u << 10u;      ///< however slow the device
constexpr double longest_dispatch_seconds = 0.015;  ///< the window draws on the same device in between

const compute::Pipeline& pipeline_of(const VulkanRows& rows) {
    const std::lock_guard lock(rows.pipelines_mutex);
    if (rows.first_hits) return *rows.first_hits;
    const std::array<compute::SpecializationConstant, 4> constants{{
        {0, static_cast<std::uint32_t>(rows.shape.resolution)},
        {1, static_cast<std::uint32_t>(rows.shape.words_per_row)},
        {6, static_cast<std::uint32_t>(rows.shape.index_bits)},
        {7, static_cast<std::uint32_t>(rows.shape.index_start)},
    }};
    const auto words = rows.as_texels ? spirv::voxel_rows_first_hit_texels() : spirv::voxel_rows_first_hit();
    rows.first_hits =
        compute::make_pipeline(rows.device, words, sizeof(FirstHitJob), constants, rows.as_texels ? texel_buffers : 0);
    return *rows.first_hits;
}

void place_rays(std::span<const Segment> segments, std::span<const vec3> normals, const compute::Buffer& buffer) {
    auto* rays = reinterpret_cast<HitRay*>(buffer.mapped.data());
    for (std::size_t k = 0; k < segments.size(); ++k) rays[k] = {segments[k].origin, normals[k], segments[k].target};
}

void take_distances(const compute::Buffer& buffer, std::span<const Segment> segments, std::span<float> distances_m) {
    const auto* shares = reinterpret_cast<const float*>(buffer.mapped.data());
    for (std::size_t k = 0; k < segments.size(); ++k)
        distances_m[k] = shares[k] < 0.0f ? std::numeric_limits<float>::infinity()
                                          : shares[k] * glm::distance(segments[k].origin, segments[k].target);
}

}  // namespace

void first_hits_on_vulkan(const VulkanRows& rows, const RowShape& query, std::span<const Segment> segments,
                          std::span<const vec3> normals, std::span<float> distances_m, const Progress& progress) {
    if (segments.empty()) return;
    const compute::Pipeline& pipeline = pipeline_of(rows);
    const std::optional<compute::BoundTexels> texels = bind_rows(rows, pipeline);
    const std::size_t together = std::min(segments.size(), most_rays);
    const compute::Buffer asked =
        compute::make_buffer(rows.device, together * sizeof(HitRay), compute::MemoryPlace::host);
    const compute::Buffer shares = compute::make_buffer(rows.device, std::max<std::size_t>(together, 4) * sizeof(float),
                                                        compute::MemoryPlace::host);
    FirstHitJob job{query, 0, rows.frames.address, rows.rows.address, asked.address, shares.address};
    double rays_per_second = 1.0e6;  // of the last dispatch; at first a guess low enough for any device
    for (std::size_t first = 0; first < segments.size(); first += job.rays) {
        progress.check();
        const auto fitting = static_cast<std::size_t>(std::min(rays_per_second * longest_dispatch_seconds, 1.0e9));
        const std::size_t count = std::min(std::clamp(fitting, fewest_rays, most_rays), segments.size() - first);
        job.rays = static_cast<std::uint32_t>(count);
        place_rays(segments.subspan(first, count), normals.subspan(first, count), asked);
        const double seconds =
            compute::dispatch(pipeline, std::as_bytes(std::span(&job, 1)),
                              {(job.rays + workgroup - 1) / workgroup, 1, 1}, texels ? &*texels : nullptr);
        if (seconds > 0.0) rays_per_second = static_cast<double>(count) / seconds;
        take_distances(shares, segments.subspan(first, count), distances_m.subspan(first, count));
    }
}

}  // namespace sightlines::voxel_rows
