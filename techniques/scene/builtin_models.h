// The built-in scenes, one file each (builtin_cornell.cpp, builtin_atrium.cpp ...).
#pragma once

#include "techniques/scene/scene.h"

namespace sightlines {

/// The Cornell box, from the published measurements, at a hundredth of their numbers in metres: about 5.5 m wide.
SceneModel cornell_model();

/// A court between two storeys of arcades, with cloths and plants: about 260,000 triangles, and a sun that moves.
SceneModel atrium_model();

/// Broad-leaved trees on rolling ground, after the scene *Trees* of Wang 2017: about 626,000 triangles, a moving sun.
SceneModel trees_model();

/// A formal garden after the scene *Garden* of Wang 2017: about 416,000 triangles, a moving sun.
SceneModel garden_model();

/// A city with two flying instances of one plane, after *Planes* of Wang 2017: about 982,000 triangles, rigid motion.
SceneModel planes_model();

/// An amusement park after the scene *Park* of Wang 2017: about 499,000 triangles, 7,088 lights of its own; rides turn.
SceneModel park_model();

/// A living room with a television as light, after Figure 8 of Wang 2017: 1,024 lights of its own; the picture moves.
SceneModel tv_model();

/// A street of old houses over shops, with a café's terrace, an exterior as rich as *Bistro* of Xu 2022: about 2,800,000
/// triangles, a moving sun.
SceneModel street_model();

/// A church's nave after the scene *Cathedral* of Wang 2017: about 456,000 triangles; candles flicker.
SceneModel cathedral_model();

/// A running bear, which deforms, after the scene *Bear* of Wang 2017: the light version, and the one with as many
/// triangles as the paper's, about 1,486,000.
SceneModel bear_model();
SceneModel bear_full_model();

/// Lights that stand for a clear sky: `count` directional lights spread evenly over the upper hemisphere, which give
/// `irradiance` (W/m^2) together to ground that lies open.
std::vector<Light> sky_lights(int count, vec3 irradiance);

/// A sun that goes once round the sky's arc between two azimuths and back in `duration_s`, its rays' irradiance
/// `irradiance` (W/m^2) across them. Azimuth 0 is +x, 90 is +z.
struct SunArc {
    float first_azimuth_deg = 0.0f, last_azimuth_deg = 90.0f;
    float lowest_elevation_deg = 30.0f, highest_elevation_deg = 60.0f;
    double duration_s = 24.0;
    vec3 irradiance{3.0f};
};
Light sun_light(const SunArc& arc, double time_s);

}  // namespace sightlines
