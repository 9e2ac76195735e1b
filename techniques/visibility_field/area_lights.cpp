#include "techniques/visibility_field/area_lights.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "shaders/area_light.h"
#include "shaders/glossy.h"
#include "techniques/base/hammersley.h"
#include "techniques/base/random.h"
#include "techniques/rays/texture_sampling.h"
#include "techniques/visibility_field/area_sight.h"
#include "techniques/visibility_field/picture_tiles.h"
#include "techniques/visibility_field/ray_list.h"
#include "techniques/visibility_field/weighted_samples.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

constexpr std::uint64_t area_seed = 0x61726561u;
constexpr float largest_below_1 = 0x1.fffffep-1f;
constexpr float least_points = 16.0f, most_points = 16384.0f;

/// Evenly over a triangle, from two numbers in [0, 1).
vec2 point_in_triangle(vec2 numbers) {
    const float across = std::sqrt(numbers.x);
    return {across * (1.0f - numbers.y), across * numbers.y};
}

/// How many texels of a texture a triangle covers.
float texels_covered(const Scene& scene, std::uint32_t triangle, const std::optional<TextureLookup>& lookup) {
    if (!lookup || scene.texture_coordinates[lookup->coordinate_set].empty()) return 0.0f;
    const uvec3 vertices = scene.triangles[triangle];
    const auto place = [&](std::uint32_t vertex) {
        return transformed_coordinates(*lookup, scene.texture_coordinates[lookup->coordinate_set][vertex]);
    };
    const vec2 u = place(vertices.y) - place(vertices.x), v = place(vertices.z) - place(vertices.x);
    const ImageSize size = scene.textures[lookup->texture].texels.size;
    return 0.5f * std::fabs(u.x * v.y - u.y * v.x) * static_cast<float>(size.width) * static_cast<float>(size.height);
}

/// Its mean over the triangle and the channels.
float mean_emission(const Scene& scene, std::uint32_t triangle) {
    const Material& material = scene.materials[scene.triangle_materials[triangle]];
    const float texels = std::max(texels_covered(scene, triangle, material.emissive_texture),
                                  texels_covered(scene, triangle, material.base_color_texture));
    const bool even = !material.emissive_texture && material.alpha_mode != AlphaMode::mask;
    // Not more than this many: a texture may be repeated any number of times, and coordinates need not be finite.
    const auto points =
        static_cast<std::uint32_t>(even                    ? 1.0f
                                   : std::isfinite(texels) ? std::clamp(texels, least_points, most_points)
                                                           : most_points);
    double sum = 0.0;
    for (std::uint32_t k = 0; k < points; ++k) {
        const vec3 emission = emission_at(scene, triangle, point_in_triangle(hammersley(k, points)));
        sum += double{emission.x} + double{emission.y} + double{emission.z};
    }
    return static_cast<float>(sum / (3.0 * points));
}

struct Picture {
    const VisibilityField* field;
    const AreaSight* sight;
    const EmbreeScene& embree;
    const Scene& scene;
    const EnvironmentRequest& request;
    const AreaLights& lights;
    const std::vector<vec2>& even;  ///< what each pixel's points are drawn by, before they are shifted
    EnvironmentResult& result;
    ImageRgb& gained;  ///< irradiance
};

struct TileRoom {
    SegmentList segments;
    std::vector<Waiting> waiting{};
    AskingRoom asking{};
    SampleCounts counts{};
};

/// A pixel's surface, and what its cell knows.
struct LitPixel {
    std::uint32_t pixel = 0;
    WeightedPixel weighted;
    vec3 position{0.0f}, start{0.0f};
    std::uint32_t cell = kernel::no_cell;
    std::size_t known_at = 0;  ///< AreaSight::place of the cell
};

/// What of the light from `direction` the surface reflects, times pi: 1 where it reflects evenly.
vec3 reflected_times_pi(const SampledSurface& surface, vec3 direction) {
    if (surface.is_glossy == 0u) return vec3(1.0f);
    const vec3 to_light = direction * mat3(surface.tangent, surface.bitangent, surface.up);
    return std::numbers::pi_v<float> * kernel::reflection_of(surface.gloss, to_light).share;
}

void answer_waiting(const Picture& picture, TileRoom& room) {
    room.counts.traced_blocked += gain_from_open(picture.embree, picture.request.order, room.segments.packed(),
                                                 room.waiting, room.asking, picture.gained);
    room.segments.rays.count = 0;
    room.waiting.clear();
}

/// Whether the segment is traced, where it faces both ends.
kernel::Decision decide_for(const Picture& picture, const LitPixel& lit, const AreaPoint& point, bool faces) {
    if (picture.sight == nullptr || lit.cell == kernel::no_cell) return kernel::decide_segment(faces, false, false);
    const std::uint32_t part = picture.lights.triangles[point.at].part;
    return kernel::decide_segment(faces, picture.sight->seen(lit.known_at, part),
                                  picture.sight->hidden(lit.known_at, part));
}

void light_from_point(const Picture& picture, const LitPixel& lit, const AreaPoint& point, TileRoom& room) {
    ++room.counts.samples;
    const SampledSurface& surface = lit.weighted.surface;
    const AreaSegment segment = segment_to(picture.lights, point, lit.position, surface.normal, lift_m(picture.embree));
    const AreaTriangle& light = picture.lights.triangles[point.at];
    const float cosine_here = glm::dot(surface.up, segment.direction);
    const bool faces = segment.faces && cosine_here > 0.0f;
    const kernel::Decision decision = decide_for(picture, lit, point, faces);
    if (!faces) ++room.counts.below;
    if (decision.blocked) return;
    const vec3 emission = emission_at(picture.scene, light.triangle, point.barycentric);
    const vec3 adds = kernel::segment_adds(emission, cosine_here, segment.cosine_there, segment.distance_m,
                                           light.per_m2 * static_cast<float>(picture.even.size())) *
                      reflected_times_pi(surface, segment.direction);
    if (decision.open) {
        picture.gained.pixels[lit.pixel] += adds;
        return;
    }
    ++room.counts.traced;
    if (picture.sight != nullptr && lit.cell == kernel::no_cell) ++room.counts.outside;
    ++picture.result.rays_traced.pixels[lit.pixel];
    room.segments.add(lit.start, segment.end);
    room.waiting.push_back({lit.pixel, adds});
    if (room.waiting.size() == most_waiting) answer_waiting(picture, room);
}

void light_pixel(const Picture& picture, int x, int y, TileRoom& room) {
    const SurfaceBuffer& surfaces = *picture.request.surfaces;
    LitPixel lit;
    lit.pixel = static_cast<std::uint32_t>(y * surfaces.size.width + x);
    if (surfaces.triangle[lit.pixel] == no_triangle) return;
    lit.weighted = weighted_pixel(picture.request, lit.pixel);
    lit.position = surfaces.position[lit.pixel];
    lit.start = lifted_off(picture.embree, lit.position, surfaces.normal[lit.pixel]);
    if (picture.field != nullptr)
        lit.cell = kernel::locate_cell(picture.field->shape, {picture.field->bricks.data()}, lit.position,
                                       surfaces.normal[lit.pixel])
                       .index;
    if (picture.sight != nullptr && lit.cell != kernel::no_cell)
        lit.known_at = picture.sight->place(lit.cell, side_of(surfaces.normal[lit.pixel]));
    const vec2 shift = point_shift(picture.request, lit.pixel);
    for (const vec2 even : picture.even)
        light_from_point(picture, lit, draw_point(picture.lights, glm::fract(even + shift)), room);
}

SampleCounts light_tile(const Picture& picture, int left, int top) {
    TileRoom room;
    for_pixels_of_tile(picture.request.surfaces->size, left, top,
                       [&](int x, int y) { light_pixel(picture, x, y, room); });
    answer_waiting(picture, room);
    add_gained(picture.request, picture.gained, left, top, picture.result);
    return room.counts;
}

/// Where the parts begin: at the first triangle, and at those that lie farthest from the one before. So what hangs
/// together is one part, as long as there are not too many.
std::vector<std::uint8_t> first_of_parts(const AreaLights& lights) {
    const std::size_t count = lights.triangles.size();
    std::vector<float> step_m(count, std::numeric_limits<float>::infinity());
    const auto middle = [&](std::size_t k) {
        return lights.triangles[k].corner + (lights.triangles[k].u + lights.triangles[k].v) / 3.0f;
    };
    for (std::size_t k = 1; k < count; ++k) step_m[k] = glm::distance(middle(k - 1), middle(k));
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t k) { return step_m[k]; });
    std::vector<std::uint8_t> begins(count);
    for (std::size_t k = 0; k < std::min(count, most_light_parts); ++k) begins[order[k]] = 1;
    return begins;
}

/// Fills in which share of the power goes to which triangle and part.
void share_out(const std::vector<double>& power, AreaLights& lights) {
    const double all = std::reduce(power.begin(), power.end());
    const std::vector<std::uint8_t> begins = first_of_parts(lights);
    double sum = 0.0;
    float before = 0.0f;
    for (std::size_t k = 0; k < power.size(); ++k) {
        AreaTriangle& light = lights.triangles[k];
        sum += power[k];
        light.until = k + 1 == power.size() ? 1.0f : std::min(static_cast<float>(sum / all), 1.0f);
        light.per_m2 = (light.until - before) / (0.5f * glm::length(glm::cross(light.u, light.v)));
        if (begins[k] != 0) lights.parts.emplace_back(before, 0.0f);
        light.part = static_cast<std::uint32_t>(lights.parts.size() - 1);
        lights.parts.back().y = before = light.until;
    }
}

}  // namespace

vec3 emission_at(const Scene& scene, std::uint32_t triangle, vec2 barycentric) {
    const Material& material = scene.materials[scene.triangle_materials[triangle]];
    if (material.alpha_mode == AlphaMode::mask &&
        material.alpha * looked_up(scene, material.base_color_texture, triangle, barycentric).w < material.alpha_cutoff)
        return vec3(0.0f);
    return material.emissive * vec3(looked_up(scene, material.emissive_texture, triangle, barycentric));
}

AreaLights find_area_lights(const Scene& scene) {
    AreaLights lights;
    std::vector<double> power;
    for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
        const Material& material = scene.materials[scene.triangle_materials[triangle]];
        if (material.emissive == vec3(0.0f)) continue;
        const uvec3 vertices = scene.triangles[triangle];
        AreaTriangle light;
        light.triangle = triangle;
        light.corner = scene.positions[vertices.x];
        light.u = scene.positions[vertices.y] - light.corner;
        light.v = scene.positions[vertices.z] - light.corner;
        const vec3 cross = glm::cross(light.u, light.v);
        const float twice_area = glm::length(cross);
        light.both_sides = material.double_sided;
        const double sent =
            double{mean_emission(scene, triangle)} * double{twice_area} * (material.double_sided ? 2.0 : 1.0);
        if (!(sent > 0.0) || !std::isfinite(sent)) continue;
        light.normal = cross / twice_area;
        lights.triangles.push_back(light);
        power.push_back(sent);
    }
    share_out(power, lights);
    return lights;
}

AreaPoint draw_point(const AreaLights& lights, vec2 numbers) {
    const auto found = std::ranges::upper_bound(lights.triangles, numbers.x, {}, &AreaTriangle::until);
    const AreaTriangle& light = *found;
    const float before = found == lights.triangles.begin() ? 0.0f : std::prev(found)->until;
    // What is left of the first number is as even as it was: a triangle's own samples are spread, too.
    const float within = std::min((numbers.x - before) / (light.until - before), largest_below_1);
    AreaPoint point;
    point.at = static_cast<std::uint32_t>(found - lights.triangles.begin());
    point.barycentric = point_in_triangle({within, numbers.y});
    point.position = light.corner + point.barycentric.x * light.u + point.barycentric.y * light.v;
    return point;
}

vec2 point_shift(const EnvironmentRequest& request, std::size_t pixel) {
    const SamplePattern& pattern = *request.pattern;
    const auto width = static_cast<std::size_t>(request.surfaces->size.width);
    const auto x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
    // Blue noise has as many values as its tile has places: in between by chance, so that none of many lights is
    // missed.
    const auto step = static_cast<float>(pattern.share.size());
    const auto stream = static_cast<std::uint32_t>(pixel);
    const vec2 chance(random_unit(pattern.seed ^ area_seed, stream, 0),
                      random_unit(pattern.seed ^ area_seed, stream, 1));
    const vec2 noise(pattern.share[pattern.tile_place(x + 31, y + 17)],
                     pattern.share[pattern.tile_place(x + 5, y + 53)]);
    return noise + chance / step;
}

AreaSegment segment_to(const AreaLights& lights, const AreaPoint& point, vec3 position, vec3 normal, float lift_m) {
    const AreaTriangle& light = lights.triangles[point.at];
    AreaSegment segment;
    const vec3 towards = point.position - position;
    segment.distance_m = glm::length(towards);
    if (segment.distance_m < 4.0f * lift_m) return segment;
    segment.direction = towards / segment.distance_m;
    const float from_front = -glm::dot(light.normal, segment.direction);
    segment.cosine_there = light.both_sides ? std::fabs(from_front) : from_front;
    segment.end = point.position + (from_front < 0.0f ? -lift_m : lift_m) * light.normal;
    segment.faces = segment.cosine_there > 0.0f && kernel::leaves_surface(normal, segment.direction);
    return segment;
}

void add_area_lights(const VisibilityField* field, const AreaSight* sight, const EmbreeScene& embree,
                     const Scene& scene, const AreaLights& lights, const EnvironmentRequest& request, int samples,
                     EnvironmentResult& result, Progress& progress) {
    if (lights.triangles.empty()) return;
    ImageRgb gained(request.surfaces->size);
    std::vector<vec2> even;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(samples); ++k)
        even.push_back(hammersley(k, static_cast<std::uint32_t>(samples)));
    const bool knows = sight != nullptr && sight->words > 0;
    const Picture picture{field, knows ? sight : nullptr, embree, scene, request, lights, even, result, gained};
    result.area_rays =
        go_over_tiles(request, result, progress, [&](int left, int top) { return light_tile(picture, left, top); });
}

}  // namespace sightlines::visibility_field
