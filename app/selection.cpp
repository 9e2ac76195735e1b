#include "app/selection.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "shaders/lighting.h"
#include "techniques/base/error.h"
#include "techniques/rays/light_records.h"
#include "techniques/rays/open_rays.h"

namespace sightlines {
namespace {

bool is_asked(const Light& light, vec3 position, vec3 normal) {
    const vec3 to_light = scalar_kernel::to_light(light_record(light), position, 1.0f);
    return scalar_kernel::is_asked(normal, to_light);
}

bool asks_any(const SurfaceBuffer& surfaces, std::size_t pixel, const std::vector<Light>& lights) {
    return surfaces.triangle[pixel] != no_triangle && std::ranges::any_of(lights, [&](const Light& light) {
               return is_asked(light, surfaces.position[pixel], surfaces.normal[pixel]);
           });
}

std::string pixel_text(ivec2 pixel) { return std::to_string(pixel.x) + "," + std::to_string(pixel.y); }

ivec2 checked_pixel(const SurfaceBuffer& surfaces, ivec2 pixel) {
    const ImageSize size = surfaces.size;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.width || pixel.y >= size.height)
        throw InputError("--pixel", "", pixel_text(pixel) + " lies outside the picture",
                         "from 0,0 to " + pixel_text({size.width - 1, size.height - 1}));
    const std::size_t index =
        static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(pixel.x);
    if (surfaces.triangle[index] == no_triangle)
        throw InputError("--pixel", "", pixel_text(pixel) + " shows the background, which asks no rays",
                         "choose a pixel on a surface");
    return pixel;
}

/// `any_surface`: every pixel that shows a surface asks.
ivec2 middle_pixel(const SurfaceBuffer& surfaces, const std::vector<Light>& lights, bool any_surface) {
    const ImageSize size = surfaces.size;
    std::optional<ivec2> best;
    int best_distance = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const ivec2 off(x - size.width / 2, y - size.height / 2);
            const int distance = off.x * off.x + off.y * off.y;
            if (best && distance >= best_distance) continue;
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
            const bool asks = any_surface ? surfaces.triangle[pixel] != no_triangle : asks_any(surfaces, pixel, lights);
            if (!asks) continue;
            best = ivec2(x, y);
            best_distance = distance;
        }
    }
    if (!best)
        throw InputError("scene", "",
                         any_surface ? "no pixel of the picture shows a surface"
                                     : "no pixel of the picture has a light in front of its surface",
                         any_surface ? "choose another camera" : "choose another camera, or --lights 16");
    return *best;
}

/// `thing`: "light" or "sample".
void check_light(std::uint32_t light, ivec2 pixel, std::span<const std::uint32_t> asked, std::size_t light_count,
                 const std::string& thing) {
    if (light >= light_count)
        throw InputError("--light", "", std::to_string(light) + " does not exist",
                         light_count == 0 ? "there are no " + thing + "s" : "0 to " + std::to_string(light_count - 1));
    if (std::ranges::find(asked, light) != asked.end()) return;
    const auto after = std::ranges::lower_bound(asked, light);
    const std::string near =
        asked.empty()
            ? "no " + thing + " is in front of it"
            : thing + " " + std::to_string(after == asked.end() ? asked.back() : *after) + " is in front of it";
    throw InputError(
        "--light", "",
        std::to_string(light) + " stands behind the surface at pixel " + pixel_text(pixel) + ", so no ray is asked",
        near);
}

/// All that a pixel's rays are recorded and judged with.
struct PixelRecorder {
    Shared<SurfaceBuffer> surfaces;
    std::vector<Light> lights{};  ///< or the pixel's samples of the environment
    bool samples = false;         ///< which of the two
    Shared<BuiltStructure> structure;
    Shared<std::shared_ptr<const EmbreeScene>> embree;
    ParameterValues parameters;
    Shared<EnvironmentLight> environment;  ///< null where it is lit by lights
    std::uint64_t seed = 1;
    ivec2 pixel{0};
    std::size_t index = 0;               ///< of the pixel
    std::vector<std::uint32_t> asked{};  ///< by the pixel, in order

    std::string thing() const { return samples ? "sample" : "light"; }

    /// By the ray that the reference asks.
    bool is_truly_blocked(const SelectedRay& ray) const {
        const TraceRequest& from = ray.request;
        if (!samples) return occluded(*embree->value, ray.trace.ray, from.normal);
        return is_blocked(*embree->value, lifted_off(*embree->value, from.position, from.normal),
                          -from.light.direction);
    }

    SelectedRay record(std::uint32_t light) const {
        SelectedRay recorded{pixel, light, {}, {}, false};
        recorded.request = {surfaces->value.position[index],
                            surfaces->value.normal[index],
                            lights[light],
                            parameters,
                            &structure->value.scene->value,
                            environment ? &environment->value : nullptr,
                            seed};
        recorded.trace = structure->value.technique->trace(structure->value.structure, recorded.request);
        recorded.truly_blocked = is_truly_blocked(recorded);
        return recorded;
    }
};

PixelRecorder pixel_recorder(const Session& session, std::optional<ivec2> known_pixel, Results& results,
                             Progress& progress) {
    PixelRecorder recorder;
    const auto lights = results.lights(session, progress);
    recorder.samples = lit_by_environment(session);
    recorder.surfaces = results.surfaces(session, progress);
    const SurfaceBuffer& surfaces = recorder.surfaces->value;
    recorder.pixel = session.selection.pixel ? checked_pixel(surfaces, *session.selection.pixel)
                     : known_pixel           ? checked_pixel(surfaces, *known_pixel)
                                             : middle_pixel(surfaces, lights->value, recorder.samples);
    recorder.index = static_cast<std::size_t>(recorder.pixel.y) * static_cast<std::size_t>(session.size.width) +
                     static_cast<std::size_t>(recorder.pixel.x);
    recorder.lights = pixel_lights(session, recorder.index, results, progress);
    recorder.asked = asked_lights(surfaces, recorder.index, recorder.lights);
    if (recorder.asked.empty())
        throw InputError("--pixel", "",
                         pixel_text(recorder.pixel) + " has no " + recorder.thing() + " in front of its surface",
                         "choose another pixel");
    recorder.structure = results.structure(session, progress);
    recorder.embree = results.embree(session, progress);
    recorder.parameters = technique_parameters(session);
    if (recorder.samples) recorder.environment = results.environment(session, progress);
    recorder.seed = session.seed;
    return recorder;
}

/// From the surface to the light, or to where the way to it leaves the box.
float distance_to(const Light& light, vec3 position, const Box3& bounds) {
    if (light.kind != LightKind::directional) return glm::length(light.position - position);
    float distance_m = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const float way = -light.direction[axis];
        if (way == 0.0f) continue;
        const float wall = way > 0.0f ? bounds.highest[axis] : bounds.lowest[axis];
        distance_m = std::min(distance_m, std::max(0.0f, (wall - position[axis]) / way));
    }
    return distance_m;
}

}  // namespace

std::vector<std::uint32_t> asked_lights(const SurfaceBuffer& surfaces, std::size_t pixel,
                                        const std::vector<Light>& lights) {
    std::vector<std::uint32_t> asked;
    for (std::uint32_t light = 0; light < lights.size(); ++light)
        if (is_asked(lights[light], surfaces.position[pixel], surfaces.normal[pixel])) asked.push_back(light);
    return asked;
}

std::vector<Light> pixel_lights(const Session& session, std::size_t pixel, Results& results, Progress& progress) {
    const auto lights = results.lights(session, progress);
    const EnvironmentLit* const lit = find_technique(session.technique).environment;
    if (lit == nullptr) return lights->value;
    const auto surfaces = results.surfaces(session, progress);
    return lit->lights(results.request(session, surfaces->value, lights->value, progress).request, pixel);
}

PixelRays pixel_rays(const Session& session, Results& results, Progress& progress) {
    const PixelRecorder recorder = pixel_recorder(session, std::nullopt, results, progress);
    const Box3 bounds = results.scene(session, progress)->value.bounds;
    PixelRays rays{recorder.pixel, {}};
    progress.begin("following the rays of the pixel", static_cast<std::int64_t>(recorder.asked.size()));
    for (const std::uint32_t light : recorder.asked) {
        const SelectedRay ray = recorder.record(light);
        rays.rows.push_back({light, ray.trace.blocked, ray.truly_blocked,
                             distance_to(ray.request.light, ray.request.position, bounds)});
        progress.advance();
    }
    return rays;
}

SelectedRay select_ray(const Session& session, const PixelRays& rays, Results& results, Progress& progress) {
    const PixelRecorder recorder = pixel_recorder(session, rays.pixel, results, progress);
    if (session.selection.light) {
        check_light(*session.selection.light, recorder.pixel, recorder.asked, recorder.lights.size(), recorder.thing());
        return recorder.record(*session.selection.light);
    }
    auto row = std::ranges::find_if(rays.rows, &RayRow::wrong);
    if (row == rays.rows.end()) row = std::ranges::find_if(rays.rows, &RayRow::blocked);
    if (row == rays.rows.end()) row = rays.rows.begin();
    return recorder.record(row->light);
}

SelectedRay select_ray(const Session& session, Results& results, Progress& progress) {
    if (!session.selection.light) return select_ray(session, pixel_rays(session, results, progress), results, progress);
    const PixelRecorder recorder = pixel_recorder(session, std::nullopt, results, progress);
    check_light(*session.selection.light, recorder.pixel, recorder.asked, recorder.lights.size(), recorder.thing());
    return recorder.record(*session.selection.light);
}

}  // namespace sightlines
