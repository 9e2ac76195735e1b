#include "techniques/visibility_field/one_bounce.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "shaders/one_bounce.h"
#include "techniques/base/hammersley.h"
#include "techniques/base/random.h"
#include "techniques/visibility_field/decide.h"
#include "techniques/visibility_field/picture_tiles.h"
#include "techniques/visibility_field/ray_list.h"
#include "techniques/visibility_field/weighted_samples.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

constexpr std::uint64_t second_ray_seed = 0x626f756e6365u;

/// A sample that met something: its pixel, and what radiance from there adds to the pixel's irradiance.
struct Blocked {
    std::uint32_t pixel = 0;
    vec3 weight{0.0f};
};

struct Picture {
    const VisibilityField* field;
    const EmbreeScene& embree;
    const Scene& scene;
    const EnvironmentRequest& request;
    const EnvironmentRequest& white;  ///< the same samples under even light: what each weighs
    WeightedTables tables;            ///< of these
    EnvironmentResult& result;
    ImageRgb& gained;  ///< irradiance
};

struct TileRoom {
    RayList first, second;
    std::vector<Blocked> blocked{};
    std::vector<Waiting> waiting{};
    std::vector<Hit> hits = std::vector<Hit>(most_waiting);
    AskingRoom asking{};
    SampleCounts counts{};
};

/// A second ray's answer where the field knows it.
kernel::Decision decide_second(const VisibilityField* field, const EnvironmentRequest& request, const SecondRay& ray,
                               bool& outside) {
    const bool above = kernel::leaves_surface(ray.surface.normal, ray.direction);
    if (field == nullptr) return kernel::decide_without_masks(above);
    const kernel::FieldCell cell =
        kernel::locate_cell(field->shape, {field->bricks.data()}, ray.surface.position, ray.surface.normal);
    outside = cell.index == kernel::no_cell;
    return outside ? kernel::decide_without_masks(above)
                   : decide(*field, culling_used(request), cell, ray.direction, above);
}

void answer_second(const Picture& picture, TileRoom& room) {
    room.counts.traced_blocked += gain_from_open(picture.embree, picture.request.order, room.second.packed(),
                                                 room.waiting, room.asking, picture.gained);
    room.second.count = 0;
    room.waiting.clear();
}

/// Lights what a sample hit, or has its second ray wait.
void light_hit(const Picture& picture, const Blocked& from, const SecondRay& ray, TileRoom& room) {
    ++room.counts.samples;
    bool outside = false;
    const kernel::Decision decision = decide_second(picture.field, picture.request, ray, outside);
    if (!decision.trace) {
        if (!kernel::leaves_surface(ray.surface.normal, ray.direction)) ++room.counts.below;
        if (!decision.open) return;
    }
    const vec3 adds = from.weight * kernel::sent_back(ray.surface.albedo, ray.light, false);
    if (decision.open) {
        picture.gained.pixels[from.pixel] += adds;
        return;
    }
    ++room.counts.traced;
    if (outside) ++room.counts.outside;
    ++picture.result.rays_traced.pixels[from.pixel];
    room.second.add(lifted_off(picture.embree, ray.surface.position, ray.surface.normal), ray.direction);
    room.waiting.push_back({from.pixel, adds});
}

/// Finds what the samples that wait have hit, and lights it.
void answer_first(const Picture& picture, TileRoom& room) {
    const PackedOpenRays rays = room.first.packed();
    if (picture.request.order == RayOrder::direction)
        find_closest_by_direction(picture.embree, rays, room.asking.sorting, room.hits);
    else
        find_closest(picture.embree, rays, room.hits);
    for (std::size_t k = 0; k < room.first.count; ++k) {
        if (room.hits[k].triangle == no_triangle) continue;  // blocked by the masks alone
        light_hit(picture, room.blocked[k],
                  second_ray(picture.scene, picture.request, room.hits[k], room.first.origin_of(k),
                             room.first.direction_of(k), picture.request.pattern->seed),
                  room);
    }
    answer_second(picture, room);
    room.first.count = 0;
    room.blocked.clear();
}

/// A pixel's samples, and what even light of radiance 1 from each would add.
std::vector<PixelSample> weighed_samples(const Picture& picture, std::size_t pixel) {
    if (is_weighted(picture.request)) return weighted_samples(picture.white, picture.tables, pixel);
    const EnvironmentRequest& request = picture.request;
    const SurfaceBuffer& surfaces = *request.surfaces;
    const SamplePattern& pattern = *request.pattern;
    const auto width = static_cast<std::size_t>(surfaces.size.width);
    const std::size_t tile = pattern.tile_place(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    const kernel::HemisphereFrame frame =
        kernel::frame_about(surfaces.shading_normal[pixel], pattern.turns[tile].x, pattern.turns[tile].y);
    std::vector<PixelSample> samples(static_cast<std::size_t>(pattern.samples));
    for (std::size_t k = 0; k < samples.size(); ++k)
        samples[k] = {kernel::direction_in(frame, pattern.x[k], pattern.y[k], pattern.z[k]),
                      vec3(std::numbers::pi_v<float> / static_cast<float>(pattern.samples))};
    return samples;
}

void follow_pixel(const Picture& picture, int x, int y, TileRoom& room) {
    const SurfaceBuffer& surfaces = *picture.request.surfaces;
    const auto pixel = static_cast<std::uint32_t>(y * surfaces.size.width + x);
    const Verdicts& verdicts = picture.result.verdicts;
    if (surfaces.triangle[pixel] == no_triangle) return;
    const std::uint32_t* const words = &verdicts.words[std::size_t{pixel} * verdicts.words_per_pixel];
    if (std::all_of(words, words + verdicts.words_per_pixel, [](std::uint32_t word) { return word == 0; })) return;
    const std::vector<PixelSample> samples = weighed_samples(picture, pixel);
    const vec3 start = lifted_off(picture.embree, surfaces.position[pixel], surfaces.normal[pixel]);
    for (std::uint32_t word = 0; word < verdicts.words_per_pixel; ++word) {
        for (std::uint32_t bits = words[word]; bits != 0; bits &= bits - 1) {
            const auto sample = static_cast<std::size_t>(32 * word) + static_cast<std::size_t>(std::countr_zero(bits));
            room.first.add(start, samples[sample].direction);
            room.blocked.push_back({pixel, samples[sample].adds});
            if (room.first.count == most_waiting) answer_first(picture, room);
        }
    }
}

SampleCounts follow_tile(const Picture& picture, int left, int top) {
    TileRoom room;
    for_pixels_of_tile(picture.request.surfaces->size, left, top,
                       [&](int x, int y) { follow_pixel(picture, x, y, room); });
    answer_first(picture, room);
    add_gained(picture.request, picture.gained, left, top, picture.result);
    return room.counts;
}

/// The radiance of the request's light from a direction.
vec3 light_from(const EnvironmentRequest& request, vec3 direction) {
    return request.map != nullptr ? radiance_from(*request.map, direction) : radiance(request.light, direction);
}

}  // namespace

SecondRay second_ray(const Scene& scene, const EnvironmentRequest& request, const Hit& hit, vec3 origin, vec3 direction,
                     std::uint64_t seed) {
    std::uint32_t stream = hit.triangle;
    for (const vec3 each : {origin, direction})
        for (int axis = 0; axis < 3; ++axis) stream = hash_u32(stream ^ std::bit_cast<std::uint32_t>(each[axis]));
    const auto number = [&](std::uint32_t which) { return random_unit(seed ^ second_ray_seed, stream, which); };
    SecondRay ray;
    ray.surface = surface_at(scene, hit, direction);
    const vec3 up = ray.surface.shading_normal;
    ray.about_up = cosine_direction({number(0), number(1)});
    const MapDistribution* const map = request.distribution;
    if (map != nullptr && number(2) < 0.5f) {
        const kernel::HemisphereFrame frame = kernel::frame_about(up, 1.0f, 0.0f);
        ray.about_up =
            drawn_direction(*map, {number(0), number(1)}) * mat3(frame.tangent, frame.bitangent, frame.normal);
    }
    ray.direction = kernel::second_direction(up, ray.about_up);
    const float density = std::max(glm::dot(up, ray.direction), 0.0f) * std::numbers::inv_pi_v<float>;
    const float drawn = map != nullptr ? 0.5f * (density + drawn_density(*map, ray.direction)) : density;
    ray.light = drawn > 0.0f ? density / drawn * light_from(request, ray.direction) : vec3(0.0f);
    return ray;
}

EnvironmentResult with_one_bounce(const VisibilityField* field, const EmbreeScene& embree, const Scene& scene,
                                  const EnvironmentRequest& request,
                                  const std::function<EnvironmentResult(const EnvironmentRequest&)>& make,
                                  Progress& progress) {
    EnvironmentRequest asked = request;
    asked.keep_verdicts = true;
    EnvironmentResult result = make(asked);
    EnvironmentRequest white = request;
    white.map = nullptr;
    white.light = {};
    white.light.coefficient[0] = vec3(2.0f * std::sqrt(std::numbers::pi_v<float>));  // over Y00: 1 from everywhere
    ImageRgb gained(request.surfaces->size);
    const Picture picture{field, embree, scene, request, white, weighted_tables(white), result, gained};
    result.second_rays =
        go_over_tiles(request, result, progress, [&](int left, int top) { return follow_tile(picture, left, top); });
    if (!request.keep_verdicts) result.verdicts = {};
    return result;
}

}  // namespace sightlines::visibility_field
