// Algorithm 2's decision for single rays, by the scalar kernel. Internal to this folder.
#pragma once

#include "shaders/visibility_field.h"
#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

/// `cell` must hold masks.
inline scalar_kernel::Decision decide(const VisibilityField& field, Culling culling,
                                      const scalar_kernel::FieldCell& cell, vec3 direction, bool above) {
    namespace kernel = scalar_kernel;
    const FieldShape& shape = field.shape;
    const int texel = kernel::texel_of(shape, direction);
    const kernel::Words masks{field.masks.data()}, numbers{field.mask_numbers.data()};
    const bool visible = kernel::is_set(
        kernel::load_mask(masks, kernel::mask_start(shape, numbers, cell.index, 0), shape.words_per_mask), texel);
    const bool occluded = kernel::is_set(
        kernel::load_mask(masks, kernel::mask_start(shape, numbers, cell.index, 1), shape.words_per_mask), texel);
    if (culling == Culling::both) return kernel::decide_by_both(above, visible, occluded);
    const uint label = culling == Culling::visible ? 1u : cell.label;
    return kernel::decide_by_label(label, above, label == 1 ? visible : occluded);
}

}  // namespace sightlines::visibility_field
