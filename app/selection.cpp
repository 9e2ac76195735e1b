#include "app/selection.h"

#include <algorithm>
#include <optional>
#include <span>

#include "shaders/lighting.h"
#include "techniques/base/error.h"
#include "techniques/rays/light_records.h"

namespace sightlines {
namespace {

/// How many of a pixel's rays are recorded in the search for one that is judged wrongly.
constexpr std::size_t most_rays_searched = 512;

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

ivec2 middle_pixel(const SurfaceBuffer& surfaces, const std::vector<Light>& lights) {
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
            if (!asks_any(surfaces, pixel, lights)) continue;
            best = ivec2(x, y);
            best_distance = distance;
        }
    }
    if (!best)
        throw InputError("scene", "", "no pixel of the picture has a light in front of its surface",
                         "choose another camera, or --lights 16");
    return *best;
}

std::uint32_t checked_light(std::uint32_t light, ivec2 pixel, std::span<const std::uint32_t> asked,
                            std::size_t light_count) {
    if (light >= light_count)
        throw InputError("--light", "", std::to_string(light) + " does not exist",
                         light_count == 0 ? "there are no lights" : "0 to " + std::to_string(light_count - 1));
    if (std::ranges::find(asked, light) != asked.end()) return light;
    const auto after = std::ranges::lower_bound(asked, light);
    const std::string near =
        asked.empty() ? "no light is in front of it"
                      : "light " + std::to_string(after == asked.end() ? asked.back() : *after) + " is in front of it";
    throw InputError(
        "--light", "",
        std::to_string(light) + " stands behind the surface at pixel " + pixel_text(pixel) + ", so no ray is asked",
        near);
}

}  // namespace

std::vector<std::uint32_t> asked_lights(const SurfaceBuffer& surfaces, std::size_t pixel,
                                        const std::vector<Light>& lights) {
    std::vector<std::uint32_t> asked;
    for (std::uint32_t light = 0; light < lights.size(); ++light)
        if (is_asked(lights[light], surfaces.position[pixel], surfaces.normal[pixel])) asked.push_back(light);
    return asked;
}

SelectedRay select_ray(const Session& session, Results& results, Progress& progress) {
    const auto lights = results.lights(session, progress);
    const auto surfaces = results.surfaces(session, progress);
    SelectedRay ray;
    ray.pixel = session.selection.pixel ? checked_pixel(surfaces->value, *session.selection.pixel)
                                        : middle_pixel(surfaces->value, lights->value);
    const std::size_t pixel = static_cast<std::size_t>(ray.pixel.y) * static_cast<std::size_t>(session.size.width) +
                              static_cast<std::size_t>(ray.pixel.x);
    const std::vector<std::uint32_t> asked = asked_lights(surfaces->value, pixel, lights->value);
    if (session.selection.light) checked_light(*session.selection.light, ray.pixel, asked, lights->value.size());
    if (asked.empty())
        throw InputError("--pixel", "", pixel_text(ray.pixel) + " has no light in front of its surface",
                         "choose another pixel");
    const auto structure = results.structure(session, progress);
    const auto embree = results.embree(session, progress);
    const auto record = [&](std::uint32_t light) {
        SelectedRay recorded{ray.pixel, light, {}, {}, false};
        recorded.request = {surfaces->value.position[pixel], surfaces->value.normal[pixel], lights->value[light],
                            technique_parameters(session)};
        recorded.trace = structure->value.technique->trace(structure->value.structure, recorded.request);
        recorded.truly_blocked = occluded(*embree->value, recorded.trace.ray, recorded.request.normal);
        return recorded;
    };
    if (session.selection.light) return record(*session.selection.light);
    std::optional<SelectedRay> first_blocked;
    for (std::size_t i = 0; i < std::min(asked.size(), most_rays_searched); ++i) {
        progress.check();
        SelectedRay recorded = record(asked[i]);
        if (recorded.trace.blocked != recorded.truly_blocked) return recorded;
        if (recorded.trace.blocked && !first_blocked) first_blocked = std::move(recorded);
    }
    return first_blocked ? *first_blocked : record(asked.front());
}

}  // namespace sightlines
