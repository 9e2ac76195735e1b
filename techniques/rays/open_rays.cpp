#include "techniques/rays/open_rays.h"

#include <algorithm>
#include <limits>

#include "techniques/rays/embree_handles.h"

namespace sightlines {
namespace {

constexpr std::size_t packet_lanes = 16;

/// Takes the rays from `first` on into the packet (an RTCRay16); those behind the last are not valid.
void load_packet(const PackedOpenRays& rays, std::size_t first, RTCRay16& packet, int* valid) {
    float* const origin[3] = {packet.org_x, packet.org_y, packet.org_z};
    float* const direction[3] = {packet.dir_x, packet.dir_y, packet.dir_z};
    for (int axis = 0; axis < 3; ++axis) {
        std::copy_n(rays.origin[axis] + first, packet_lanes, origin[axis]);
        std::copy_n(rays.direction[axis] + first, packet_lanes, direction[axis]);
    }
    if (rays.length_m != nullptr)
        std::copy_n(rays.length_m + first, packet_lanes, packet.tfar);
    else
        std::ranges::fill(packet.tfar, std::numeric_limits<float>::infinity());
    const std::size_t used = std::min(packet_lanes, rays.count - first);
    for (std::size_t lane = 0; lane < packet_lanes; ++lane) valid[lane] = lane < used ? -1 : 0;
}

}  // namespace

float lift_m(const EmbreeScene& embree) { return surface_offset_m(embree); }

vec3 lifted_off(const EmbreeScene& embree, vec3 position, vec3 normal) { return position + lift_m(embree) * normal; }

void are_blocked(const EmbreeScene& embree, const PackedOpenRays& rays, std::span<std::uint32_t> blocked) {
    std::ranges::fill(blocked, 0u);
    const EmbreeQuery query(false);
    alignas(64) RTCRay16 packet{};
    alignas(64) int valid[packet_lanes];
    std::ranges::fill(packet.mask, 0xffffffffu);
    for (std::size_t first = 0; first < rays.count; first += packet_lanes) {
        load_packet(rays, first, packet, valid);
        occluded_packet(valid, embree, query, packet);
        std::uint32_t bits = 0;
        for (std::size_t lane = 0; lane < packet_lanes; ++lane) bits |= std::uint32_t{packet.tfar[lane] < 0.0f} << lane;
        blocked[first / 32] |= bits << (first % 32);
    }
}

void find_closest(const EmbreeScene& embree, const PackedOpenRays& rays, std::span<Hit> hits) {
    const EmbreeQuery query(false);
    alignas(64) RTCRayHit16 packet{};
    alignas(64) int valid[packet_lanes];
    std::ranges::fill(packet.ray.mask, 0xffffffffu);
    for (std::size_t first = 0; first < rays.count; first += packet_lanes) {
        load_packet(rays, first, packet.ray, valid);
        std::ranges::fill(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
        std::ranges::fill(packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
        intersect_16(valid, embree, query, packet);
        for (std::size_t lane = 0; lane < std::min(packet_lanes, rays.count - first); ++lane) {
            Hit& hit = hits[first + lane];
            hit = {};
            if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
            hit = {packet.ray.tfar[lane],
                   triangle_hit(embree, packet.hit.geomID[lane], packet.hit.primID[lane]),
                   {packet.hit.u[lane], packet.hit.v[lane]}};
        }
    }
}

bool is_blocked(const EmbreeScene& embree, vec3 origin, vec3 direction) {
    const EmbreeQuery query(false);
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = 0xffffffffu;
    occluded_1(embree, query, ray);
    return ray.tfar < 0.0f;
}

}  // namespace sightlines
