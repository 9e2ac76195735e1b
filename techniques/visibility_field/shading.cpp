// What is not hot of a picture: the light's form, and how far two pictures are apart.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

HarmonicLight harmonic_light(const Harmonics& harmonics) {
    // In the kernels' order: 1, x, y, z, xy, yz, zx, 3zz - 1, xx - yy. The functions at these directions tell the
    // factors.
    const auto along = [](double x, double y, double z) { return harmonic_functions({x, y, z}); };
    const auto& c = harmonics.coefficient;
    HarmonicLight light;
    light.term[0] = c[0] * static_cast<float>(along(0, 0, 1)[0]);
    light.term[1] = c[3] * static_cast<float>(along(1, 0, 0)[3]);
    light.term[2] = c[1] * static_cast<float>(along(0, 1, 0)[1]);
    light.term[3] = c[2] * static_cast<float>(along(0, 0, 1)[2]);
    light.term[4] = c[4] * static_cast<float>(along(1, 1, 0)[4]);
    light.term[5] = c[5] * static_cast<float>(along(0, 1, 1)[5]);
    light.term[6] = c[7] * static_cast<float>(along(1, 0, 1)[7]);
    light.term[7] = c[6] * static_cast<float>(along(0, 0, 1)[6] / 2.0);
    light.term[8] = c[8] * static_cast<float>(along(1, 0, 0)[8]);
    return light;
}

vec3 irradiance_of(const HarmonicLight& light, const PixelMoments& moments, int samples) {
    vec3 sum(0.0f);
    for (std::size_t k = 0; k < moments.size(); ++k) sum += moments[k] * light.term[k];
    return sum * (std::numbers::pi_v<float> / static_cast<float>(samples));
}

vec3 reflected_radiance(const EnvironmentRequest& request, std::size_t pixel, vec3 irradiance) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    const vec3 share = request.glossy ? vec3(1.0f) : surfaces.albedo[pixel];
    return surfaces.emission[pixel] + share * std::numbers::inv_pi_v<float> * irradiance;
}

void add(SampleCounts& sum, const SampleCounts& counts) {
    sum.samples += counts.samples;
    sum.below += counts.below;
    sum.traced += counts.traced;
    sum.traced_blocked += counts.traced_blocked;
    sum.outside += counts.outside;
}

EnvironmentResult blank_environment(const EnvironmentRequest& request) {
    const ImageSize size = request.surfaces->size;
    EnvironmentResult result;
    result.irradiance = ImageRgb(size);
    result.radiance = ImageRgb(size);
    result.rays_traced = Image<std::uint32_t>(size);
    result.rays_asked = Image<std::uint32_t>(size);
    result.shadow = ImageScalar(size);
    if (request.keep_verdicts) {
        result.verdicts.words_per_pixel = (static_cast<std::uint32_t>(request.pattern->samples) + 31u) / 32u;
        result.verdicts.words.resize(size.pixels() * result.verdicts.words_per_pixel);
    }
    return result;
}

IrradianceError compare_irradiance(const EnvironmentResult& ours, const EnvironmentResult& reference,
                                   const EnvironmentRequest& request) {
    const SurfaceBuffer& surfaces = *request.surfaces;
    IrradianceError error;
    double squares = 0.0, values = 0.0;
    for (std::size_t p = 0; p < surfaces.triangle.size(); ++p) {
        if (surfaces.triangle[p] == no_triangle) continue;
        const vec3 unshadowed = irradiance(request.light, surfaces.shading_normal[p]);
        for (int channel = 0; channel < 3; ++channel) {
            const double expected = reference.irradiance.pixels[p][channel];
            const double difference = ours.irradiance.pixels[p][channel] - expected;
            squares += difference * difference;
            error.mean_absolute += std::fabs(difference);
            error.max_absolute = std::max(error.max_absolute, std::fabs(difference));
            error.mean_reference += expected;
            error.mean_unshadowed += unshadowed[channel];
            values += 1.0;
        }
    }
    if (values == 0.0) return error;
    error.rmse = std::sqrt(squares / values);
    error.mean_absolute /= values;
    error.mean_reference /= values;
    error.mean_unshadowed /= values;
    return error;
}

}  // namespace sightlines::visibility_field
