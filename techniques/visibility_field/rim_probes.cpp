#include <algorithm>
#include <bit>
#include <vector>

#include "shaders/wide.h"  // first: makes the kernel below wide

#include "shaders/octahedral.h"
#include "techniques/base/random.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/rim_probes.h"

namespace sightlines::visibility_field {
namespace {

namespace wide = wide_kernel;

constexpr std::size_t packet = 16;
constexpr std::uint64_t probe_seed = 0x70726f6265u;

/// The steps of an additive sequence that fills a cube evenly (Roberts 2018): powers of 1 / 1.2207, the root of
/// x^4 = x + 1, as shares of 2^32.
constexpr std::uint32_t point_step = 0xd1b54a33u, column_step = 0xabc98389u, row_step = 0x8cb92ba7u;

float unit_of(std::uint32_t share) { return static_cast<float>(share >> 8u) * 0x1p-24f; }

/// The next rays into one texel. A point whose surface faces away from its place in the texel has none.
struct Probing {
    const EmbreeScene& embree;
    std::span<const SurfacePoint> points;
    int mask_size = 0;
    std::uint32_t at[3] = {};  ///< in the sequence: of 2^32 shares of the points, the texel's width, its height
    alignas(64) float origin[3][packet] = {}, direction[3][packet] = {};
};

/// A step to one of the eight neighbours.
struct Step {
    int column = 0, row = 0;
};

/// Whether the neighbour of a texel is set; beyond an edge of the square, the one that touches it there (mask_rows.h).
bool neighbour_set(const MaskRows& rows, int size, int column, int row, Step step) {
    const int last = size - 1;
    column += step.column;
    row += step.row;
    const bool beside = column < 0 || column > last, above = row < 0 || row > last;
    if (beside) row = last - row;
    if (above) column = last - column;
    column = std::clamp(column, 0, last);
    row = std::clamp(row, 0, last);
    return (rows[static_cast<std::size_t>(row)] >> column & 1u) != 0;
}

/// Where the texel touches what is set in the masks that lack it.
std::vector<Step> set_neighbours(const MaskPair& masks, int size, int column, int row) {
    const auto at = static_cast<std::size_t>(row);
    const bool seen = (masks.visible[at] >> column & 1u) != 0, hidden = (masks.occluded[at] >> column & 1u) != 0;
    std::vector<Step> steps;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            if ((x != 0 || y != 0) && ((!seen && neighbour_set(masks.visible, size, column, row, {x, y})) ||
                                       (!hidden && neighbour_set(masks.occluded, size, column, row, {x, y}))))
                steps.push_back({x, y});
    return steps;
}

/// A share of the texel's width, from the side that `step` points to: most of them close to it.
float from_side(float share, int step) {
    if (step == 0) return share;
    const float depth = share * share * share;
    return step < 0 ? depth : 1.0f - depth;
}

/// Fills in directions to the sequence's next places in the texel, towards the neighbours in turn.
void aim_into(Probing& probing, int column, int row, std::span<const Step> towards) {
    alignas(64) float u[packet], v[packet];
    const float side = 2.0f / static_cast<float>(probing.mask_size);
    for (std::size_t k = 0; k < packet; ++k) {
        const auto at = static_cast<std::uint32_t>(k);
        const Step step = towards[k % towards.size()];
        u[k] = (static_cast<float>(column) + from_side(unit_of(probing.at[1] + at * column_step), step.column)) * side -
               1.0f;
        v[k] = (static_cast<float>(row) + from_side(unit_of(probing.at[2] + at * row_step), step.row)) * side - 1.0f;
    }
    for (std::size_t k = 0; k < packet; k += wide::lanes) {
        const wide::Vec3 along = wide::octahedral_direction({wide::load(&u[k]), wide::load(&v[k])});
        wide::store(along.x, &probing.direction[0][k]);
        wide::store(along.y, &probing.direction[1][k]);
        wide::store(along.z, &probing.direction[2][k]);
    }
}

/// Gives the directions their points, and keeps those that leave their surface.
std::size_t choose_points(Probing& probing) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < packet; ++k) {
        const std::uint32_t share = probing.at[0] + static_cast<std::uint32_t>(k) * point_step;
        const SurfacePoint& point = probing.points[std::uint64_t{share} * probing.points.size() >> 32u];
        const vec3 along(probing.direction[0][k], probing.direction[1][k], probing.direction[2][k]);
        if (!(glm::dot(point.normal, along) > 0.0f)) continue;
        const vec3 start = lifted_off(probing.embree, point.position, point.normal);
        for (int axis = 0; axis < 3; ++axis) {
            probing.origin[axis][kept] = start[axis];
            probing.direction[axis][kept] = along[axis];
        }
        ++kept;
    }
    probing.at[0] += static_cast<std::uint32_t>(packet) * point_step;
    probing.at[1] += static_cast<std::uint32_t>(packet) * column_step;
    probing.at[2] += static_cast<std::uint32_t>(packet) * row_step;
    return kept;
}

/// The texels beside those of either mask that are not set in it and were not asked.
MaskRows unasked_rim(const MaskPair& masks, int mask_size, const MaskRows& asked) {
    const MaskRows visible = dilated(masks.visible, mask_size), occluded = dilated(masks.occluded, mask_size);
    MaskRows rim{};
    for (std::size_t row = 0; row < static_cast<std::size_t>(mask_size); ++row)
        rim[row] = ((visible[row] & ~masks.visible[row]) | (occluded[row] & ~masks.occluded[row])) & ~asked[row];
    return rim;
}

/// Asks one texel.
std::uint64_t probe_texel(Probing& probing, int probes, std::size_t row, int column, MaskPair& masks) {
    const std::uint64_t texel = std::uint64_t{1} << column;
    std::uint64_t cast = 0;
    std::vector<Step> towards = set_neighbours(masks, probing.mask_size, column, static_cast<int>(row));
    if (towards.empty()) towards.push_back({});
    for (int asked = 0; asked < probes && (masks.visible[row] & masks.occluded[row] & texel) == 0;
         asked += static_cast<int>(packet)) {
        aim_into(probing, column, static_cast<int>(row), towards);
        const std::size_t count = choose_points(probing);
        if (count == 0) continue;
        PackedOpenRays rays;
        rays.count = count;
        for (int axis = 0; axis < 3; ++axis) {
            rays.origin[axis] = probing.origin[axis];
            rays.direction[axis] = probing.direction[axis];
        }
        std::uint32_t blocked = 0;
        are_blocked(probing.embree, rays, {&blocked, 1});
        if (blocked != 0) masks.occluded[row] |= texel;
        if (static_cast<std::size_t>(std::popcount(blocked)) < count) masks.visible[row] |= texel;
        cast += count;
    }
    return cast;
}

}  // namespace

std::uint64_t probe_rims(const EmbreeScene& embree, std::span<const SurfacePoint> points, int mask_size,
                         ProbeLimits limits, std::uint64_t seed, std::uint32_t stream, MaskPair& masks) {
    Probing probing{embree, points, mask_size};
    for (std::uint32_t k = 0; k < 3; ++k) probing.at[k] = random_u32(seed ^ probe_seed, stream, k);
    const auto size = static_cast<std::size_t>(mask_size);
    MaskRows asked{};
    std::uint64_t cast = 0;
    while (true) {
        const MaskRows rim = unasked_rim(masks, mask_size, asked);
        const auto texels = static_cast<std::uint64_t>(texels_set(rim));
        if (texels == 0) return cast;
        const std::uint64_t share = (limits.budget - std::min(cast, limits.budget)) / texels;
        const int probes = std::min(limits.probes, static_cast<int>(std::max<std::uint64_t>(share, packet)));
        for (std::size_t row = 0; row < size; ++row) {
            asked[row] |= rim[row];
            for (std::uint64_t left = rim[row]; left != 0; left &= left - 1)
                cast += probe_texel(probing, probes, row, std::countr_zero(left), masks);
        }
    }
}

}  // namespace sightlines::visibility_field
