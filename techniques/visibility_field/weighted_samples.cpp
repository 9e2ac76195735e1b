#include "shaders/wide.h"  // first: makes the kernels below wide

#include "techniques/visibility_field/weighted_samples.h"

#include <algorithm>
#include <cmath>

#include "shaders/hemisphere.h"
#include "techniques/base/hammersley.h"
#include "techniques/visibility_field/wide_weighted.h"

namespace sightlines::visibility_field {
namespace {

namespace wide = wide_kernel;

vec3 towards_eye(const SurfaceBuffer& surfaces, std::size_t pixel) {
    const Camera& camera = surfaces.camera;
    const vec3 towards = camera.kind == CameraKind::orthographic ? -camera_frame(camera, surfaces.size).forward
                                                                 : camera.position - surfaces.position[pixel];
    const float length = glm::length(towards);
    return length > 0.0f ? towards / length : surfaces.normal[pixel];
}

Gloss gloss_of(const EnvironmentRequest& request, std::size_t pixel) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const vec2 own = surfaces.gloss.empty() ? vec2(1.0f, 0.0f) : surfaces.gloss[pixel];
    return make_gloss(surfaces.albedo[pixel], request.roughness > 0.0f ? request.roughness : own.x, own.y);
}

void count_ways(const EnvironmentRequest& request, const Gloss& gloss, WeightedPixel& pixel) {
    const auto samples = static_cast<std::uint32_t>(request.pattern->samples);
    if (request.sampling == Sampling::map) pixel.map = samples;
    if (request.sampling == Sampling::both) pixel.map = samples / 2;
    const std::uint32_t left = samples - pixel.map;
    if (request.glossy && request.sampling != Sampling::cosine)
        pixel.mirrored = static_cast<std::uint32_t>(
            std::lround(mirrored_share(gloss, pixel.surface.gloss.to_eye) * static_cast<float>(left)));
    pixel.cosine = left - pixel.mirrored;
    pixel.surface.cosine = static_cast<float>(pixel.cosine);
    pixel.surface.mirrored = static_cast<float>(pixel.mirrored);
    pixel.surface.map = static_cast<float>(pixel.map);
    pixel.surface.all = static_cast<float>(samples);
    pixel.surface.is_glossy = request.glossy ? 1 : 0;
    pixel.surface.weighs_alike = !request.glossy && pixel.map == 0 ? 1 : 0;
}

/// The directions of a pixel's samples.
void draw_samples(const WeightedTables& tables, const WeightedPixel& pixel, std::span<vec3> to) {
    draw_by_vectors(tables, WideTables(tables), pixel,
                    [&](std::uint32_t first, const wide::DrawnSample& drawn, wide::Mask inside) HWY_ATTR {
                        float axes[3][wide::lanes];
                        wide::store(drawn.direction.x, axes[0]);
                        wide::store(drawn.direction.y, axes[1]);
                        wide::store(drawn.direction.z, axes[2]);
                        const std::uint32_t used = wide::bits_of(inside), above = wide::bits_of(drawn.above);
                        for (std::uint32_t lane = 0; used >> lane != 0 && lane < wide::lanes; ++lane)
                            to[first + lane] = (above >> lane & 1u) != 0
                                                   ? vec3(axes[0][lane], axes[1][lane], axes[2][lane])
                                                   : -pixel.surface.normal;
                    });
}

/// Whether a sample that `draw_samples` drew leaves its surface: others point straight into it.
bool leaves(const SampledSurface& surface, vec3 direction) { return direction != -surface.normal; }

/// What each sample adds, those below their surface nothing.
void weigh_each(const WideTables& tables, const SampledSurface& surface, std::vector<PixelSample>& samples) {
    for (std::size_t first = 0; first < samples.size(); first += wide::lanes) {
        const std::size_t used = std::min(wide::lanes, samples.size() - first);
        float axes[3][wide::lanes] = {};
        for (std::size_t lane = 0; lane < used; ++lane)
            for (int axis = 0; axis < 3; ++axis) axes[axis][lane] = samples[first + lane].direction[axis];
        const wide::Vec3 brings = wide::weighed(surface, tables.light, tables.draws,
                                                {wide::load(axes[0]), wide::load(axes[1]), wide::load(axes[2])});
        wide::store(brings.x, axes[0]);
        wide::store(brings.y, axes[1]);
        wide::store(brings.z, axes[2]);
        for (std::size_t lane = 0; lane < used; ++lane)
            if (leaves(surface, samples[first + lane].direction))
                samples[first + lane].adds = {axes[0][lane], axes[1][lane], axes[2][lane]};
    }
}

}  // namespace

WeightedPixel weighted_pixel(const EnvironmentRequest& request, std::size_t index) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const SamplePattern& pattern = *request.pattern;
    const auto width = static_cast<std::size_t>(surfaces.size.width);
    const auto x = static_cast<int>(index % width), y = static_cast<int>(index / width);
    const std::size_t tile = pattern.tile_place(x, y);
    const wide::HemisphereFrame frame =
        wide::frame_about(surfaces.shading_normal[index], pattern.turns[tile].x, pattern.turns[tile].y);
    WeightedPixel pixel;
    SampledSurface& surface = pixel.surface;
    surface.tangent = frame.tangent;
    surface.bitangent = frame.bitangent;
    surface.up = frame.normal;
    surface.normal = surfaces.normal[index];
    // The same noise from elsewhere: unlike what is here, but as even.
    surface.shift_u = pattern.share[pattern.tile_place(x + 23, y + 41)];
    surface.shift_v = pattern.share[pattern.tile_place(x + 47, y + 11)];
    Gloss gloss;
    if (request.glossy) {
        const vec3 to_eye = towards_eye(surfaces, index) * mat3(frame.tangent, frame.bitangent, frame.normal);
        gloss = gloss_of(request, index);
        surface.gloss = glossy_surface(gloss, glm::normalize(vec3(to_eye.x, to_eye.y, std::max(to_eye.z, 1.0e-3f))));
    }
    count_ways(request, gloss, pixel);
    return pixel;
}

vec3 reflecting_colour(const EnvironmentRequest& request, std::size_t pixel) {
    const Gloss gloss = gloss_of(request, pixel);
    return gloss.diffuse + gloss.head_on + 0.01f;
}

WeightedTables weighted_tables(const EnvironmentRequest& request) {
    WeightedTables tables;
    const auto samples = static_cast<std::uint32_t>(request.pattern->samples);
    for (std::uint32_t k = 0; k < samples + wide::lanes; ++k) {
        tables.ordinal.push_back(static_cast<float>(k) + 0.5f);
        tables.inverse.push_back(radical_inverse(k));
    }
    tables.harmonics = harmonic_light(request.light);
    tables.draws = request.distribution;
    if (request.map == nullptr) return tables;
    const ImageRgb& map = request.map->map->radiance;
    tables.map = map_shape(map.size, request.map->turn_deg);
    tables.texels = &map.pixels.front().x;
    return tables;
}

std::vector<PixelSample> weighted_samples(const EnvironmentRequest& request, const WeightedTables& tables,
                                          std::size_t index) {
    const WeightedPixel pixel = weighted_pixel(request, index);
    std::vector<vec3> directions(static_cast<std::size_t>(request.pattern->samples));
    draw_samples(tables, pixel, directions);
    std::vector<PixelSample> samples;
    for (const vec3 direction : directions) samples.push_back({direction, vec3(0.0f)});
    weigh_each(WideTables(tables), pixel.surface, samples);
    return samples;
}

std::vector<PixelSample> weighted_samples(const EnvironmentRequest& request, std::size_t index) {
    return weighted_samples(request, weighted_tables(request), index);
}

}  // namespace sightlines::visibility_field
