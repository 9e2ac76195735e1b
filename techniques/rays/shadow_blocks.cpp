#include "techniques/rays/shadow_blocks.h"

namespace sightlines {
namespace {

template <bool directional>
int mark(const ShadowBlock& block, const LightRecord& light, float reach_m, int* valid) {
    LightRecord record = light;
    record.kind = directional ? light_directional : light_point;  // known here, so that the loop has no branch
    int count = 0;
    for (int lane = 0; lane < block_lanes; ++lane) {
        const vec3 position(block.position_x[lane], block.position_y[lane], block.position_z[lane]);
        const vec3 normal(block.normal_x[lane], block.normal_y[lane], block.normal_z[lane]);
        const bool asked = scalar_kernel::is_asked(normal, scalar_kernel::to_light(record, position, reach_m));
        valid[lane] = asked ? -1 : 0;
        count += asked ? 1 : 0;
    }
    return count;
}

}  // namespace

ShadowBlock shadow_block(const SurfaceBuffer& surfaces, int left, int top, float surface_offset_m) {
    ShadowBlock block{};
    for (int lane = 0; lane < block_lanes; ++lane) {
        const int x = left + lane % block_side;
        const int y = top + lane / block_side;
        if (x >= surfaces.size.width || y >= surfaces.size.height) continue;
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(surfaces.size.width) + static_cast<std::size_t>(x);
        block.pixel[lane] = static_cast<std::uint32_t>(pixel);
        if (surfaces.triangle[pixel] == no_triangle) continue;
        const vec3 position = surfaces.position[pixel];
        const vec3 normal = surfaces.normal[pixel];
        const vec3 end = position + surface_offset_m * normal;
        block.position_x[lane] = position.x;
        block.position_y[lane] = position.y;
        block.position_z[lane] = position.z;
        block.normal_x[lane] = normal.x;
        block.normal_y[lane] = normal.y;
        block.normal_z[lane] = normal.z;
        block.end_x[lane] = end.x;
        block.end_y[lane] = end.y;
        block.end_z[lane] = end.z;
        block.any_surface = true;
    }
    return block;
}

int mark_asked(const ShadowBlock& block, const LightRecord& light, float reach_m, int* valid) {
    return light.kind == light_directional ? mark<true>(block, light, reach_m, valid)
                                           : mark<false>(block, light, reach_m, valid);
}

}  // namespace sightlines
