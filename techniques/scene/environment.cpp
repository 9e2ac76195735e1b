#include "techniques/scene/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float greatest_radiance = 1.0e9f;  // the sun's disc from space is 2e7; sums of more would leave floats

/// A value put right: what is not a number or negative becomes 0.
float cleaned(float value) { return value > 0.0f ? std::min(value, greatest_radiance) : 0.0f; }

vec3 sky_colour(float height) {
    const vec3 zenith(0.20f, 0.40f, 0.95f), horizon(0.85f, 0.92f, 1.0f), ground(0.20f, 0.18f, 0.16f);
    if (height < 0.0f) return ground;
    return glm::mix(horizon, zenith, std::pow(height, 0.4f));
}

vec3 sun_direction(const SkyOptions& options) {
    const float elevation = glm::radians(options.sun_elevation_deg), azimuth = glm::radians(options.sun_azimuth_deg);
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), -std::cos(elevation) * std::cos(azimuth)};
}

void check_sky(const SkyOptions& options) {
    const auto refuse = [](const std::string& what, const std::string& range) {
        throw InputError("procedural sky", "", what + " is out of range", "choose " + range);
    };
    if (!(std::fabs(options.sun_elevation_deg) <= 90.0f)) refuse("the sun's elevation", "-90 to 90 degrees");
    if (!std::isfinite(options.sun_azimuth_deg)) refuse("the sun's azimuth", "a number of degrees");
    if (!(options.sun_radius_deg > 0.0f && options.sun_radius_deg <= 45.0f))
        refuse("the sun's radius", "more than 0, at most 45 degrees");
    if (!(options.sun_share >= 0.0f && options.sun_share < 1.0f)) refuse("the sun's share", "0 or more, below 1");
    if (options.size.width < 2 || options.size.height < 2) refuse("the picture's size", "at least 2 x 2");
}

/// Irradiance of level ground, by luminance.
double level_irradiance(const ImageRgb& radiance) {
    double sum = 0.0;
    for (int y = 0; y < radiance.size.height; ++y) {
        for (int x = 0; x < radiance.size.width; ++x) {
            const vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const double cosine = equirectangular_direction(radiance.size, middle).y;
            if (cosine > 0.0)
                sum += cosine * texel_solid_angle(radiance.size, y) *
                       glm::dot(radiance.at(x, y), vec3(0.2126f, 0.7152f, 0.0722f));
        }
    }
    return sum;
}

/// The part of each texel that the sun's disc covers, by 4 x 4 points.
ImageScalar sun_cover(const SkyOptions& options) {
    constexpr int points = 4;
    ImageScalar cover(options.size);
    const vec3 sun = sun_direction(options);
    const float least_cosine = std::cos(glm::radians(options.sun_radius_deg));
    for (int y = 0; y < options.size.height; ++y) {
        for (int x = 0; x < options.size.width; ++x) {
            int inside = 0;
            for (int k = 0; k < points * points; ++k) {
                const vec2 offset(static_cast<float>(k % points), static_cast<float>(k / points));
                const vec2 point = vec2(x, y) + (offset + 0.5f) / static_cast<float>(points);
                inside += glm::dot(equirectangular_direction(options.size, point), sun) >= least_cosine;
            }
            cover.at(x, y) = static_cast<float>(inside) / static_cast<float>(points * points);
        }
    }
    return cover;
}

}  // namespace

Environment make_environment(std::string name, ImageRgb radiance) {
    if (radiance.empty()) throw InputError(name, "", "the environment has no pixels");
    std::size_t changed = 0;
    for (vec3& pixel : radiance.pixels) {
        const vec3 right(cleaned(pixel.x), cleaned(pixel.y), cleaned(pixel.z));
        changed += right != pixel;
        pixel = right;
    }
    Environment environment{std::move(name), std::move(radiance), {}};
    if (changed > 0)
        environment.notes.push_back(environment.name + ": " + std::to_string(changed) +
                                    " pixels were negative, not finite or above 1e9, and were put right");
    return environment;
}

Environment procedural_sky(const SkyOptions& options) {
    check_sky(options);
    ImageRgb radiance(options.size);
    for (int y = 0; y < options.size.height; ++y)
        for (int x = 0; x < options.size.width; ++x)
            radiance.at(x, y) = sky_colour(equirectangular_direction(options.size, vec2(0.5f) + vec2(x, y)).y);
    const auto dimmed = static_cast<float>(pi * (1.0 - options.sun_share) / level_irradiance(radiance));
    for (vec3& pixel : radiance.pixels) pixel *= dimmed;
    ImageRgb disc(options.size);
    const ImageScalar cover = sun_cover(options);
    for (std::size_t p = 0; p < disc.pixels.size(); ++p) disc.pixels[p] = cover.pixels[p] * vec3(1.0f, 0.92f, 0.78f);
    const double from_disc = level_irradiance(disc);
    if (from_disc > 0.0) {
        const auto bright = static_cast<float>(pi * options.sun_share / from_disc);
        for (std::size_t p = 0; p < disc.pixels.size(); ++p) radiance.pixels[p] += bright * disc.pixels[p];
    }
    return make_environment("sky", std::move(radiance));
}

vec3 equirectangular_direction(ImageSize size, vec2 pixel) {
    const double polar = pi * pixel.y / size.height;
    const double azimuth = 2.0 * pi * pixel.x / size.width - pi;
    return vec3(dvec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)));
}

vec2 equirectangular_pixel(ImageSize size, vec3 direction) {
    const double azimuth = std::atan2(static_cast<double>(direction.x), -static_cast<double>(direction.z));
    const double polar = std::acos(std::clamp(static_cast<double>(direction.y), -1.0, 1.0));
    return {static_cast<float>((azimuth + pi) / (2.0 * pi) * size.width), static_cast<float>(polar / pi * size.height)};
}

vec3 radiance_from(const Environment& environment, vec3 direction) {
    const ImageSize size = environment.radiance.size;
    const vec2 place = equirectangular_pixel(size, direction) - 0.5f;
    const vec2 corner = glm::floor(place);
    const vec2 blend = place - corner;
    const auto texel = [&](int x, int y) {
        const int column = (static_cast<int>(corner.x) + x + size.width) % size.width;
        return environment.radiance.at(column, std::clamp(static_cast<int>(corner.y) + y, 0, size.height - 1));
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), blend.x), glm::mix(texel(0, 1), texel(1, 1), blend.x), blend.y);
}

double texel_solid_angle(ImageSize size, int row) {
    const double upper = std::cos(pi * row / size.height), lower = std::cos(pi * (row + 1) / size.height);
    return 2.0 * pi / size.width * (upper - lower);
}

}  // namespace sightlines
