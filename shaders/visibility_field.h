// Whether a ray towards the environment must be traced: Xu 2022, Algorithm 2.
#ifndef SIGHTLINES_VISIBILITY_FIELD_H
#define SIGHTLINES_VISIBILITY_FIELD_H

#include "hemisphere.h"
#include "octahedral.h"
#include "visibility_field_data.h"
#include "visibility_field_memory.h"

KERNEL_BEGIN

/// The number of a cell that holds no masks.
const uint no_cell = 0xffffffffu;

/// A cell of the grid: where it is, the number of its masks, and its occlusion label.
struct FieldCell {
    int x;
    int y;
    int z;
    uint index;
    uint label;   // 1: trace inside the visible region; 0: inside the occluded one
};

/// What becomes of a ray. One of the three holds.
struct Decision {
    Mask trace;
    Mask blocked;   // without a ray
    Mask open;      // without a ray
};

/// The cell's number along an axis, kept inside the grid.
FN int cell_along(float position, float origin, float cell_m, int cells) {
    return int(min(max((position - origin) / cell_m, 0.0f), float(cells) - 0.5f));
}

/// Where a surface point with this normal is looked up.
FN vec3 lookup_point(FieldShape shape, vec3 position, vec3 normal) { return position + normal * shape.nudge_m; }

/// The brick that holds a cell.
FN uint brick_of(FieldShape shape, int x, int y, int z) {
    return uint(((z / brick_side) * shape.bricks_y + y / brick_side) * shape.bricks_x + x / brick_side);
}

/// The cell's bit in its brick.
FN uint bit_in_brick(int x, int y, int z) {
    return uint(x % brick_side + brick_side * (y % brick_side) + brick_side * brick_side * (z % brick_side));
}

/// The masks of the cell (x, y, z), if it has any.
FN FieldCell find_cell(FieldShape shape, Bricks bricks, int x, int y, int z) {
    const FieldBrick brick = bricks.v[brick_of(shape, x, y, z)];
    const uint bit = bit_in_brick(x, y, z);
    const uint within = 1u << (bit & 31u);
    const bool in_high = bit >= 32u;
    const uint occupied = in_high ? brick.occupied_high : brick.occupied_low;
    const uint labels = in_high ? brick.label_high : brick.label_low;
    const uint before = bits_set(occupied & (within - 1u)) + (in_high ? bits_set(brick.occupied_low) : 0u);
    FieldCell cell;
    cell.x = x;
    cell.y = y;
    cell.z = z;
    cell.index = (occupied & within) != 0u ? brick.first_cell + before : no_cell;
    cell.label = (labels & within) != 0u ? 1u : 0u;
    return cell;
}

/// Algorithm 2, lines 3 and 4.
FN FieldCell locate_cell(FieldShape shape, Bricks bricks, vec3 position, vec3 normal) {
    const vec3 point = lookup_point(shape, position, normal);
    const int x = cell_along(point.x, shape.origin.x, shape.cell_m, shape.cells_x);
    const int y = cell_along(point.y, shape.origin.y, shape.cell_m, shape.cells_y);
    const int z = cell_along(point.z, shape.origin.z, shape.cell_m, shape.cells_z);
    NOTE("Algorithm 2, line 3", "The grid cell that holds the surface point.");
    SHOW_POINT(point);
    SHOW(x);
    SHOW(y);
    SHOW(z);
    const FieldCell cell = find_cell(shape, bricks, x, y, z);
    NOTE("Algorithm 2, line 4", "Does the cell hold masks, and which of its regions is traced: the visible one (label 1) "
                                "or the occluded one (label 0)?");
    SHOW(cell.index);
    SHOW(cell.label);
    return cell;
}

/// Where a cell's mask starts: `which` 0 the visibility mask, 1 the occlusion mask. Masks that are alike are stored once.
FN uint mask_start(FieldShape shape, Words mask_numbers, uint cell, uint which) {
    return mask_numbers.v[cell * 2u + which] * uint(shape.words_per_mask);
}

/// The number of the texel that a direction falls into, row by row.
FN Int texel_of(FieldShape shape, Vec3 direction) {
    const OctahedralTexel texel = octahedral_texel(octahedral_place(direction), shape.mask_size);
    const Int number = texel.row * splat(shape.mask_size) + texel.column;
    NOTE("Algorithm 2, line 7", "The texel of the cell's two masks that holds the direction.");
    SHOW(texel.column);
    SHOW(texel.row);
    SHOW(number);
    return number;
}

/// The mask's bit at a texel.
FN Mask is_set(CellMask mask, Int texel) {
    const UInt word = mask_word(mask, texel >> 5);
    return (shift_right(word, to_uint(texel & splat(31))) & splat(1u)) != splat(0u);
}

/// Both masks' bits at a texel: for whoever follows one ray, as the renderer reads only the mask that it needs.
struct MaskBits {
    Mask visible;
    Mask occluded;
};

FN MaskBits mask_bits(CellMask visible, CellMask occluded, Int texel) {
    MaskBits bits;
    bits.visible = is_set(visible, texel);
    bits.occluded = is_set(occluded, texel);
    NOTE("Algorithm 2, line 8", "What the two masks say of the texel: some point of the cell saw the environment there; "
                                "some point saw a surface.");
    SHOW(bits.visible);
    SHOW(bits.occluded);
    return bits;
}

/// A ray from a surface outside all cells that hold masks: nothing is known.
FN Decision decide_without_masks(Mask above) {
    Decision decision;
    decision.trace = above;
    decision.blocked = !above;
    decision.open = above && !above;
    NOTE("Section 3.3", "No point sample fell into this cell, so every ray is traced.");
    SHOW(decision.trace);
    return decision;
}

/// Algorithm 2, lines 9 to 24: by one of the masks. `above`: the ray leaves the surface to its front; `in_region`: its texel
/// is set in the visibility mask (label 1) or the occlusion mask (label 0).
FN Decision decide_by_label(uint label, Mask above, Mask in_region) {
    Decision decision;
    decision.trace = above && in_region;
    decision.blocked = !above || (label == 1u ? !in_region : above && !above);
    decision.open = above && !in_region && (label == 1u ? above && !above : above);
    NOTE("Algorithm 2, lines 9 to 24",
         "Inside the region the ray is traced. Outside it counts as blocked (label 1) or as open (label 0).");
    SHOW(label);
    SHOW(above);
    SHOW(in_region);
    SHOW(decision.trace);
    SHOW(decision.blocked);
    SHOW(decision.open);
    return decision;
}

/// By both masks: traced where the cell's points saw both, or nothing.
FN Decision decide_by_both(Mask above, Mask visible, Mask occluded) {
    Decision decision;
    decision.trace = above && ((visible && occluded) || !(visible || occluded));
    decision.blocked = !above || (occluded && !visible);
    decision.open = above && visible && !occluded;
    NOTE("Equations 5 and 6", "The ray is traced where some point of the cell saw the environment in this direction and "
                              "some did not, or where none looked.");
    SHOW(above);
    SHOW(visible);
    SHOW(occluded);
    SHOW(decision.trace);
    SHOW(decision.blocked);
    SHOW(decision.open);
    return decision;
}

/// What a sample adds to its pixel's irradiance (equation 11). `share`: what it brings where nothing is in the way;
/// `subtracts`: the pixel starts from its unshadowed irradiance, and what is blocked is taken off.
FN vec3 sample_adds(bool subtracts, bool blocked, vec3 share) {
    const float sign = subtracts ? (blocked ? -1.0f : 0.0f) : (blocked ? 0.0f : 1.0f);
    const vec3 adds = share * sign;
    NOTE("Algorithm 2, lines 25 to 28", "The answer, Embree's where the ray was traced. A pixel of label 0 starts "
                                        "from its unshadowed irradiance, and blocked samples are taken off; others add "
                                        "up what is open.");
    SHOW(blocked);
    SHOW(subtracts);
    SHOW(adds);
    return adds;
}

KERNEL_END

#endif
