#include "techniques/visibility_field/weighted_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shaders/hemisphere.h"
#include "techniques/base/hammersley.h"
#include "techniques/visibility_field/map_sampling.h"

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

using Pixel = DrawnPixel;
using Ways = DrawnPixel::Ways;

vec3 towards_eye(const SurfaceBuffer& surfaces, std::size_t pixel) {
    const Camera& camera = surfaces.camera;
    const vec3 towards = camera.kind == CameraKind::orthographic ? -camera_frame(camera, surfaces.size).forward
                                                                 : camera.position - surfaces.position[pixel];
    const float length = glm::length(towards);
    return length > 0.0f ? towards / length : surfaces.normal[pixel];
}

Pixel make_pixel(const EnvironmentRequest& request, std::size_t index) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const SamplePattern& pattern = *request.pattern;
    const auto width = static_cast<std::size_t>(surfaces.size.width);
    const auto x = static_cast<int>(index % width), y = static_cast<int>(index / width);
    const std::size_t tile = pattern.tile_place(x, y);
    Pixel pixel;
    pixel.normal = surfaces.normal[index];
    const scalar_kernel::HemisphereFrame frame =
        scalar_kernel::frame_about(surfaces.shading_normal[index], pattern.turns[tile].x, pattern.turns[tile].y);
    pixel.world_from_surface = mat3(frame.tangent, frame.bitangent, frame.normal);
    // The same noise from elsewhere: unlike what is here, but as even.
    pixel.shift = {pattern.share[pattern.tile_place(x + 23, y + 41)],
                   pattern.share[pattern.tile_place(x + 47, y + 11)]};
    if (!request.glossy) return pixel;
    pixel.to_eye = towards_eye(surfaces, index) * pixel.world_from_surface;
    pixel.to_eye = glm::normalize(vec3(pixel.to_eye.x, pixel.to_eye.y, std::max(pixel.to_eye.z, 1.0e-3f)));
    const vec2 own = surfaces.gloss.empty() ? vec2(1.0f, 0.0f) : surfaces.gloss[index];
    pixel.gloss = make_gloss(surfaces.albedo[index], request.roughness > 0.0f ? request.roughness : own.x, own.y);
    return pixel;
}

Ways ways_of(const EnvironmentRequest& request, const Pixel& pixel) {
    const auto samples = static_cast<std::uint32_t>(request.pattern->samples);
    Ways ways;
    if (request.sampling == Sampling::map) ways.map = samples;
    if (request.sampling == Sampling::both) ways.map = samples / 2;
    const std::uint32_t left = samples - ways.map;
    if (request.glossy && request.sampling != Sampling::cosine)
        ways.mirrored = static_cast<std::uint32_t>(
            std::lround(mirrored_share(pixel.gloss, pixel.to_eye) * static_cast<float>(left)));
    ways.cosine = left - ways.mirrored;
    return ways;
}

vec3 light_from(const EnvironmentRequest& request, vec3 direction) {
    return request.map != nullptr ? radiance_from(*request.map, direction) : radiance(request.light, direction);
}

vec2 shifted(vec2 numbers, vec2 shift) {
    // Below 1, whatever rounding says.
    return glm::min(glm::fract(numbers + shift), vec2(0.99999994f));
}

/// A direction that counts, or one into the surface.
vec3 checked(const Pixel& pixel, vec3 direction) {
    const bool leaves =
        glm::dot(pixel.world_from_surface[2], direction) > 0.0f && glm::dot(pixel.normal, direction) > 0.0f;
    return leaves ? direction : -pixel.normal;
}

/// What a sample of this direction, which leaves the surface, adds where nothing is in the way.
vec3 weighed(const EnvironmentRequest& request, const Pixel& pixel, vec3 direction) {
    const Ways& ways = pixel.ways;
    const vec3 local = direction * pixel.world_from_surface;  // turned by the inverse
    const vec3 light = light_from(request, direction);
    const auto samples = static_cast<float>(request.pattern->samples);
    if (!request.glossy && ways.map == 0) return pi / samples * light;
    float density = static_cast<float>(ways.cosine) * local.z / pi;
    if (ways.mirrored > 0)
        density += static_cast<float>(ways.mirrored) * mirrored_density(pixel.gloss.width, pixel.to_eye, local);
    if (ways.map > 0) density += static_cast<float>(ways.map) * drawn_density(*request.distribution, direction);
    if (!(density > 0.0f)) return vec3(0.0f);
    const vec3 reflected = request.glossy ? pi * reflected_share(pixel.gloss, pixel.to_eye, local) : vec3(1.0f);
    return reflected * light * (local.z / density);
}

}  // namespace

DrawnPixel draw_samples(const EnvironmentRequest& request, std::size_t index) {
    DrawnPixel pixel = make_pixel(request, index);
    pixel.ways = ways_of(request, pixel);
    const Ways& ways = pixel.ways;
    pixel.directions.reserve(static_cast<std::size_t>(request.pattern->samples));
    const auto add = [&](vec3 direction) { pixel.directions.push_back(checked(pixel, direction)); };
    for (std::uint32_t k = 0; k < ways.cosine; ++k)
        add(pixel.world_from_surface * cosine_direction(hammersley(k, ways.cosine)));
    for (std::uint32_t k = 0; k < ways.mirrored; ++k) {
        const vec2 numbers = shifted(hammersley(k, ways.mirrored), pixel.shift);
        add(pixel.world_from_surface * mirrored_sample(pixel.gloss.width, pixel.to_eye, numbers));
    }
    for (std::uint32_t k = 0; k < ways.map; ++k)
        add(drawn_direction(*request.distribution, shifted(hammersley(k, ways.map), pixel.shift)));
    return pixel;
}

std::vector<PixelSample> weighted_samples(const EnvironmentRequest& request, std::size_t index) {
    const DrawnPixel pixel = draw_samples(request, index);
    std::vector<PixelSample> samples;
    for (const vec3 direction : pixel.directions) {
        const bool counts = scalar_kernel::leaves_surface(pixel.normal, direction);
        samples.push_back({direction, counts ? weighed(request, pixel, direction) : vec3(0.0f)});
    }
    return samples;
}

void resolve_weighted(const EnvironmentRequest& request, std::size_t pixel, const DrawnPixel& drawn,
                      std::span<const std::uint32_t> blocked, EnvironmentResult& result) {
    vec3 irradiance(0.0f);
    std::uint32_t asked = 0, in_the_way = 0;
    for (std::size_t k = 0; k < drawn.directions.size(); ++k) {
        if (!scalar_kernel::leaves_surface(drawn.normal, drawn.directions[k])) continue;
        ++asked;
        const bool is_blocked = (blocked[k / 32] >> (k % 32) & 1u) != 0;
        in_the_way += is_blocked;
        if (!is_blocked) irradiance += weighed(request, drawn, drawn.directions[k]);
        if (is_blocked && request.keep_verdicts)
            result.verdicts.words[pixel * result.verdicts.words_per_pixel + k / 32] |= 1u << (k % 32);
    }
    result.irradiance.pixels[pixel] = irradiance;
    result.radiance.pixels[pixel] = reflected_radiance(request, pixel, irradiance);
    result.rays_asked.pixels[pixel] = asked;
    result.shadow.pixels[pixel] =
        static_cast<float>(in_the_way) / static_cast<float>(std::max<std::uint32_t>(asked, 1));
}

}  // namespace sightlines::visibility_field
