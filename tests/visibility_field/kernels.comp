#version 460
// The visibility field's kernels as GLSL, for the tests: one ray an invocation, all decisions as bits of a word.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shaders/area_light.h"
#include "shaders/harmonic_light.h"
#include "shaders/one_bounce.h"
#include "shaders/visibility_field.h"

layout(local_size_x = 64) in;

struct Ray {
    vec3 position;
    vec3 normal;
    vec3 direction;
};

struct Answer {
    uint decisions;
    uint texel;
    float back;   // how far the direction is from the one that its octahedral place stands for
    float moment; // the sum of the nine polynomials
    float bounce; // what a surface with this normal sends back, the ray's direction as its colours
    uint segment; // the decision of a segment to a light
    float light;  // what it adds
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Rays { Ray v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Answers { Answer v[]; };

layout(push_constant, scalar) uniform Push {
    FieldShape shape;
    Bricks bricks;
    Words mask_numbers;
    Words masks;
    Rays rays;
    Answers answers;
    uint count;
};

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    const Ray ray = rays.v[i];
    const FieldCell cell = locate_cell(shape, bricks, ray.position, ray.normal);
    const HemisphereFrame frame = frame_about(ray.normal, 0.6f, 0.8f);
    const vec3 direction = direction_in(frame, ray.direction.x, ray.direction.y, ray.direction.z);
    const bool above = leaves_surface(ray.normal, direction);
    Decision by_label = decide_without_masks(above);
    Decision by_both = by_label;
    const int texel = texel_of(shape, direction);
    if (cell.index != no_cell) {
        const uint visible_start = mask_start(shape, mask_numbers, cell.index, 0u);
        const uint occluded_start = mask_start(shape, mask_numbers, cell.index, 1u);
        const bool visible = is_set(load_mask(masks, visible_start, shape.words_per_mask), texel);
        const bool occluded = is_set(load_mask(masks, occluded_start, shape.words_per_mask), texel);
        by_label = decide_by_label(cell.label, above, cell.label == 1u ? visible : occluded);
        by_both = decide_by_both(above, visible, occluded);
    }
    Answer answer;
    answer.decisions = (by_label.trace ? 1u : 0u) | (by_label.blocked ? 2u : 0u) | (by_label.open ? 4u : 0u) |
                       (by_both.trace ? 8u : 0u) | (by_both.blocked ? 16u : 0u) | (by_both.open ? 32u : 0u);
    answer.texel = uint(texel);
    answer.back = distance(octahedral_direction(octahedral_place(direction)), normalize(direction));
    HarmonicMoments moments = no_moments();
    add_direction(moments, direction, 1.0f);
    answer.moment = 0.0f;
    for (int term = 0; term < harmonic_terms; ++term) answer.moment += moments.of[term];
    const vec3 second = second_direction(ray.normal, ray.direction);
    const vec3 sent = sent_back(second, abs(ray.direction), by_both.blocked);
    answer.bounce = sent.x + sent.y + sent.z;
    const Decision segment = decide_segment(above, ray.position.x > 0.0f, ray.position.z > 0.0f);
    answer.segment = (segment.trace ? 1u : 0u) | (segment.blocked ? 2u : 0u) | (segment.open ? 4u : 0u);
    answer.light = segment_adds(abs(ray.position), 0.5f, 0.25f, 2.0f, 0.125f).y;
    answers.v[i] = answer;
}
