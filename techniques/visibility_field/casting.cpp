#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/hemisphere.h"
#include "shaders/octahedral.h"
#include "techniques/base/hammersley.h"
#include "techniques/base/random.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/casting.h"

namespace sightlines::visibility_field {
namespace {

namespace wide = wide_kernel;
using wide::lanes;
using wide::Real;
using wide::splat;
using wide::Vec3;

constexpr float two_pi = 2.0f * std::numbers::pi_v<float>;

std::size_t padded(int rays) { return (static_cast<std::size_t>(rays) + 15) / 16 * 16; }

/// Fills in the directions and the texels that they fall into.
void aim(const RaySet& set, const wide::HemisphereFrame& frame, float shift, int mask_size, CastingRoom& room) {
    const Real one = splat(1.0f), zero = splat(0.0f);
    for (std::size_t k = 0; k < set.height.size(); k += lanes) {
        const Real shifted = wide::load(&set.height[k]) + splat(shift);
        const Real height = wide::select(shifted < one, shifted, shifted - one);
        const Real radius = wide::sqrt(wide::max(wide::fused(-height, height, one), zero));
        const Vec3 direction =
            wide::direction_in(frame, radius * wide::load(&set.cosine[k]), radius * wide::load(&set.sine[k]), height);
        wide::store(direction.x, &room.direction[0][k]);
        wide::store(direction.y, &room.direction[1][k]);
        wide::store(direction.z, &room.direction[2][k]);
        const wide::OctahedralTexel texel = wide::octahedral_texel(wide::octahedral_place(direction), mask_size);
        wide::store(texel.column, &room.column[k]);
        wide::store(texel.row, &room.row[k]);
    }
}

/// Which of a vector's rays from `start` pass through the box: the slabs of its three axes.
wide::Mask pass_through(const Box3& box, vec3 start, const Real inverse[3]) {
    Real nearest = splat(0.0f), farthest = splat(std::numeric_limits<float>::max());
    for (int axis = 0; axis < 3; ++axis) {
        const Real a = splat(box.lowest[axis] - start[axis]) * inverse[axis];
        const Real b = splat(box.highest[axis] - start[axis]) * inverse[axis];
        nearest = wide::max(nearest, wide::min(a, b));
        farthest = wide::min(farthest, wide::max(a, b));
    }
    return !(nearest > farthest);
}

/// The aimed rays that are not blocked and pass through one of the boxes.
void choose_rays(std::span<const Box3> boxes, const RaySet& set, vec3 start, CastingRoom& room) {
    room.chosen.clear();
    const auto count = static_cast<std::uint32_t>(set.rays);
    for (std::uint32_t first = 0; first < count; first += lanes) {
        Real inverse[3];
        for (int axis = 0; axis < 3; ++axis) {
            // Never zero, so that a box whose face the ray starts in is not lost in 0 times infinity.
            const Real along = wide::load(&room.direction[axis][first]), tiny = splat(1.0e-20f);
            inverse[axis] = splat(1.0f) / wide::select(wide::abs(along) < tiny, tiny, along);
        }
        std::uint32_t passing = 0;
        for (const Box3& box : boxes) passing |= wide::bits_of(pass_through(box, start, inverse));
        for (std::uint32_t left = passing; left != 0; left &= left - 1) {
            const std::uint32_t k = first + static_cast<std::uint32_t>(std::countr_zero(left));
            if (k < count && (room.blocked[k / 32] >> (k % 32) & 1u) == 0) room.chosen.push_back(k);
        }
    }
}

/// Casts the aimed rays from `start`: fills `room.blocked` in.
void cast_aimed(const EmbreeScene& embree, const RaySet& set, vec3 start, CastingRoom& room) {
    PackedOpenRays rays;
    rays.count = static_cast<std::size_t>(set.rays);
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::fill(room.origin[axis], start[axis]);
        rays.origin[axis] = room.origin[axis].data();
        rays.direction[axis] = room.direction[axis].data();
    }
    are_blocked(embree, rays, room.blocked);
}

}  // namespace

RaySet make_ray_set(int rays) {
    RaySet set;
    set.rays = rays;
    const auto count = static_cast<std::uint32_t>(rays);
    for (std::uint32_t k = 0; k < padded(rays); ++k) {
        const vec2 point = hammersley(std::min(k, count - 1), count);
        set.cosine.push_back(std::cos(two_pi * point.x));
        set.sine.push_back(std::sin(two_pi * point.x));
        set.height.push_back(point.y);
    }
    return set;
}

CastingRoom::CastingRoom(const RaySet& set)
    : column(set.height.size()),
      row(set.height.size()),
      blocked(set.height.size() / 32 + 1),
      answered(set.height.size() / 32 + 1) {
    for (auto& axis : origin) axis.resize(set.height.size());
    for (auto& axis : direction) axis.resize(set.height.size());
    for (auto& axis : chosen_direction) axis.resize(set.height.size());
    chosen.reserve(set.height.size());
}

std::uint32_t ray_stream(const SurfacePoint& point) {
    std::uint32_t stream = hash_u32(std::bit_cast<std::uint32_t>(point.position.x));
    stream = hash_u32(stream ^ std::bit_cast<std::uint32_t>(point.position.y));
    return hash_u32(stream ^ std::bit_cast<std::uint32_t>(point.position.z));
}

void aim_from(const RaySet& set, const SurfacePoint& point, int mask_size, std::uint64_t seed, CastingRoom& room) {
    const std::uint32_t stream = ray_stream(point);
    const float turn = two_pi * random_unit(seed, stream, 0);
    const wide::HemisphereFrame frame = wide::frame_about(point.normal, std::cos(turn), std::sin(turn));
    aim(set, frame, random_unit(seed, stream, 1), mask_size, room);
}

CastCounts cast_into(std::span<const Box3> boxes, const EmbreeScene& embree, const RaySet& set, vec3 start,
                     CastingRoom& room) {
    choose_rays(boxes, set, start, room);
    PackedOpenRays rays;
    rays.count = room.chosen.size();
    if (rays.count == 0) return {};
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::fill(room.origin[axis], start[axis]);
        for (std::size_t k = 0; k < room.chosen.size(); ++k)
            room.chosen_direction[axis][k] = room.direction[axis][room.chosen[k]];
        rays.origin[axis] = room.origin[axis].data();
        rays.direction[axis] = room.chosen_direction[axis].data();
    }
    are_blocked(embree, rays, room.answered);
    CastCounts counts{rays.count, 0};
    for (std::size_t k = 0; k < room.chosen.size(); ++k) {
        const std::uint32_t blocked = room.answered[k / 32] >> (k % 32) & 1u;
        room.blocked[room.chosen[k] / 32] |= blocked << (room.chosen[k] % 32);
        counts.blocked += blocked;
    }
    return counts;
}

void mark_answers(const RaySet& set, const CastingRoom& room, MaskRows& visible, MaskRows& occluded) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(set.rays); ++k) {
        MaskRows& seen = (room.blocked[k / 32] >> (k % 32) & 1u) != 0 ? occluded : visible;
        seen[static_cast<std::size_t>(room.row[k])] |= std::uint64_t{1} << room.column[k];
    }
}

void cast_from(const EmbreeScene& embree, const RaySet& set, const SurfacePoint& point, int mask_size,
               std::uint64_t seed, CastingRoom& room, MaskRows& visible, MaskRows& occluded) {
    aim_from(set, point, mask_size, seed, room);
    cast_aimed(embree, set, lifted_off(embree, point.position, point.normal), room);
    mark_answers(set, room, visible, occluded);
}

}  // namespace sightlines::visibility_field
