#version 460
// Algorithm 5 of Wang 2017: one invocation a pixel, for the rays of a range of lights that pass what stands still. Runs
// after voxel_rows_lighting*.comp, which leaves the verdicts and the counts; shades in its place.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "voxel_row_objects.h"
#include "voxel_rows_lights.glsl"

layout(local_size_x = 64) in;

// Known when the pipeline is made; the same for all objects.
layout(constant_id = 0) const int resolution = 32;
layout(constant_id = 1) const int words_per_row = 1;
layout(constant_id = 2) const int subrays = 1;

layout(push_constant, scalar) uniform Push { ObjectLightingJob job; };

ObjectInstance load_object(uint k) {
    ObjectInstance object = job.objects.v[k];
    object.query.resolution = resolution;
    object.query.words_per_row = words_per_row;
    object.query.subrays = subrays;
    object.query.index_bits = 0;
    return object;
}

/// Which of the held lights any ray of the subgroup may meet the object to. Each invocation looks at the one it holds.
uint lights_to_ask(ObjectInstance object, vec3 centre, vec3 half_size, LightRecord held, uint count) {
    const vec3 end = light_end(held, centre, job.reach_m);
    return subgroupBallot(gl_SubgroupInvocationID < count && may_meet(object, centre, half_size, end)).x;
}

/// Which of the held lights are behind an object, of those whose bit is in `open`.
uint blocked_by(ObjectInstance object, SurfacePoint surface, LightRecord held, uint open) {
    uint blocked = 0u;
    for (uint left = subgroupOr(open); left != 0u; left &= left - 1u) {
        const uint k = uint(findLSB(left));
        const vec3 end = light_end(light_of(held, k), surface.position, job.reach_m);
        blocked |= object_blocks(object, surface.position, surface.normal, end) ? 1u << k : 0u;
    }
    return blocked & open;
}

void main() {
    const uint pixel = gl_GlobalInvocationID.x;
    const SurfacePoint surface = job.surfaces.v[pixel];
    PixelSums sums = job.sums.v[pixel];
    const uint batch = min(gl_SubgroupSize, 32u);
    const vec3 lowest = subgroupMin(surface.position);
    const vec3 highest = subgroupMax(surface.position);
    const vec3 centre = (lowest + highest) * 0.5f;
    const vec3 half_size = (highest - lowest) * 0.5f;

    for (uint first = job.first_light; first < job.end_light; first += batch) {
        const uint count = min(batch, job.end_light - first);
        const LightRecord held = job.lights.v[first + min(gl_SubgroupInvocationID, count - 1u)];
        uint asked = 0u;
        for (uint k = 0u; k < count; ++k) {
            const vec3 light_offset = to_light(light_of(held, k), surface.position, job.reach_m);
            asked |= is_asked(surface.normal, light_offset) ? 1u << k : 0u;
        }
        const uint word = pixel * job.words_per_pixel + first / 32u;
        const uint verdicts = job.verdicts.v[word];
        uint open = asked & ~(verdicts >> (first % 32u));
        uint blocked = 0u;
        for (uint k = 0u; k < job.object_count && subgroupOr(open) != 0u; ++k) {
            ObjectInstance object = load_object(k);
            const uint near = lights_to_ask(object, centre, half_size, held, count);
            const uint behind = blocked_by(object, surface, held, open & near);
            blocked |= behind;
            open &= ~behind;
        }
        sums.blocked += uint(bitCount(blocked));
        if (blocked != 0u) job.verdicts.v[word] = verdicts | blocked << (first % 32u);
        if (!shade) continue;
        for (uint left = subgroupOr(open); left != 0u; left &= left - 1u) {
            const uint k = uint(findLSB(left));
            const LightRecord light = light_of(held, k);
            const vec3 light_offset = to_light(light, surface.position, job.reach_m);
            const bool seen = (open >> k & 1u) != 0u;
            const float given = seen ? irradiance_per_intensity(light, surface.shading_normal, light_offset) : 0.0f;
            sums.irradiance = fma(vec3(given), light.intensity, sums.irradiance);
        }
    }
    job.sums.v[pixel] = sums;
}
