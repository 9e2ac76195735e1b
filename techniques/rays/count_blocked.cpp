// The opponent in the benchmark: Embree, asked as fast as we know how. What was tried, with 64 lights, 480x270 pixels,
// in M rays/s (twice one thread's rate by its CPU time, AVX-512): Crytek Sponza, lights through its box (91 % blocked),
// and the built-in atrium (30 % blocked).
//
//                                                                 Sponza, HIGH  MEDIUM quality    atrium, MEDIUM
//   packets of 16, tiles of 8x8 pixels                                      53              65
//   packets of 16, tiles of 32x32                                           60              77              30
//   ... of 8x2 pixels instead of 4x4                                        56
//   ... without the coherent flag                                           45
//   ... from the surface to the light                                       56
//   ... of the asked lanes only, packed together                            59              75
//   streams of 4 / 16 / 64 packets of 16 (rtcOccludedNM)        60 / 65 / 61    78 / 82 / 82    30 / 29 / 27
//   stream of single rays (rtcOccluded1M) / of arrays (rtcOccludedNp)  57 / 62       75 / 81         26 / 27
//   packets of 8 / single rays                                         42 / 18       53 / 21         24 / 16
//
// Flushing denormals, sorting the lights along a Morton curve, the lights outside the tiles, huge pages, a compact
// scene and AVX2 gain nothing or lose. So: from the light, 4x4 pixels a packet, coherent, lights inside tiles of 32x32,
// and streams of 16 packets. HIGH and MEDIUM quality tie on Sibenik and on the atrium.
#include <algorithm>
#include <array>
#include <chrono>

#include "techniques/base/parallel.h"
#include "techniques/rays/light_records.h"
#include "techniques/rays/reference.h"
#include "techniques/rays/shadow_blocks.h"

namespace sightlines {
namespace {

constexpr int tile_size = 32;                // pixels
constexpr std::size_t lights_per_task = 64;  // enough tasks for many threads, few enough to keep a tile in the cache
constexpr int stream_side = 16;              // pixels; a stream is the packets of so large a square
constexpr int packets_per_stream = (stream_side / block_side) * (stream_side / block_side);

/// Square by square of stream_side, so that packets of one stream are neighbours.
using Tile = std::vector<ShadowBlock>;

struct Count {
    std::uint64_t rays = 0, blocked = 0;
};

constexpr float not_asked = -1.0f;  // tfar of a stream's idle lanes

/// The lights of one task, asked for a tile in each of Embree's ways.
struct Asker {
    const EmbreeScene& embree;
    std::span<const LightRecord> lights;

    Count ask_single(const Tile& tile) const {
        const EmbreeQuery query(true);
        Count count;
        alignas(64) int valid[block_lanes];
        alignas(64) RTCRay16 aimed;
        RTCRay ray{};
        ray.tnear = shadow_ray_near;
        ray.mask = 0xffffffffu;
        for (const LightRecord& light : lights) {
            for (const ShadowBlock& block : tile) {
                if (mark_asked(block, light, embree.reach_m, valid) == 0) continue;
                aim_packet(block, 0, light, embree.reach_m, aimed);
                for (int lane = 0; lane < block_lanes; ++lane) {
                    if (valid[lane] == 0) continue;
                    ray.org_x = aimed.org_x[lane];
                    ray.org_y = aimed.org_y[lane];
                    ray.org_z = aimed.org_z[lane];
                    ray.dir_x = aimed.dir_x[lane];
                    ray.dir_y = aimed.dir_y[lane];
                    ray.dir_z = aimed.dir_z[lane];
                    ray.tfar = shadow_ray_far;
                    occluded_1(embree, query, ray);
                    ++count.rays;
                    count.blocked += ray.tfar < 0.0f ? 1 : 0;
                }
            }
        }
        return count;
    }

    template <class Packet>
    Count ask_packets(const Tile& tile) const {
        constexpr int lanes = sizeof(Packet::tnear) / sizeof(float);
        const EmbreeQuery query(true);
        Count count;
        alignas(64) int valid[block_lanes];
        alignas(64) Packet rays;
        prepare_packet(rays);
        for (const LightRecord& light : lights) {
            for (const ShadowBlock& block : tile) {
                if (mark_asked(block, light, embree.reach_m, valid) == 0) continue;
                for (int first = 0; first < block_lanes; first += lanes) {
                    int asked = 0;
                    for (int lane = first; lane < first + lanes; ++lane) asked -= valid[lane];
                    if (asked == 0) continue;
                    aim_packet(block, first, light, embree.reach_m, rays);
                    occluded_packet(valid + first, embree, query, rays);
                    int blocked = 0;
                    for (int lane = 0; lane < lanes; ++lane)
                        blocked += valid[first + lane] != 0 && rays.tfar[lane] < 0.0f ? 1 : 0;
                    count.rays += static_cast<std::uint64_t>(asked);
                    count.blocked += static_cast<std::uint64_t>(blocked);
                }
            }
        }
        return count;
    }

    Count ask_stream(const Tile& tile) const {
        const EmbreeQuery query(true);
        Count count;
        alignas(64) int valid[block_lanes];
        alignas(64) std::array<RTCRay16, packets_per_stream> packets;
        for (RTCRay16& rays : packets) prepare_packet(rays);
        for (const LightRecord& light : lights) {
            for (std::size_t first = 0; first < tile.size(); first += packets_per_stream) {
                unsigned used = 0;
                for (const ShadowBlock& block : std::span(tile).subspan(first).first(
                         std::min<std::size_t>(packets_per_stream, tile.size() - first))) {
                    const int asked = mark_asked(block, light, embree.reach_m, valid);
                    if (asked == 0) continue;
                    RTCRay16& rays = packets[used++];
                    aim_packet(block, 0, light, embree.reach_m, rays);
                    for (int lane = 0; lane < block_lanes; ++lane)
                        rays.tfar[lane] = valid[lane] != 0 ? shadow_ray_far : not_asked;
                    count.rays += static_cast<std::uint64_t>(asked);
                }
                occluded_stream(embree, query, packets.data(), used);
                for (unsigned i = 0; i < used; ++i) count.blocked += blocked_lanes(packets[i]);
            }
        }
        return count;
    }

    static std::uint64_t blocked_lanes(const RTCRay16& rays) {
        int blocked = 0;
        for (int lane = 0; lane < block_lanes; ++lane) blocked += rays.tfar[lane] < not_asked ? 1 : 0;
        return static_cast<std::uint64_t>(blocked);
    }

    Count ask(EmbreeVariant variant, const Tile& tile) const {
        switch (variant) {
            case EmbreeVariant::single:
                return ask_single(tile);
            case EmbreeVariant::packet_8:
                return ask_packets<RTCRay8>(tile);
            case EmbreeVariant::packet_16:
                return ask_packets<RTCRay16>(tile);
            case EmbreeVariant::stream:
                return ask_stream(tile);
        }
        return {};
    }
};

std::vector<Tile> make_tiles(const EmbreeScene& embree, const SurfaceBuffer& surfaces, int threads) {
    const int columns = (surfaces.size.width + tile_size - 1) / tile_size;
    const int rows = (surfaces.size.height + tile_size - 1) / tile_size;
    std::vector<Tile> tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    parallel_for(static_cast<std::int64_t>(tiles.size()), threads, [&](std::int64_t index) {
        const int left = static_cast<int>(index % columns) * tile_size;
        const int top = static_cast<int>(index / columns) * tile_size;
        constexpr int squares_across = tile_size / stream_side;
        constexpr int blocks_across = stream_side / block_side;
        for (int i = 0; i < squares_across * squares_across * packets_per_stream; ++i) {
            const int square = i / packets_per_stream;
            const int place = i % packets_per_stream;
            const int x = square % squares_across * stream_side + place % blocks_across * block_side;
            const int y = square / squares_across * stream_side + place / blocks_across * block_side;
            const ShadowBlock block = shadow_block(surfaces, left + x, top + y, surface_offset_m(embree));
            if (block.any_surface) tiles[static_cast<std::size_t>(index)].push_back(block);
        }
    });
    return tiles;
}

}  // namespace

QueryCount count_blocked(const EmbreeScene& embree, EmbreeVariant variant, const SurfaceBuffer& surfaces,
                         std::span<const Light> lights, int threads) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<LightRecord> records = light_records(lights);
    const std::vector<Tile> tiles = make_tiles(embree, surfaces, threads);
    const std::size_t light_groups = (records.size() + lights_per_task - 1) / lights_per_task;
    std::vector<Count> counts(tiles.size() * light_groups);
    parallel_for(static_cast<std::int64_t>(counts.size()), threads, [&](std::int64_t task) {
        const std::size_t index = static_cast<std::size_t>(task);
        const std::size_t first = index % light_groups * lights_per_task;
        const std::size_t size = std::min(lights_per_task, records.size() - first);
        const Asker asker{embree, std::span(records).subspan(first, size)};
        counts[index] = asker.ask(variant, tiles[index / light_groups]);
    });
    QueryCount total;
    for (const Count& count : counts) {
        total.rays += count.rays;
        total.blocked += count.blocked;
    }
    total.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return total;
}

}  // namespace sightlines
