#include "techniques/rays/reference.h"

#include <array>
#include <chrono>
#include <mutex>
#include <numbers>

#include "techniques/base/parallel.h"
#include "techniques/rays/light_records.h"
#include "techniques/rays/shadow_blocks.h"
#include "techniques/refinement.h"

namespace sightlines {
namespace {

constexpr int region_size = 32;  // pixels; what one task works through and reports
constexpr int tile_size = 8;  // pixels; four packets that meet each light in turn, while their part of the tree is near
constexpr std::uint32_t lights_between_checks = 1024;  // whether to stop

/// What a block has gathered from the lights so far.
struct BlockSums {
    std::array<vec3, block_lanes> irradiance{};  // W/m^2, times each light's colour
    std::array<std::uint32_t, block_lanes> asked{}, blocked{};
};

struct ReferenceRender {
    const EmbreeScene& embree;
    const RenderRequest& request;
    std::vector<LightRecord> lights;
    RenderResult& result;

    void ask_light(std::uint32_t light_index, const ShadowBlock& block, RTCRay16& rays, BlockSums& sums) const {
        const LightRecord& light = lights[light_index];
        alignas(64) int valid[block_lanes];
        if (mark_asked(block, light, embree.reach_m, valid) == 0) return;
        aim_packet(block, 0, light, embree.reach_m, rays);
        const EmbreeQuery query(true);
        occluded_packet(valid, embree, query, rays);
        for (std::size_t lane = 0; lane < block_lanes; ++lane) {
            if (valid[lane] == 0) continue;
            const std::size_t pixel = block.pixel[lane];
            ++sums.asked[lane];
            if (rays.tfar[lane] < 0.0f) {
                ++sums.blocked[lane];
                if (request.keep_verdicts)
                    result.verdicts.words[pixel * result.verdicts.words_per_pixel + light_index / 32u] |=
                        1u << (light_index % 32u);
                continue;
            }
            const vec3 to_the_light = scalar_kernel::to_light(light, request.surfaces->position[pixel], embree.reach_m);
            const float unit_irradiance =
                scalar_kernel::irradiance_per_intensity(light, request.surfaces->shading_normal[pixel], to_the_light);
            sums.irradiance[lane] += unit_irradiance * light.intensity;
        }
    }

    void write_block(const ShadowBlock& block, const BlockSums& sums) const {
        for (std::size_t lane = 0; lane < block_lanes; ++lane) {
            const std::size_t pixel = block.pixel[lane];
            if (request.surfaces->triangle[pixel] == no_triangle || sums.asked[lane] == 0) continue;
            result.radiance.pixels[pixel] +=
                request.surfaces->albedo[pixel] * std::numbers::inv_pi_v<float> * sums.irradiance[lane];
            result.rays_asked.pixels[pixel] = sums.asked[lane];
            result.shadow.pixels[pixel] = static_cast<float>(sums.blocked[lane]) / static_cast<float>(sums.asked[lane]);
        }
    }

    void render_tile(int left, int top, const Progress& progress) const {
        constexpr int blocks_across = tile_size / block_side;
        std::array<ShadowBlock, blocks_across * blocks_across> blocks;
        std::array<BlockSums, blocks_across * blocks_across> sums{};
        for (int b = 0; b < blocks_across * blocks_across; ++b)
            blocks[static_cast<std::size_t>(b)] =
                shadow_block(*request.surfaces, left + b % blocks_across * block_side,
                             top + b / blocks_across * block_side, surface_offset_m(embree));
        alignas(64) RTCRay16 rays;
        prepare_packet(rays);
        for (std::uint32_t light = 0; light < lights.size(); ++light) {
            if (light % lights_between_checks == 0) progress.check();
            for (std::size_t b = 0; b < blocks.size(); ++b)
                if (blocks[b].any_surface) ask_light(light, blocks[b], rays, sums[b]);
        }
        for (std::size_t b = 0; b < blocks.size(); ++b)
            if (blocks[b].any_surface) write_block(blocks[b], sums[b]);
    }
};

}  // namespace

RenderResult render_reference(const EmbreeScene& embree, const RenderRequest& request, Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const ImageSize size = request.surfaces->size;
    RenderResult result = blank_result(request);
    const ReferenceRender render{embree, request, light_records(request.lights), result};
    const int columns = (size.width + region_size - 1) / region_size;
    const int rows = (size.height + region_size - 1) / region_size;
    const std::int64_t regions = static_cast<std::int64_t>(columns) * rows;
    std::mutex one_report_at_a_time;
    progress.begin("asking the reference", regions);
    parallel_for(regions, request.threads, [&](std::int64_t index) {
        const std::int64_t region = request.reverse_tiles ? regions - 1 - index : index;
        PixelRect rect{static_cast<int>(region % columns) * region_size,
                       static_cast<int>(region / columns) * region_size, 0, 0};
        rect.width = std::min(region_size, size.width - rect.x);
        rect.height = std::min(region_size, size.height - rect.y);
        for (int y = 0; y < rect.height; y += tile_size)
            for (int x = 0; x < rect.width; x += tile_size) render.render_tile(rect.x + x, rect.y + y, progress);
        progress.advance();
        if (request.on_region) {
            const std::lock_guard lock(one_report_at_a_time);
            request.on_region(result, rect);
        }
    });
    count_rays(result);
    result.rays_traced = result.rays;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.device = "CPU, " + std::to_string(thread_count(request.threads)) + " threads, Embree " + embree_release();
    return result;
}

}  // namespace sightlines
