// The body of voxel_rows_lighting*.comp: one invocation a pixel, all of a range of lights for each.

#include "voxel_rows.h"
#include "voxel_rows_lighting_data.h"
#include "voxel_rows_lights.glsl"

layout(local_size_x = 64) in;

// Known when the pipeline is made, so that loops unroll and what is not asked for costs nothing.
layout(constant_id = 0) const int resolution = 128;
layout(constant_id = 1) const int words_per_row = 4;
layout(constant_id = 2) const int subrays = 1;
layout(constant_id = 3) const int clip = 0;
layout(constant_id = 6) const int index_bits = 0;
layout(constant_id = 7) const int index_start = 0;

layout(push_constant, scalar) uniform Push { LightingJob job; };

PixelSums sums_so_far(uint pixel) {
    if (job.first_light != 0u) return job.sums.v[pixel];
    return PixelSums(vec3(0.0f), 0u, 0u);
}

void main() {
    const uint pixel = gl_GlobalInvocationID.x;
    RowShape query = job.query;
    query.resolution = resolution;
    query.words_per_row = words_per_row;
    query.subrays = subrays;
    query.clip_to_bounds = clip;
    query.index_bits = index_bits;
    query.index_start = index_start;
    const SurfacePoint surface = job.surfaces.v[pixel];
    const vec3 origin = ray_origin(query, surface.position, surface.normal);
    PixelSums sums = sums_so_far(pixel);
    const uint batch = min(gl_SubgroupSize, 32u);
    uint verdicts = 0u;

    for (uint first = job.first_light; first < job.end_light; first += batch) {
        const uint count = min(batch, job.end_light - first);
        const LightRecord held = job.lights.v[first + min(gl_SubgroupInvocationID, count - 1u)];
        uint asked = 0u;
        for (uint k = 0u; k < count; ++k) {
            const vec3 light_offset = to_light(light_of(held, k), surface.position, query.reach_m);
            asked |= is_asked(surface.normal, light_offset) ? 1u << k : 0u;
        }
        // Lights that no pixel of the subgroup faces cost no more than this.
        uint blocked = 0u;
        for (uint left = subgroupOr(asked); left != 0u; left &= left - 1u) {
            const uint k = uint(findLSB(left));
            const LightRecord light = light_of(held, k);
            const vec3 light_offset = to_light(light, surface.position, query.reach_m);
            const vec3 end = light_end(light, surface.position, query.reach_m);
            const bool in_the_way = is_blocked(query, job.frames, job.rows, origin, end);
            blocked |= in_the_way ? 1u << k : 0u;
            if (shade) {
                const bool seen = !in_the_way && (asked >> k & 1u) != 0u;
                const float given = seen ? irradiance_per_intensity(light, surface.shading_normal, light_offset) : 0.0f;
                sums.irradiance = fma(vec3(given), light.intensity, sums.irradiance);
            }
        }
        blocked &= asked;
        sums.asked += uint(bitCount(asked));
        sums.blocked += uint(bitCount(blocked));
        verdicts |= blocked << (first % 32u);
        const uint next = first + count;
        if (job.words_per_pixel != 0u && (next % 32u == 0u || next == job.end_light)) {
            job.verdicts.v[pixel * job.words_per_pixel + first / 32u] = verdicts;
            verdicts = 0u;
        }
    }
    job.sums.v[pixel] = sums;
}
