// The body of visibility_field_lighting*.comp: Algorithm 2 of Xu 2022, one invocation a pixel, a range of its samples.
// Each invocation runs ahead to its own next sample that needs a ray, so that all of a subgroup trace at the same time
// however few of their samples are left.
// Rays are answered by the tree, or by the device's own ray queries (RAYS_BY_QUERY).

#include "harmonic_light.h"
#include "ray_tree.h"
#include "visibility_field.h"
#include "visibility_field_lighting_data.h"

#ifdef RAYS_BY_QUERY
#include "ray_query.glsl"
#endif

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push { FieldLightingJob job; };

/// What is known of a pixel before its samples.
struct AskingPixel {
    AskingPoint surface;
    HemisphereFrame frame;
    vec3 origin;
    uint culling;
    uint label;
    bool subtracts;
    CellMask visible;
    CellMask occluded;
};

AskingPixel make_pixel(FieldTables field, AskingPoint surface) {
    AskingPixel pixel;
    pixel.surface = surface;
    pixel.frame = frame_about(surface.shading_normal, surface.turn_cosine, surface.turn_sine);
    pixel.origin = surface.position + field.surface_offset_m * surface.normal;
    pixel.culling = cull_nothing;
    pixel.label = 1u;
    pixel.subtracts = false;
    pixel.visible = load_mask(field.masks, 0u, 0);
    pixel.occluded = pixel.visible;
    if (job.culling == cull_nothing) return pixel;
    const FieldCell cell = locate_cell(field.shape, field.bricks, surface.position, surface.normal);
    if (cell.index == no_cell) return pixel;
    pixel.culling = job.culling;
    pixel.label = job.culling == cull_by_visible ? 1u : cell.label;
    pixel.subtracts = job.subtracts != 0u && job.culling == cull_by_label && cell.label == 0u;
    pixel.visible = load_mask(field.masks, mask_start(field.shape, field.mask_numbers, cell.index, 0u),
                              field.shape.words_per_mask);
    pixel.occluded = load_mask(field.masks, mask_start(field.shape, field.mask_numbers, cell.index, 1u),
                               field.shape.words_per_mask);
    return pixel;
}

vec3 sample_direction(AskingPixel pixel, uint pixel_index, uint index) {
    if (job.own_directions != 0u) return job.directions.v[pixel_index * job.samples + index].direction;
    const vec3 direction = job.directions.v[index].direction;
    return direction_in(pixel.frame, direction.x, direction.y, direction.z);
}

Decision decide(FieldTables field, AskingPixel pixel, vec3 direction, bool above) {
    if (pixel.culling == cull_nothing) return decide_without_masks(above);
    const int texel = texel_of(field.shape, direction);
    if (pixel.culling == cull_by_both)
        return decide_by_both(above, is_set(pixel.visible, texel), is_set(pixel.occluded, texel));
    CellMask region = pixel.occluded;
    if (pixel.label == 1u) region = pixel.visible;
    return decide_by_label(pixel.label, above, is_set(region, texel));
}

/// A sample's answer, held until a word of them is full.
struct HeldVerdicts {
    uint word;
};

void hold(inout HeldVerdicts held, uint pixel_index, uint index, bool blocked) {
    if (job.words_per_pixel == 0u) return;
    held.word |= blocked ? 1u << (index & 31u) : 0u;
    if ((index & 31u) != 31u && index + 1u != job.end_sample) return;
    job.verdicts.v[pixel_index * job.words_per_pixel + index / 32u] |= held.word;
    held.word = 0u;
}

FieldSums sums_so_far(uint pixel_index) {
    if (job.first_sample != 0u) return job.sums.v[pixel_index];
    FieldSums sums;
    for (int term = 0; term < harmonic_terms; ++term) sums.moment[term] = 0.0f;
    sums.asked = sums.blocked = sums.traced = sums.traced_blocked = sums.outside = sums.subtracts = 0u;
    return sums;
}

void main() {
    const uint pixel_index = gl_GlobalInvocationID.x;
    const AskingPoint surface = job.surfaces.v[pixel_index];
    const bool asks = dot(surface.normal, surface.normal) > 0.0f;
    FieldTables field = job.field.v[0];
    RayTreeTables tree;
    tree.nodes = field.nodes;
    tree.triangles = field.triangles;
    tree.cutouts = field.cutouts;
    tree.node_count = field.node_count;
    AskingPixel pixel = make_pixel(field, surface);
    FieldSums sums = sums_so_far(pixel_index);
    sums.outside = pixel.culling == cull_nothing ? 1u : 0u;
    sums.subtracts = pixel.subtracts ? 1u : 0u;
    HarmonicMoments moments;
    for (int term = 0; term < harmonic_terms; ++term) moments.of[term] = sums.moment[term];
    HeldVerdicts held;
    held.word = 0u;
    uint index = job.first_sample;
    const uint end = asks ? job.end_sample : index;
    while (index < end) {
        // To the next sample that needs a ray.
        bool waits = false;
        vec3 direction = vec3(0.0f);
        while (!waits && index < end) {
            direction = sample_direction(pixel, pixel_index, index);
            const bool above = leaves_surface(surface.normal, direction);
            const Decision decision = decide(field, pixel, direction, above);
            sums.asked += above ? 1u : 0u;
            waits = decision.trace;
            if (!waits) {
                sums.blocked += above && decision.blocked ? 1u : 0u;
                const float weight = pixel.subtracts ? (above ? 0.0f : -1.0f) : (decision.open ? 1.0f : 0.0f);
                add_direction(moments, direction, weight);
                hold(held, pixel_index, index, above && decision.blocked);
                ++index;
            }
        }
        if (waits) {
#ifdef RAYS_BY_QUERY
            const bool blocked = is_blocked_by_query(tree, field.ray_scene, pixel.origin, direction);
#else
            const bool blocked = is_blocked_by_tree(tree, pixel.origin, direction);
#endif
            sums.traced += 1u;
            sums.traced_blocked += blocked ? 1u : 0u;
            sums.blocked += blocked ? 1u : 0u;
            add_direction(moments, direction, pixel.subtracts ? (blocked ? -1.0f : 0.0f) : (blocked ? 0.0f : 1.0f));
            hold(held, pixel_index, index, blocked);
            ++index;
        }
    }
    for (int term = 0; term < harmonic_terms; ++term) sums.moment[term] = moments.of[term];
    job.sums.v[pixel_index] = sums;
}
