#include <algorithm>
#include <cmath>
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
    : column(set.height.size()), row(set.height.size()), blocked(set.height.size() / 32 + 1) {
    for (auto& axis : origin) axis.resize(set.height.size());
    for (auto& axis : direction) axis.resize(set.height.size());
}

void cast_from(const EmbreeScene& embree, const RaySet& set, const SurfacePoint& point, int mask_size,
               std::uint64_t seed, std::uint32_t stream, CastingRoom& room, MaskRows& visible, MaskRows& occluded) {
    const float turn = two_pi * random_unit(seed, stream, 0);
    const wide::HemisphereFrame frame = wide::frame_about(point.normal, std::cos(turn), std::sin(turn));
    aim(set, frame, random_unit(seed, stream, 1), mask_size, room);
    const vec3 start = lifted_off(embree, point.position, point.normal);
    PackedOpenRays rays;
    rays.count = static_cast<std::size_t>(set.rays);
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::fill(room.origin[axis], start[axis]);
        rays.origin[axis] = room.origin[axis].data();
        rays.direction[axis] = room.direction[axis].data();
    }
    are_blocked(embree, rays, room.blocked);
    for (std::size_t k = 0; k < rays.count; ++k) {
        MaskRows& seen = (room.blocked[k / 32] >> (k % 32) & 1u) != 0 ? occluded : visible;
        seen[static_cast<std::size_t>(room.row[k])] |= std::uint64_t{1} << room.column[k];
    }
}

}  // namespace sightlines::visibility_field
