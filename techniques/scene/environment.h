// What surrounds a scene: light from far away, by direction.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "techniques/base/image.h"

namespace sightlines {

/// An equirectangular picture of the surroundings: the top row is +Y, the middle column -Z, columns go round to the
/// right (towards +X). Every value is finite and at least 0.
struct Environment {
    std::string name;
    ImageRgb radiance;               ///< linear Rec. 709, W/(sr m^2); never empty
    std::vector<std::string> notes;  ///< for standard error: what was put right
};

/// The sun and the sky of a clear day, made up: a deep blue zenith, a bright horizon, and a disc.
struct SkyOptions {
    float sun_elevation_deg = 45.0f;  ///< above the horizon, in [-90, 90]
    float sun_azimuth_deg = 30.0f;    ///< from -Z towards +X
    float sun_radius_deg = 1.5f;      ///< of the disc; the real one's 0.27 would fall between texels
    float sun_share = 0.5f;           ///< of the light on level ground, from the disc, where it is up; in [0, 1)
    ImageSize size{512, 256};
};

/// Values that are negative, not finite or greater than 1e9 are put right, with a note. InputError where the picture is
/// empty.
Environment make_environment(std::string name, ImageRgb radiance);

/// A Radiance picture (.hdr, RGBE, run lengths or not, "-Y h +X w"). InputError, with the place in the file, for:
/// missing, another format, colour spaces other than RGB, cut short, more than 16,384 x 8,192 pixels.
Environment read_environment(const std::filesystem::path& file);

/// Level ground gets an irradiance of about pi. InputError for angles or shares outside their ranges.
Environment procedural_sky(const SkyOptions& options);

/// The radiance from a unit direction, bilinear.
vec3 radiance_from(const Environment& environment, vec3 direction);

/// The unit direction of the point (x, y) of a picture of this size, in pixels, (0, 0) the top left corner.
vec3 equirectangular_direction(ImageSize size, vec2 pixel);

/// The point of the picture, in pixels, that a unit direction falls on.
vec2 equirectangular_pixel(ImageSize size, vec3 direction);

/// The solid angle of a texel in a row, sr.
double texel_solid_angle(ImageSize size, int row);

}  // namespace sightlines
