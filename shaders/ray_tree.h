// Whether anything is in the way of a ray that has no end: a tree of boxes, walked depth first without a stack.
#ifndef SIGHTLINES_RAY_TREE_H
#define SIGHTLINES_RAY_TREE_H

#include "ray_tree_memory.h"

KERNEL_BEGIN

/// A ray, and one over its direction.
struct TreeRay {
    vec3 origin;
    vec3 direction;
    vec3 reciprocal;
};

FN vec3 corner_of(uvec4 words) { return vec3(float_of(words.x), float_of(words.y), float_of(words.z)); }

/// One over a coordinate; where it is zero a number large enough for any box and small enough not to overflow.
FN float reciprocal_of(float along) {
    const float least = 1.0e-18f;
    return 1.0f / (abs(along) > least ? along : (along < 0.0f ? -least : least));
}

FN TreeRay make_tree_ray(vec3 origin, vec3 direction) {
    TreeRay ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.reciprocal = vec3(reciprocal_of(direction.x), reciprocal_of(direction.y), reciprocal_of(direction.z));
    return ray;
}

/// Whether the ray meets the box. Rather once too often than once too seldom (Ize 2013: the far end is moved by more than
/// all rounding, a GPU's division included).
FN bool meets_box(TreeRay ray, vec3 lowest, vec3 highest) {
    const vec3 to_lowest = (lowest - ray.origin) * ray.reciprocal;
    const vec3 to_highest = (highest - ray.origin) * ray.reciprocal;
    const float nearest = max(max(min(to_lowest.x, to_highest.x), min(to_lowest.y, to_highest.y)),
                           max(min(to_lowest.z, to_highest.z), 0.0f));
    const float farthest =
        min(min(max(to_lowest.x, to_highest.x), max(to_lowest.y, to_highest.y)), max(to_lowest.z, to_highest.z));
    return nearest <= farthest * 1.000001f;
}

/// Where a ray meets a triangle's plane, by how much of each corner; `inside`: in the triangle and in front.
struct TriangleMeeting {
    float share_b;
    float share_c;
    bool inside;
};

FN float largest_of(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

/// By the volumes that the ray spans with the three edges: those of an edge that two triangles share are the same numbers
/// for both but for the sign, so that no ray passes between them. Where many meet in a corner that is not enough:
/// triangles are wider by what rounding moves a volume, a few millionths of their distance.
FN TriangleMeeting meet_corners(TreeRay ray, vec3 corner_a, vec3 corner_b, vec3 corner_c) {
    const vec3 a = corner_a - ray.origin;
    const vec3 b = corner_b - ray.origin;
    const vec3 c = corner_c - ray.origin;
    const vec3 edge_ca = c - a;
    const vec3 edge_ab = a - b;
    const vec3 edge_bc = b - c;
    const float volume_b = dot(cross(edge_ca, c + a), ray.direction);
    const float volume_c = dot(cross(edge_ab, a + b), ray.direction);
    const float volume_a = dot(cross(edge_bc, b + c), ray.direction);
    const float volume = volume_a + volume_b + volume_c;
    const float rounding = 5.0e-7f * largest_of(a) * (largest_of(edge_ab) + largest_of(edge_ca));
    const vec3 normal = cross(edge_ca, edge_ab);
    const float along = dot(normal, ray.direction);
    const float distance = dot(a, normal);
    TriangleMeeting meeting;
    meeting.share_b = volume_b / volume;
    meeting.share_c = volume_c / volume;
    const bool all_left = min(min(volume_a, volume_b), volume_c) >= -rounding;
    const bool all_right = max(max(volume_a, volume_b), volume_c) <= rounding;
    const bool in_front = (along > 0.0f && distance > 0.0f) || (along < 0.0f && distance < 0.0f);
    meeting.inside = (all_left || all_right) && in_front;
    return meeting;
}

/// A texture coordinate brought into one period.
FN float in_period(float coordinate, uint wrap) {
    if (!(abs(coordinate) < 1.0e30f)) return 0.0f;
    if (wrap == wrap_clamps) return min(max(coordinate, 0.0f), 1.0f);
    if (wrap == wrap_repeats) return coordinate - rounded_down(coordinate);
    return coordinate - 2.0f * rounded_down(0.5f * coordinate);
}

/// A texel's number, at most one period outside, brought inside.
FN int in_texture(int index, int size, uint wrap) {
    if (wrap == wrap_clamps) return min(max(index, 0), size - 1);
    const int period = wrap == wrap_repeats ? size : 2 * size;
    const int lifted = index < 0 ? index + period : index;
    const int inside = lifted >= period ? lifted - period : lifted;
    return inside < size ? inside : 2 * size - 1 - inside;
}

FN float alpha_at(RayTreeTables tree, uint start, int texel) {
    const uvec4 sixteen = cutout_words(tree, start + uint(texel) / 16u);
    const uint word_index = uint(texel) / 4u & 3u;
    const uint word = word_index == 0u   ? sixteen.x
                      : word_index == 1u ? sixteen.y
                      : word_index == 2u ? sixteen.z
                                         : sixteen.w;
    return float(word >> (8u * (uint(texel) & 3u)) & 255u);
}

/// Whether a triangle with a record among the cut-outs is solid where the ray meets it: alpha, bilinear, times a factor,
/// against a cutoff.
FN bool is_solid_at(RayTreeTables tree, uint record, TriangleMeeting meeting) {
    const uvec4 first = cutout_words(tree, record);
    const uvec4 second = cutout_words(tree, record + 1u);
    const uvec4 shape = cutout_words(tree, second.z);
    const uvec4 alpha = cutout_words(tree, second.z + 1u);
    const float share_a = 1.0f - meeting.share_b - meeting.share_c;
    const float u =
        share_a * float_of(first.x) + meeting.share_b * float_of(first.z) + meeting.share_c * float_of(second.x);
    const float v =
        share_a * float_of(first.y) + meeting.share_b * float_of(first.w) + meeting.share_c * float_of(second.y);
    const int width = int(shape.x);
    const int height = int(shape.y);
    const float place_u = in_period(u, shape.z) * float(width) - 0.5f;
    const float place_v = in_period(v, shape.w) * float(height) - 0.5f;
    const int left = in_texture(int(rounded_down(place_u)), width, shape.z);
    const int right = in_texture(int(rounded_down(place_u)) + 1, width, shape.z);
    const int upper = in_texture(int(rounded_down(place_v)), height, shape.w) * width;
    const int lower = in_texture(int(rounded_down(place_v)) + 1, height, shape.w) * width;
    const float blend_u = place_u - rounded_down(place_u);
    const float blend_v = place_v - rounded_down(place_v);
    const float above =
        (1.0f - blend_u) * alpha_at(tree, alpha.z, upper + left) + blend_u * alpha_at(tree, alpha.z, upper + right);
    const float below =
        (1.0f - blend_u) * alpha_at(tree, alpha.z, lower + left) + blend_u * alpha_at(tree, alpha.z, lower + right);
    return float_of(alpha.x) * ((1.0f - blend_v) * above + blend_v * below) >= 255.0f * float_of(alpha.y);
}

FN bool meets_tree_triangle(RayTreeTables tree, TreeRay ray, uint triangle) {
    const uvec4 a = triangle_words(tree, 3u * triangle);
    const uvec4 b = triangle_words(tree, 3u * triangle + 1u);
    const uvec4 c = triangle_words(tree, 3u * triangle + 2u);
    const TriangleMeeting meeting = meet_corners(ray, corner_of(a), corner_of(b), corner_of(c));
    if (!meeting.inside) return false;
    const bool solid = a.w == no_cutout || is_solid_at(tree, a.w, meeting);
    NOTE("Ray tree, triangle", "The ray meets a triangle of a leaf. Is it solid there, or is the texture a hole?");
    SHOW(triangle);
    SHOW(meeting.share_b);
    SHOW(meeting.share_c);
    SHOW(solid);
    return solid;
}

/// The first leaf from `node` on, in depth-first order, whose box the ray meets, as its word of the table; 0: none. `next`:
/// the node to go on from.
FN uint next_leaf(RayTreeTables tree, TreeRay ray, uint node, OUT(uint) next) {
    uint at = node;
    uint leaf = 0u;
    while (leaf == 0u && at < tree.node_count) {
        const uvec4 lowest = node_words(tree, 2u * at);
        const uvec4 highest = node_words(tree, 2u * at + 1u);
        const bool meets = meets_box(ray, corner_of(lowest), corner_of(highest));
        leaf = meets ? highest.w : 0u;
        at = meets ? at + 1u : lowest.w;
    }
    next = at;
    return leaf;
}

/// Whether anything is in the way of the ray, however far.
FN bool is_blocked_by_tree(RayTreeTables tree, vec3 origin, vec3 direction) {
    const TreeRay ray = make_tree_ray(origin, direction);
    bool blocked = false;
    uint leaves = 0u;
    uint node = 0u;
    while (!blocked && node < tree.node_count) {
        uint next = 0u;
        const uint leaf = next_leaf(tree, ray, node, next);
        node = next;
        const uint first = leaf / leaf_scale;
        const uint end = first + leaf % leaf_scale;
        for (uint triangle = first; triangle < end && !blocked; ++triangle)
            blocked = meets_tree_triangle(tree, ray, triangle);
        leaves += leaf != 0u ? 1u : 0u;
    }
    NOTE("Ray tree", "Of all leaves whose boxes the ray meets, none more is looked at once a triangle is in the way.");
    SHOW(leaves);
    SHOW(blocked);
    return blocked;
}

KERNEL_END

#endif
