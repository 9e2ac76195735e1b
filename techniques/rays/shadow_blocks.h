// Surface points as Embree's packets of 16 want them, and the rays from a light to them. The reference and the
// benchmark both ask from here, so that they ask the same rays. Internal to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "shaders/lighting.h"
#include "techniques/base/types.h"
#include "techniques/rays/embree_handles.h"
#include "techniques/scene/surface_buffer.h"

namespace sightlines {

constexpr int block_side = 4;
constexpr int block_lanes = block_side * block_side;

/// The surfaces of 4x4 pixels, one lane a pixel. A lane without a surface has a zero normal, which faces no light.
struct alignas(64) ShadowBlock {
    float position_x[block_lanes], position_y[block_lanes], position_z[block_lanes];  ///< m, on the surface
    float normal_x[block_lanes], normal_y[block_lanes], normal_z[block_lanes];
    float end_x[block_lanes], end_y[block_lanes],
        end_z[block_lanes];  ///< m, where the shadow ray ends, off the surface
    std::uint32_t pixel[block_lanes];
    bool any_surface = false;
};

/// The block whose upper left pixel is (left, top); lanes outside the picture have no surface.
ShadowBlock shadow_block(const SurfaceBuffer& surfaces, int left, int top, float surface_offset_m);

/// Marks the lanes whose ray is asked with -1, the others with 0; returns how many are marked.
int mark_asked(const ShadowBlock& block, const LightRecord& light, float reach_m, int* valid);

/// Sets what all shadow rays share.
template <class Packet>
void prepare_packet(Packet& rays) {
    constexpr int lanes = sizeof(rays.tnear) / sizeof(float);
    for (int lane = 0; lane < lanes; ++lane) {
        rays.tnear[lane] = shadow_ray_near;
        rays.time[lane] = 0.0f;
        rays.mask[lane] = 0xffffffffu;
        rays.id[lane] = static_cast<unsigned>(lane);
        rays.flags[lane] = 0;
    }
}

/// The rays from the light to the block's lanes from `first` on, as many as the packet holds.
template <class Packet>
void aim_packet(const ShadowBlock& block, int first, const LightRecord& light, float reach_m, Packet& rays) {
    constexpr int lanes = sizeof(rays.tnear) / sizeof(float);
    if (light.kind == light_directional) {
        const vec3 away = light.direction * -reach_m;
        for (int lane = 0; lane < lanes; ++lane) {
            rays.org_x[lane] = block.position_x[first + lane] + away.x;
            rays.org_y[lane] = block.position_y[first + lane] + away.y;
            rays.org_z[lane] = block.position_z[first + lane] + away.z;
        }
    } else {
        for (int lane = 0; lane < lanes; ++lane) {
            rays.org_x[lane] = light.position.x;
            rays.org_y[lane] = light.position.y;
            rays.org_z[lane] = light.position.z;
        }
    }
    for (int lane = 0; lane < lanes; ++lane) {
        rays.dir_x[lane] = block.end_x[first + lane] - rays.org_x[lane];
        rays.dir_y[lane] = block.end_y[first + lane] - rays.org_y[lane];
        rays.dir_z[lane] = block.end_z[first + lane] - rays.org_z[lane];
        rays.tfar[lane] = shadow_ray_far;
    }
}

}  // namespace sightlines
