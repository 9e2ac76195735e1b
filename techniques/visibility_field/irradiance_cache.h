// Irradiance caching in screen space (Xu 2022, section 6): few pixels are asked, those between them interpolated.
#pragma once

#include <functional>

#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

/// Makes a picture of the request's samples.
using Renderer = std::function<EnvironmentResult(const EnvironmentRequest&)>;

struct CacheOptions {
    int spacing = 0;         ///< pixels, the coarsest distance between asked ones; a power of two, or the one below
    float tolerance = 0.0f;  ///< how much the brightness (brightness_of) of asked pixels may differ
};

/// What the tolerance compares: the square root of irradiance over the mean one of all unshadowed surfaces, however
/// they face; about what a screen shows. The noise of few samples grows with the square root of irradiance, too, so
/// that one tolerance treats dark and bright surfaces alike.
vec3 brightness_of(vec3 irradiance, float mean_unshadowed);

/// The picture that `make` makes of the request, in passes: the pixels at multiples of the spacing (and of the last row
/// and column) are asked, then those at half of it, and so on. Where all that is seen between four asked ones is of one
/// surface, by planes and normals, and their irradiance differs by less than the tolerance, the pixels between them get
/// its mean, weighed by place, plane and normal. Two pixels apart it suffices that two of the four are of a pixel's
/// surface. An asked pixel has the value that it has without the cache; with a tolerance of 0 all are asked, as are
/// glossy surfaces, whose light depends on the view.
///
/// Interpolated pixels trace nothing; their shadow and number of samples are interpolated. Counts and seconds are those
/// of the passes. Where verdicts are kept, every pixel is asked once more for these (and its number of samples).
/// `on_region` is called after each pass, with the nearest asked pixel's light where none is known yet.
EnvironmentResult render_cached(const CacheOptions& options, const EnvironmentRequest& request, const Renderer& make);

}  // namespace sightlines::visibility_field
