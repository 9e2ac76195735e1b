// What the pictures that are made by vectors share: a pixel's cell and its masks, and the rays that wait for Embree.
// Internal to this folder; include shaders/wide.h before it.
#pragma once

#include "shaders/visibility_field.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/picture_tiles.h"
#include "techniques/visibility_field/ray_order.h"
#include "techniques/visibility_field/render.h"

#ifndef SIGHTLINES_WIDE_H
#error "shaders/wide.h makes these kernels wide"
#endif

namespace sightlines::visibility_field {

namespace wide = wide_kernel;

/// Packed before Embree is asked. The more are sorted by direction together, the sooner Embree has answered where there
/// is no field; with one it makes no difference.
constexpr std::size_t batch_rays = 32768;

/// A pixel's cell. Without masks every sample is traced.
struct CellMasks {
    bool has_cell = false;
    std::uint32_t label = 1;
    wide::CellMask visible, occluded;
};

/// Algorithm 2, lines 3 and 4; `room` holds the masks of a dense cell. `field` may be null.
inline CellMasks find_masks(const VisibilityField* field, const EnvironmentRequest& request, vec3 position, vec3 normal,
                            std::vector<std::uint32_t>& room) {
    CellMasks found;
    if (field == nullptr) return found;
    const FieldShape& shape = field->shape;
    const wide::FieldCell cell = wide::locate_cell(shape, {field->bricks.data()}, position, normal);
    wide::Words words{field->masks.data()};
    std::uint32_t starts[2] = {};
    found.has_cell = cell.index != wide::no_cell;
    found.label = cell.label;
    if (request.dense != nullptr) {
        const DenseCell dense = dense_cell(*request.dense, {cell.x, cell.y, cell.z});
        found.has_cell = dense.occupied;
        found.label = dense.label;
        room = dense.visible;
        room.insert(room.end(), dense.occluded.begin(), dense.occluded.end());
        room.resize(room.size() + spare_words);
        words = {room.data()};
        starts[1] = static_cast<std::uint32_t>(shape.words_per_mask);
    } else if (found.has_cell) {
        const wide::Words numbers{field->mask_numbers.data()};
        for (std::uint32_t which = 0; which < 2; ++which)
            starts[which] = wide::mask_start(shape, numbers, cell.index, which);
    }
    if (!found.has_cell) return found;
    if (culling_used(request) == Culling::visible) found.label = 1;
    found.visible = wide::load_mask(words, starts[0], shape.words_per_mask);
    found.occluded = wide::load_mask(words, starts[1], shape.words_per_mask);
    return found;
}

/// How a pixel's samples are sorted out: without masks, by one of them, or by both.
enum class Known { nothing, one_region, both_regions };

template <Known known>
HWY_INLINE wide::Decision decide(const FieldShape& shape, const CellMasks& cell, wide::Vec3 direction,
                                 wide::Mask above) {
    if constexpr (known == Known::nothing) return wide::decide_without_masks(above);
    const wide::Int texel = wide::texel_of(shape, direction);
    if constexpr (known == Known::one_region)
        return wide::decide_by_label(cell.label, above,
                                     wide::is_set(cell.label == 1 ? cell.visible : cell.occluded, texel));
    return wide::decide_by_both(above, wide::is_set(cell.visible, texel), wide::is_set(cell.occluded, texel));
}

/// Rays that wait for Embree. Each array has room for a batch and a pixel's samples behind it.
struct WaitingRays {
    std::vector<float> origin[3], direction[3];
    std::vector<std::uint32_t> blocked;
    std::vector<std::uint32_t> sample;  ///< the number of each ray's
    SortingRoom sorting;
    std::size_t count = 0;

    explicit WaitingRays(int samples) {
        const std::size_t most = batch_rays + static_cast<std::size_t>(samples) + 4 * wide::lanes;
        for (auto& axis : origin) axis.resize(most);
        for (auto& axis : direction) axis.resize(most);
        blocked.resize(most / 32 + 2);
        sample.resize(most);
    }
    /// Puts the directions of the lanes in `mask` from `to` on, and garbage behind them.
    HWY_INLINE void place(wide::Vec3 along, wide::Mask mask, std::size_t to) {
        wide::store_compressed(along.x, mask, &direction[0][to]);
        wide::store_compressed(along.y, mask, &direction[1][to]);
        wide::store_compressed(along.z, mask, &direction[2][to]);
    }
    /// Where the last `added` rays start.
    void add(std::size_t added, vec3 start) {
        for (int axis = 0; axis < 3; ++axis)
            for (std::size_t k = 0; k < added; k += wide::lanes)
                wide::store(wide::splat(start[axis]), &origin[axis][count + k]);
        count += added;
    }
    void ask(const EmbreeScene& embree, RayOrder order) {
        const PackedOpenRays rays{{origin[0].data(), origin[1].data(), origin[2].data()},
                                  {direction[0].data(), direction[1].data(), direction[2].data()},
                                  count};
        if (order == RayOrder::direction)
            are_blocked_by_direction(embree, rays, sorting, blocked);
        else
            are_blocked(embree, rays, blocked);
    }
    /// Bit i: whether ray `first` + i is blocked, of a vector of them.
    std::uint32_t blocked_from(std::size_t first) const {
        const std::uint64_t two = blocked[first / 32] | std::uint64_t{blocked[first / 32 + 1]} << 32u;
        return static_cast<std::uint32_t>(two >> (first % 32));
    }
};

}  // namespace sightlines::visibility_field
