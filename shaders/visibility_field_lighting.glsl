// The body of visibility_field_lighting*.comp: Algorithm 2 of Xu 2022, one invocation a pixel, a range of its samples.
// Each invocation runs ahead to its own next sample that needs a ray, so that all of a subgroup trace at the same time
// however few of their samples are left.
// Rays are answered by the tree, or by the device's own ray queries (RAYS_BY_QUERY).

#include "harmonic_light.h"
#include "ray_tree.h"
#include "visibility_field.h"
#include "visibility_field_lighting_data.h"
#include "weighted_samples.h"

#ifdef RAYS_BY_QUERY
#include "ray_query.glsl"
#endif

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push { FieldLightingJob job; };

layout(constant_id = 0) const uint sample_kind = 0u;

bool samples_are(uint kind) { return (sample_kind & kind) != 0u; }

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

/// What samples that have weights of their own are drawn about and lit by. Read once: software devices take a word and a lane
/// at a time.
SampledSurface sampled;
WeightedLight light;

void read_weighted(uint pixel_index) {
    if (!samples_are(samples_weighted)) return;
    sampled = job.sampled.v[pixel_index];
    sampled.is_glossy = samples_are(samples_of_glossy) ? 1u : 0u;
    sampled.map = samples_are(samples_by_map) ? sampled.map : 0.0f;
    light = job.light.v[0];
}

MapDraws map_draws() {
    MapDraws draws;
    draws.shape = light.draws;
    draws.rows = light.rows;
    draws.heights = light.heights;
    draws.columns = light.columns;
    draws.densities = light.densities;
    return draws;
}

/// The sample's point of the unit square (Hammersley's) and its way, by its number: first those by the cosine, then mirrored
/// ones, then the map's.
DrawnSample weighted_sample(uint index) {
    const uint before_mirrored = uint(sampled.cosine);
    const uint before_map = before_mirrored + uint(sampled.mirrored);
    const uint way = index < before_mirrored ? drawn_by_cosine : index < before_map ? drawn_by_facets : drawn_by_map;
    const uint first = way == drawn_by_cosine ? 0u : way == drawn_by_facets ? before_mirrored : before_map;
    const uint count = way == drawn_by_cosine  ? before_mirrored
                       : way == drawn_by_facets ? before_map - before_mirrored
                                               : job.samples - before_map;
    const float strata = count > 1u ? float(2u << uint(findMSB(count - 1u))) : 1.0f;
    const float u = (float(index - first) + 0.5f) * (1.0f / float(count));
    const float v = float(bitfieldReverse(index - first) >> 8) * (1.0f / 16777216.0f) + 0.5f / strata;
    DrawnSample drawn;
    drawn.direction = -sampled.normal;
    if (samples_are(samples_by_map) && way == drawn_by_map) drawn.direction = map_sample(sampled, map_draws(), u, v);
    if (samples_are(samples_by_facets) && way == drawn_by_facets) drawn.direction = mirrored_sample(sampled, u, v);
    if (samples_are(samples_by_cosine) && way == drawn_by_cosine) drawn.direction = cosine_sample(sampled, u, v);
    drawn.above = leaves_sampled(sampled, drawn.direction);
    return drawn;
}

/// A sample's direction, and whether it leaves its surface.
DrawnSample make_sample(AskingPixel pixel, uint index) {
    if (samples_are(samples_weighted)) return weighted_sample(index);
    const vec3 direction = job.directions.v[index].direction;
    DrawnSample drawn;
    drawn.direction = direction_in(pixel.frame, direction.x, direction.y, direction.z);
    drawn.above = leaves_surface(pixel.surface.normal, drawn.direction);
    return drawn;
}

/// Adds what an open sample that has a weight of its own brings.
void add_weighted(inout HarmonicMoments moments, vec3 direction) {
    Surroundings surroundings;
    surroundings.is_map = samples_are(samples_lit_by_map);
    surroundings.harmonics = light.harmonics;
    surroundings.map.shape = light.map;
    surroundings.map.texels = light.texels;
    const vec3 brings = weighed(sampled, surroundings, map_draws(), direction);
    moments.of[0] += brings.x;
    moments.of[1] += brings.y;
    moments.of[2] += brings.z;
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

bool is_blocked(RayTreeTables tree, FieldTables field, vec3 origin, vec3 direction) {
#ifdef RAYS_BY_QUERY
    return is_blocked_by_query(tree, field.ray_scene, origin, direction);
#else
    return is_blocked_by_tree(tree, origin, direction);
#endif
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
    read_weighted(pixel_index);
    uint index = job.first_sample;
    const uint end = asks ? job.end_sample : index;
    while (index < end) {
        // To the next sample that needs a ray, or to be weighed.
        bool waits = false;
        bool is_open = false;
        vec3 direction = vec3(0.0f);
        while (!waits && index < end) {
            const DrawnSample drawn = make_sample(pixel, index);
            direction = drawn.direction;
            const bool above = drawn.above;
            const Decision decision = decide(field, pixel, direction, above);
            sums.asked += above ? 1u : 0u;
            is_open = samples_are(samples_weighted) && decision.open;
            waits = decision.trace || is_open;
            if (!waits) {
                sums.blocked += above && decision.blocked ? 1u : 0u;
                const float weight = pixel.subtracts ? (above ? 0.0f : -1.0f) : (decision.open ? 1.0f : 0.0f);
                if (!samples_are(samples_weighted)) add_direction(moments, direction, weight);
                hold(held, pixel_index, index, above && decision.blocked);
                ++index;
            }
        }
        if (waits) {
            const bool blocked = !is_open && is_blocked(tree, field, pixel.origin, direction);
            sums.traced += is_open ? 0u : 1u;
            sums.traced_blocked += blocked ? 1u : 0u;
            sums.blocked += blocked ? 1u : 0u;
            if (!samples_are(samples_weighted))
                add_direction(moments, direction, pixel.subtracts ? (blocked ? -1.0f : 0.0f) : (blocked ? 0.0f : 1.0f));
            else if (!blocked)
                add_weighted(moments, direction);
            hold(held, pixel_index, index, blocked);
            ++index;
        }
    }
    for (int term = 0; term < harmonic_terms; ++term) sums.moment[term] = moments.of[term];
    job.sums.v[pixel_index] = sums;
}
