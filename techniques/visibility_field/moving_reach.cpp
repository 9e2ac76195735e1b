#include "techniques/visibility_field/moving_reach.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

#include "shaders/octahedral.h"

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float slack = 1.01f;  // for rounding, and for points that lie a nudge outside of their cell

vec3 direction_at(float column, float row, float size) {
    return scalar_kernel::octahedral_direction({2.0f * column / size - 1.0f, 2.0f * row / size - 1.0f});
}

float angle_between(vec3 a, vec3 b) { return std::acos(std::clamp(glm::dot(a, b), -1.0f, 1.0f)); }

/// The cosine of the widest angle from the line between the middles at which a ray from the cell can meet the box, and
/// in whose texels it can be found; -1 where that is any direction.
float widest_cosine(const MovingReach& reach, const Box3& cell, const Box3& box) {
    const float distance_m = glm::distance(cell.centre(), box.centre());
    const float radii_m = slack * 0.5f * (cell.diagonal() + box.diagonal());
    if (distance_m <= radii_m) return -1.0f;
    return std::cos(std::min(pi, slack * (std::asin(radii_m / distance_m) + reach.texel_radius_rad)));
}

/// Whether a texel that is set lies within this angle of the axis.
bool sees_within(const MovingReach& reach, vec3 axis, float cosine, std::span<const std::uint32_t> visible) {
    for (std::size_t word = 0; word < visible.size(); ++word)
        for (std::uint32_t left = visible[word]; left != 0; left &= left - 1) {
            const std::size_t texel = 32 * word + static_cast<std::size_t>(std::countr_zero(left));
            if (glm::dot(reach.texel_directions[texel], axis) >= cosine) return true;
        }
    return false;
}

}  // namespace

MovingReach make_reach(const FieldShape& shape, std::vector<Box3> boxes) {
    assert(boxes.size() <= 32);
    MovingReach reach{std::move(boxes), {}, 0.0f};
    const auto size = static_cast<float>(shape.mask_size);
    for (int row = 0; row < shape.mask_size; ++row) {
        for (int column = 0; column < shape.mask_size; ++column) {
            const auto x = static_cast<float>(column), y = static_cast<float>(row);
            const vec3 middle = direction_at(x + 0.5f, y + 0.5f, size);
            reach.texel_directions.push_back(middle);
            // Edges are arcs, folded at most in their middle: corners and middles are what lies furthest away.
            for (const vec2 rim : {vec2(0.0f, 0.0f), vec2(0.5f, 0.0f), vec2(1.0f, 0.0f), vec2(0.0f, 0.5f),
                                   vec2(1.0f, 0.5f), vec2(0.0f, 1.0f), vec2(0.5f, 1.0f), vec2(1.0f, 1.0f)})
                reach.texel_radius_rad =
                    std::max(reach.texel_radius_rad, angle_between(middle, direction_at(x + rim.x, y + rim.y, size)));
        }
    }
    return reach;
}

std::uint32_t boxes_in_reach(const MovingReach& reach, const Box3& cell, std::span<const std::uint32_t> visible) {
    std::uint32_t found = 0;
    if (std::ranges::all_of(visible, [](std::uint32_t word) { return word == 0; })) return found;
    for (std::size_t k = 0; k < reach.boxes.size(); ++k) {
        const float cosine = widest_cosine(reach, cell, reach.boxes[k]);
        const vec3 axis = reach.boxes[k].centre() - cell.centre();
        if (cosine <= -1.0f || sees_within(reach, glm::normalize(axis), cosine, visible)) found |= 1u << k;
    }
    return found;
}

}  // namespace sightlines::visibility_field
