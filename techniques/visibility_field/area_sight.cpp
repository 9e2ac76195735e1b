#include "techniques/visibility_field/area_sight.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <map>

#include "shaders/visibility_field.h"
#include "techniques/base/hammersley.h"
#include "techniques/base/parallel.h"
#include "techniques/base/random.h"
#include "techniques/visibility_field/ray_list.h"

namespace sightlines::visibility_field {
namespace {

constexpr std::uint64_t sight_seed = 0x7369676874u;
constexpr int batch = 16;  ///< segments of a cell and a part that are asked together: a packet
constexpr std::uint32_t drawn_per_part = 1024;

struct Baking {
    const AreaLights& lights;
    std::vector<AreaPoint> drawn;  ///< [parts][drawn_per_part]
    const EmbreeScene& embree;
    const SightOptions& options;
};

/// What some of a cell's segments to a part of the lights came to.
struct Seen {
    bool open = false, blocked = false;
    int rays = 0;
};

/// Points of each part, drawn once: any run of them is spread evenly.
std::vector<AreaPoint> draw_for_parts(const AreaLights& lights, std::uint64_t seed) {
    std::vector<AreaPoint> drawn;
    drawn.reserve(lights.parts.size() * drawn_per_part);
    for (std::uint32_t part = 0; part < lights.parts.size(); ++part) {
        const vec2 range = lights.parts[part];
        const vec2 shift(random_unit(seed ^ sight_seed, part, 0), random_unit(seed ^ sight_seed, part, 1));
        for (std::uint32_t k = 0; k < drawn_per_part; ++k) {
            // The plastic number's powers: Roberts' sequence.
            const vec2 square = glm::fract(shift + static_cast<float>(k) * vec2(0.7548777f, 0.5698403f));
            drawn.push_back(
                draw_point(lights, {std::min(glm::mix(range.x, range.y, square.x), 0x1.fffffep-1f), square.y}));
        }
    }
    return drawn;
}

/// Asks segment k between `points` and a part: the points in turn far apart, so that the first few already say most.
void add_segment(const Baking& baking, std::span<const SurfacePoint> points, std::uint32_t part, std::uint32_t first,
                 std::uint32_t k, SegmentList& segments) {
    const auto index = static_cast<std::size_t>(radical_inverse(k) * static_cast<float>(points.size()));
    const SurfacePoint& point = points[std::min(index, points.size() - 1)];
    const AreaPoint& there = baking.drawn[part * drawn_per_part + (first + k) % drawn_per_part];
    const float lift = lift_m(baking.embree);
    const AreaSegment segment = segment_to(baking.lights, there, point.position, point.normal, lift);
    if (segment.faces) segments.add(point.position + lift * point.normal, segment.end);
}

/// Casts segments until both answers came, or all are cast.
Seen look_at_part(const Baking& baking, std::span<const SurfacePoint> points, std::uint32_t part, std::uint32_t stream,
                  SegmentList& segments) {
    Seen seen;
    for (int first = 0; first < baking.options.rays && !(seen.open && seen.blocked); first += batch) {
        segments.rays.count = 0;
        for (int k = first; k < std::min(first + batch, baking.options.rays); ++k)
            add_segment(baking, points, part, stream, static_cast<std::uint32_t>(k), segments);
        if (segments.rays.count == 0) continue;
        std::uint32_t answers[1] = {};
        are_blocked(baking.embree, segments.packed(), answers);
        const int blocked = std::popcount(answers[0]), cast = static_cast<int>(segments.rays.count);
        seen.blocked = seen.blocked || blocked > 0;
        seen.open = seen.open || blocked < cast;
        seen.rays += cast;
    }
    return seen;
}

/// Looks at all parts from points that face one side; sets the bits that start at `row`.
std::uint64_t look_from(const Baking& baking, std::span<const SurfacePoint> points, std::uint32_t stream,
                        SegmentList& segments, std::uint32_t* row) {
    const std::size_t words = (baking.lights.parts.size() + 31) / 32;
    std::uint64_t cast = 0;
    for (std::uint32_t part = 0; part < baking.lights.parts.size(); ++part) {
        const Seen seen = look_at_part(baking, points, part, hash_u32(stream ^ hash_u32(part)), segments);
        row[part / 32] |= std::uint32_t{seen.open} << (part % 32);
        row[words + part / 32] |= std::uint32_t{seen.blocked} << (part % 32);
        cast += static_cast<std::uint64_t>(seen.rays);
    }
    return cast;
}

/// Most sides hold no surface, and neighbours know the same.
void keep_once(std::span<const std::uint32_t> all, AreaSight& sight) {
    const std::size_t row_words = 2 * sight.words;
    std::map<std::vector<std::uint32_t>, std::uint32_t> known;
    for (std::size_t at = 0; at < all.size(); at += row_words) {
        const auto row = all.subspan(at, row_words);
        const auto [found, is_new] =
            known.try_emplace({row.begin(), row.end()}, static_cast<std::uint32_t>(known.size()));
        if (is_new) sight.bits.insert(sight.bits.end(), row.begin(), row.end());
        sight.rows.push_back(found->second);
    }
}

std::uint32_t cell_of(const VisibilityField& field, std::uint32_t number) {
    const ivec3 place = cell_place(field.shape, number);
    return scalar_kernel::find_cell(field.shape, {field.bricks.data()}, place.x, place.y, place.z).index;
}

}  // namespace

std::size_t side_of(vec3 normal) {
    const vec3 along = glm::abs(normal);
    const int axis = along.x >= along.y && along.x >= along.z ? 0 : along.y >= along.z ? 1 : 2;
    return static_cast<std::size_t>(2 * axis + (normal[axis] < 0.0f ? 1 : 0));
}

AreaSight bake_area_sight(const Scene& scene, const VisibilityField& field, const EmbreeScene& embree,
                          const CellPoints& points, const SightOptions& options, Progress& progress) {
    AreaSight sight;
    const auto start = std::chrono::steady_clock::now();
    const AreaLights lights = find_area_lights(scene);
    if (options.rays == 0 || lights.triangles.empty()) return sight;
    const Baking baking{lights, draw_for_parts(lights, options.seed), embree, options};
    sight.words = (lights.parts.size() + 31) / 32;
    const std::size_t row_words = 2 * sight.words;
    std::vector<std::uint32_t> all(row_words * surface_sides * field.cells);
    std::atomic<std::uint64_t> rays{0};
    progress.begin("looking for lights from cells", static_cast<std::int64_t>(points.cells.size()));
    parallel_for(static_cast<std::int64_t>(points.cells.size()), options.threads, [&](std::int64_t index) {
        progress.check();
        thread_local SegmentList segments;
        const auto k = static_cast<std::size_t>(index);
        const std::size_t cell = cell_of(field, points.cells[k]);
        std::array<std::vector<SurfacePoint>, surface_sides> own;
        for (std::uint32_t at = points.first[k]; at < points.first[k + 1]; ++at)
            own[side_of(points.points[at].normal)].push_back(points.points[at]);
        std::uint64_t cast = 0;
        for (std::size_t side = 0; side < surface_sides; ++side)
            if (!own[side].empty())
                cast += look_from(baking, own[side], hash_u32(points.cells[k] * 8 + static_cast<std::uint32_t>(side)),
                                  segments, &all[(cell * surface_sides + side) * row_words]);
        rays += cast;
        progress.advance();
    });
    keep_once(all, sight);
    sight.rays = rays;
    sight.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return sight;
}

}  // namespace sightlines::visibility_field
