#include <algorithm>
#include <array>

#include "shaders/wide.h"  // first: makes the kernel below wide

#include "shaders/octahedral.h"
#include "techniques/rays/open_rays.h"
#include "techniques/visibility_field/ray_order.h"

namespace sightlines::visibility_field {
namespace {

namespace wide = wide_kernel;
using wide::Int;
using wide::lanes;
using wide::splat;

constexpr int map_size = 32;
constexpr std::size_t texels = map_size * map_size;

/// The lowest five bits, with a clear one between each two.
HWY_INLINE Int spread(Int bits) {
    bits = (bits | (bits << 4)) & splat(0x10f);
    bits = (bits | (bits << 2)) & splat(0x133);
    return (bits | (bits << 1)) & splat(0x155);
}

void find_keys(const float* const direction[3], std::size_t count, std::vector<std::uint32_t>& key) {
    for (std::size_t k = 0; k < count; k += lanes) {
        const wide::OctahedralTexel texel =
            wide::octahedral_texel(wide::octahedral_place({wide::load(direction[0] + k), wide::load(direction[1] + k),
                                                           wide::load(direction[2] + k)}),
                                   map_size);
        wide::store(wide::to_uint(spread(texel.column) | (spread(texel.row) << 1)), &key[k]);
    }
}

/// place[i]: where ray i goes. Counting sort, stable.
void find_places(std::span<const std::uint32_t> key, std::vector<std::uint32_t>& place) {
    std::array<std::uint32_t, texels + 1> next{};
    for (const std::uint32_t each : key) ++next[each + 1];
    for (std::size_t k = 1; k < next.size(); ++k) next[k] += next[k - 1];
    for (std::size_t k = 0; k < key.size(); ++k) place[k] = next[key[k]]++;
}

/// The rays in the room, sorted; room.place tells where each went.
PackedOpenRays sorted(const PackedOpenRays& rays, SortingRoom& room) {
    const std::size_t padded = rays.count + 32;
    if (room.key.size() < padded) {
        room.key.resize(padded);
        room.place.resize(padded);
        for (auto& axis : room.origin) axis.resize(padded);
        for (auto& axis : room.direction) axis.resize(padded);
        room.length_m.resize(padded);
    }
    find_keys(rays.direction, rays.count, room.key);
    find_places(std::span(room.key).first(rays.count), room.place);
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < rays.count; ++k) {
            room.origin[axis][room.place[k]] = rays.origin[axis][k];
            room.direction[axis][room.place[k]] = rays.direction[axis][k];
        }
    }
    if (rays.length_m != nullptr)
        for (std::size_t k = 0; k < rays.count; ++k) room.length_m[room.place[k]] = rays.length_m[k];
    return {{room.origin[0].data(), room.origin[1].data(), room.origin[2].data()},
            {room.direction[0].data(), room.direction[1].data(), room.direction[2].data()},
            rays.count,
            rays.length_m != nullptr ? room.length_m.data() : nullptr};
}

}  // namespace

void are_blocked_by_direction(const EmbreeScene& embree, const PackedOpenRays& rays, SortingRoom& room,
                              std::span<std::uint32_t> blocked) {
    const PackedOpenRays in_order = sorted(rays, room);
    room.blocked.resize(std::max(room.blocked.size(), rays.count / 32 + 1));
    are_blocked(embree, in_order, std::span(room.blocked).first(rays.count / 32 + 1));
    std::ranges::fill(blocked, 0u);
    for (std::size_t k = 0; k < rays.count; ++k) {
        const std::uint32_t at = room.place[k];
        blocked[k / 32] |= (room.blocked[at / 32] >> (at % 32) & 1u) << (k % 32);
    }
}

void find_closest_by_direction(const EmbreeScene& embree, const PackedOpenRays& rays, SortingRoom& room,
                               std::span<Hit> hits) {
    const PackedOpenRays in_order = sorted(rays, room);
    room.hits.resize(std::max(room.hits.size(), rays.count));
    find_closest(embree, in_order, std::span(room.hits).first(rays.count));
    for (std::size_t k = 0; k < rays.count; ++k) hits[k] = room.hits[room.place[k]];
}

}  // namespace sightlines::visibility_field
