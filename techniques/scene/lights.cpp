#include "techniques/scene/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "techniques/base/error.h"
#include "techniques/base/random.h"

namespace sightlines {
namespace {

constexpr std::uint32_t most_lights = 65536;
constexpr double pi = std::numbers::pi;

/// Irradiance that makes a surface of reflectance 0.5 leave middle grey, 0.18: pi * 0.18 / 0.5, W/m^2.
constexpr float middle_grey_irradiance = 1.13f;

/// Names the random numbers of one light; light k never depends on how many there are.
enum class Draw : std::uint32_t { x, y, z, hue, period, phase, tilt_u, tilt_v, size };

float draw(std::uint64_t seed, std::uint32_t light, Draw what) {
    return random_unit(seed, light, static_cast<std::uint32_t>(what));
}

constexpr float two_pi = 2.0f * static_cast<float>(pi);
constexpr vec3 luminance_weights(0.2126f, 0.7152f, 0.0722f);  ///< Rec. 709
constexpr float hue_middle = 0.62f, hue_swing = 0.38f;

/// A colour of the hue (a turn is 1), pale enough to be a lamp's, with the luminance of white.
vec3 hue_color(float hue) {
    const auto channel = [hue](float offset) { return hue_middle + hue_swing * std::cos(two_pi * (hue - offset)); };
    const vec3 color(channel(0.0f), channel(1.0f / 3.0f), channel(2.0f / 3.0f));
    return color / glm::dot(color, luminance_weights);
}

/// A hue from a uniform number, drawn so that many lights together are white: since hue_color divides by the luminance
/// of the undivided colour, which is 1 + e cos(2 pi (hue - brightest)) up to a factor, hues are drawn with that density
/// (its distribution function is inverted by iteration; e is about a third, so that a dozen steps reach rounding).
float white_balanced_hue(float unit) {
    const float x = luminance_weights.r - 0.5f * (luminance_weights.g + luminance_weights.b);
    const float y = 0.5f * std::sqrt(3.0f) * (luminance_weights.g - luminance_weights.b);
    const float e = hue_swing / hue_middle * std::hypot(x, y), brightest = std::atan2(y, x) / two_pi;
    float hue = unit;
    for (int i = 0; i < 12; ++i)
        hue = unit - e / two_pi * (std::sin(two_pi * (hue - brightest)) + std::sin(two_pi * brightest));
    return hue;
}

/// A typical distance between a lit surface and a light, m: half the geometric mean of the sides, a flat side counted
/// as a tenth of the longest so that flat scenes are not flooded or dark.
float typical_distance(const Box3& box) {
    const vec3 size = box.size();
    const float longest = std::max({size.x, size.y, size.z});
    const vec3 sides = glm::max(size, vec3(0.1f * longest));
    return longest > 0.0f ? 0.5f * std::cbrt(sides.x * sides.y * sides.z) : 1.0f;
}

/// Where the light is on its loop, from the loop's middle; the loop is a tilted ellipse inside a ball of radius 1.
vec3 loop_offset(std::uint64_t seed, std::uint32_t light, double time_s) {
    const double period_s = 4.0 + 6.0 * draw(seed, light, Draw::period);
    const double turns = time_s / period_s + draw(seed, light, Draw::phase);
    const double angle = 2.0 * pi * (turns - std::floor(turns));
    const vec3 axis = sphere_direction(draw(seed, light, Draw::tilt_u), draw(seed, light, Draw::tilt_v));
    const vec3 helper = std::abs(axis.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    const vec3 first = glm::normalize(glm::cross(axis, helper)), second = glm::cross(axis, first);
    return static_cast<float>(std::cos(angle)) * first + 0.6f * static_cast<float>(std::sin(angle)) * second;
}

/// Uniform in the box; a moving light's loop is kept inside by shrinking the box that its middle is drawn from.
vec3 position_in_volume(const Box3& volume, std::uint64_t seed, std::uint32_t light, bool moving, double time_s) {
    const vec3 unit(draw(seed, light, Draw::x), draw(seed, light, Draw::y), draw(seed, light, Draw::z));
    const vec3 size = volume.size();
    const vec3 radius = moving ? (0.04f + 0.06f * draw(seed, light, Draw::size)) * size : vec3(0.0f);
    const vec3 middle = volume.lowest + radius + unit * (size - 2.0f * radius);
    return moving ? middle + radius * loop_offset(seed, light, time_s) : middle;
}

/// Uniform over the sphere of the given radius; a moving light circles about its own place on it.
vec3 position_on_sphere(vec3 centre, float radius, std::uint64_t seed, std::uint32_t light, bool moving,
                        double time_s) {
    vec3 direction = sphere_direction(draw(seed, light, Draw::x), draw(seed, light, Draw::y));
    if (moving) direction = glm::normalize(direction + 0.25f * loop_offset(seed, light, time_s));
    return centre + radius * direction;
}

/// Stands in where a scene brings no lights: a point light, high in the middle of its light volume.
Light default_light(const Box3& volume, float brightness) {
    Light light;
    const vec3 size = volume.size();
    light.position = volume.lowest + vec3(0.5f, 0.85f, 0.5f) * size;
    const float distance = typical_distance(volume);
    light.intensity = vec3(brightness * middle_grey_irradiance * distance * distance * 2.0f);
    return light;
}

std::vector<Light> placed_lights(const Scene& scene, const LightChoice& choice, std::uint64_t seed) {
    const Box3 bounds = scene.bounds.empty() ? Box3{vec3(-1.0f), vec3(1.0f)} : scene.bounds;
    const Box3 volume = scene.light_volume.empty() ? bounds : scene.light_volume;
    if (choice.count == 0) {
        std::vector<Light> lights = scene.lights;
        for (Light& light : lights) light.intensity *= choice.brightness;
        if (lights.empty()) lights.push_back(default_light(volume, choice.brightness));
        return lights;
    }
    const bool sphere = choice.placement == LightPlacement::sphere;
    const float sphere_radius = std::max(0.6f * bounds.diagonal(), 1.0f);
    const float distance = sphere ? sphere_radius : typical_distance(volume);
    // Of many lights spread about a surface half are behind it, and cosines and shadows take more than half of the
    // rest: a fifth of the total arrives.
    const float total_intensity = 5.0f * choice.brightness * middle_grey_irradiance * distance * distance;
    const float intensity = total_intensity / static_cast<float>(choice.count);
    std::vector<Light> lights(choice.count);
    for (std::uint32_t k = 0; k < choice.count; ++k) {
        lights[k].position =
            sphere ? position_on_sphere(bounds.centre(), sphere_radius, seed, k, choice.moving, scene.time_s)
                   : position_in_volume(volume, seed, k, choice.moving, scene.time_s);
        lights[k].intensity =
            intensity * (choice.coloured ? hue_color(white_balanced_hue(draw(seed, k, Draw::hue))) : vec3(1.0f));
    }
    return lights;
}

}  // namespace

std::vector<Light> make_lights(const Scene& scene, const LightChoice& choice, std::uint64_t seed) {
    if (choice.count > most_lights)
        throw InputError("lights", "", std::to_string(choice.count) + " lights are too many",
                         "the most is " + std::to_string(most_lights));
    std::vector<Light> lights = placed_lights(scene, choice, seed);
    for (const MovedLight& moved : choice.moved)
        if (moved.light < lights.size() && lights[moved.light].kind != LightKind::directional)
            lights[moved.light].position = moved.position;
    return lights;
}

}  // namespace sightlines
