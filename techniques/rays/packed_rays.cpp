#include "techniques/rays/packed_rays.h"

#include <algorithm>
#include <array>

#include "techniques/rays/embree_handles.h"

namespace sightlines {
namespace {

constexpr std::size_t packet_lanes = 16;
constexpr std::size_t packets_per_stream = 16;  // the best in count_blocked.cpp
constexpr float not_asked = -1.0f;              // tfar of a stream's idle lanes

/// The rays from the light to the points from `first` on, as many as the packet holds.
template <class Packet>
void aim(const EmbreeScene& embree, const LightRecord& light, const PackedSurfaces& surfaces, std::size_t first,
         Packet& rays) {
    constexpr std::size_t lanes = sizeof(rays.tnear) / sizeof(float);
    const bool directional = light.kind == light_directional;
    const float follows = directional ? 1.0f : 0.0f;  // the origin follows the point
    const vec3 origin = directional ? light.direction * -embree.reach_m : light.position;
    const float offset = surface_offset_m(embree);
    float* const org[3] = {rays.org_x, rays.org_y, rays.org_z};
    float* const dir[3] = {rays.dir_x, rays.dir_y, rays.dir_z};
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const float position = surfaces.position[axis][first + lane];
            org[axis][lane] = follows * position + origin[axis];
            dir[axis][lane] = position + offset * surfaces.normal[axis][first + lane] - org[axis][lane];
        }
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        rays.tnear[lane] = shadow_ray_near;
        rays.tfar[lane] = first + lane < surfaces.count ? shadow_ray_far : not_asked;
        rays.time[lane] = 0.0f;
        rays.mask[lane] = 0xffffffffu;
        rays.id[lane] = static_cast<unsigned>(lane);
        rays.flags[lane] = 0;
    }
}

/// Writes the answers of a packet's rays, of which `first` is the number of the first.
struct Answers {
    std::size_t bits_per_word;
    std::span<std::uint32_t> words;

    void set(std::size_t ray) const { words[ray / bits_per_word] |= 1u << (ray % bits_per_word); }
    template <class Packet>
    void take(const Packet& rays, std::size_t first) const {
        constexpr std::size_t lanes = sizeof(rays.tnear) / sizeof(float);
        for (std::size_t lane = 0; lane < lanes; ++lane)
            if (rays.tfar[lane] < not_asked) set(first + lane);
    }
};

template <class Packet>
void ask_packets(const EmbreeScene& embree, const LightRecord& light, const PackedSurfaces& surfaces,
                 const Answers& answers) {
    constexpr std::size_t lanes = sizeof(Packet::tnear) / sizeof(float);
    const EmbreeQuery query(true);
    alignas(64) Packet rays;
    alignas(64) int valid[lanes];
    for (std::size_t first = 0; first < surfaces.count; first += lanes) {
        aim(embree, light, surfaces, first, rays);
        for (std::size_t lane = 0; lane < lanes; ++lane) valid[lane] = first + lane < surfaces.count ? -1 : 0;
        occluded_packet(valid, embree, query, rays);
        answers.take(rays, first);
    }
}

void ask_stream(const EmbreeScene& embree, const LightRecord& light, const PackedSurfaces& surfaces,
                const Answers& answers) {
    const EmbreeQuery query(true);
    alignas(64) std::array<RTCRay16, packets_per_stream> packets;
    for (std::size_t first = 0; first < surfaces.count; first += packets_per_stream * packet_lanes) {
        std::size_t used = 0;
        for (; used < packets_per_stream && first + used * packet_lanes < surfaces.count; ++used)
            aim(embree, light, surfaces, first + used * packet_lanes, packets[used]);
        occluded_stream(embree, query, packets.data(), static_cast<unsigned>(used));
        for (std::size_t i = 0; i < used; ++i) answers.take(packets[i], first + i * packet_lanes);
    }
}

void ask_single(const EmbreeScene& embree, const LightRecord& light, const PackedSurfaces& surfaces,
                const Answers& answers) {
    const EmbreeQuery query(true);
    alignas(64) RTCRay16 aimed;
    RTCRay ray{};
    for (std::size_t first = 0; first < surfaces.count; first += packet_lanes) {
        aim(embree, light, surfaces, first, aimed);
        for (std::size_t lane = 0; lane < std::min(packet_lanes, surfaces.count - first); ++lane) {
            ray.org_x = aimed.org_x[lane];
            ray.org_y = aimed.org_y[lane];
            ray.org_z = aimed.org_z[lane];
            ray.dir_x = aimed.dir_x[lane];
            ray.dir_y = aimed.dir_y[lane];
            ray.dir_z = aimed.dir_z[lane];
            ray.tnear = shadow_ray_near;
            ray.tfar = shadow_ray_far;
            ray.mask = 0xffffffffu;
            occluded_1(embree, query, ray);
            if (ray.tfar < 0.0f) answers.set(first + lane);
        }
    }
}

}  // namespace

void are_occluded(const EmbreeScene& embree, EmbreeVariant variant, const LightRecord& light,
                  const PackedSurfaces& surfaces, std::size_t bits_per_word, std::span<std::uint32_t> blocked) {
    std::ranges::fill(blocked, 0u);
    const Answers answers{bits_per_word, blocked};
    switch (variant) {
        case EmbreeVariant::single:
            return ask_single(embree, light, surfaces, answers);
        case EmbreeVariant::packet_8:
            return ask_packets<RTCRay8>(embree, light, surfaces, answers);
        case EmbreeVariant::packet_16:
            return ask_packets<RTCRay16>(embree, light, surfaces, answers);
        case EmbreeVariant::stream:
            return ask_stream(embree, light, surfaces, answers);
    }
}

}  // namespace sightlines
