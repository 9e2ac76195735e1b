// Rays that wait to be asked together. Internal to this folder.
#pragma once

#include <vector>

#include "techniques/visibility_field/ray_order.h"
#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

constexpr std::size_t most_waiting = 32768;  ///< rays that are asked together

/// Rays side by side, with room for a whole last packet.
struct RayList {
    std::vector<float> origin[3], direction[3];
    std::size_t count = 0;

    RayList() {
        for (auto& axis : origin) axis.resize(most_waiting + 16);
        for (auto& axis : direction) axis.resize(most_waiting + 16);
    }
    void add(vec3 from, vec3 along) {
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis][count] = from[axis];
            direction[axis][count] = along[axis];
        }
        ++count;
    }
    PackedOpenRays packed() const {
        return {{origin[0].data(), origin[1].data(), origin[2].data()},
                {direction[0].data(), direction[1].data(), direction[2].data()},
                count};
    }
    vec3 direction_of(std::size_t ray) const { return {direction[0][ray], direction[1][ray], direction[2][ray]}; }
    vec3 origin_of(std::size_t ray) const { return {origin[0][ray], origin[1][ray], origin[2][ray]}; }
};

/// Rays that end.
struct SegmentList {
    RayList rays;
    std::vector<float> length_m = std::vector<float>(most_waiting + 16);

    /// The points must be apart.
    void add(vec3 from, vec3 to) {
        const float length = glm::distance(from, to);
        length_m[rays.count] = length;
        rays.add(from, (to - from) / length);
    }
    PackedOpenRays packed() const {
        PackedOpenRays packed = rays.packed();
        packed.length_m = length_m.data();
        return packed;
    }
};

/// What a ray that waits is for: its pixel, and what that gains where nothing is in the way.
struct Waiting {
    std::uint32_t pixel = 0;
    vec3 adds{0.0f};
};

/// What one thread needs to ask waiting rays.
struct AskingRoom {
    SortingRoom sorting{};
    std::vector<std::uint32_t> answers = std::vector<std::uint32_t>(most_waiting / 32 + 1);
};

/// Asks the rays, at most most_waiting; the pixels of those that are open gain. Returns how many are blocked.
inline std::uint64_t gain_from_open(const EmbreeScene& embree, RayOrder order, const PackedOpenRays& rays,
                                    const std::vector<Waiting>& waiting, AskingRoom& room, ImageRgb& gained) {
    if (order == RayOrder::direction)
        are_blocked_by_direction(embree, rays, room.sorting, room.answers);
    else
        are_blocked(embree, rays, room.answers);
    std::uint64_t all_blocked = 0;
    for (std::size_t ray = 0; ray < rays.count; ++ray) {
        const bool blocked = (room.answers[ray / 32] >> (ray % 32) & 1u) != 0;
        all_blocked += blocked ? 1 : 0;
        if (!blocked) gained.pixels[waiting[ray].pixel] += waiting[ray].adds;
    }
    return all_blocked;
}

}  // namespace sightlines::visibility_field
