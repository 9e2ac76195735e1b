#include "techniques/scene/harmonics.h"

#include <cmath>
#include <numbers>

namespace sightlines {
namespace {

constexpr double pi = std::numbers::pi;

/// The normalisations of 1; y, z, x; xy, yz, 3zz - 1, xz, xx - yy.
constexpr double constant = 0.28209479177387814, linear = 0.4886025119029199, product = 1.0925484305920792,
                 polar = 0.31539156525252005, difference = 0.5462742152960396;

/// What a clamped cosine keeps of each band.
constexpr std::array<double, 9> cosine_lobe{pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                                            pi / 4, pi / 4,     pi / 4,     pi / 4};

/// Band 2 of one channel as the symmetric matrix M without trace whose form d M d is the band's value.
glm::dmat3 band_matrix(const Harmonics& harmonics, int channel) {
    const auto c = [&](std::size_t k) { return static_cast<double>(harmonics.coefficient[k][channel]); };
    const double xy = 0.5 * product * c(4), yz = 0.5 * product * c(5), zx = 0.5 * product * c(7);
    // 3zz - 1 is 2zz - xx - yy on the unit sphere.
    const double zz = 2.0 * polar * c(6), xx = difference * c(8) - polar * c(6), yy = -difference * c(8) - polar * c(6);
    return {dvec3(xx, xy, zx), dvec3(xy, yy, yz), dvec3(zx, yz, zz)};
}

void set_band(Harmonics& harmonics, int channel, const glm::dmat3& m) {
    const auto set = [&](std::size_t k, double value) {
        harmonics.coefficient[k][channel] = static_cast<float>(value);
    };
    set(4, 2.0 * m[0][1] / product);
    set(5, 2.0 * m[1][2] / product);
    set(6, m[2][2] / (2.0 * polar));
    set(7, 2.0 * m[0][2] / product);
    set(8, (m[0][0] - m[1][1]) / (2.0 * difference));
}

}  // namespace

std::array<double, 9> harmonic_functions(dvec3 d) {
    return {constant,
            linear * d.y,
            linear * d.z,
            linear * d.x,
            product * d.x * d.y,
            product * d.y * d.z,
            polar * (3.0 * d.z * d.z - 1.0),
            product * d.x * d.z,
            difference * (d.x * d.x - d.y * d.y)};
}

Harmonics project(const Environment& environment) {
    const ImageRgb& picture = environment.radiance;
    std::array<dvec3, 9> sums{};
    for (int y = 0; y < picture.size.height; ++y) {
        const double solid_angle = texel_solid_angle(picture.size, y);
        for (int x = 0; x < picture.size.width; ++x) {
            const vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const auto functions = harmonic_functions(dvec3(equirectangular_direction(picture.size, middle)));
            const dvec3 light = solid_angle * dvec3(picture.at(x, y));
            for (std::size_t k = 0; k < 9; ++k) sums[k] += functions[k] * light;
        }
    }
    Harmonics harmonics;
    for (std::size_t k = 0; k < 9; ++k) harmonics.coefficient[k] = vec3(sums[k]);
    return harmonics;
}

Harmonics rotated(const Harmonics& harmonics, const mat3& rotation) {
    const glm::dmat3 turn(rotation);
    Harmonics result = harmonics;
    for (int channel = 0; channel < 3; ++channel) {
        const auto c = [&](std::size_t k) { return static_cast<double>(harmonics.coefficient[k][channel]); };
        const dvec3 band_1 = turn * dvec3(c(3), c(1), c(2));
        result.coefficient[1][channel] = static_cast<float>(band_1.y);
        result.coefficient[2][channel] = static_cast<float>(band_1.z);
        result.coefficient[3][channel] = static_cast<float>(band_1.x);
        set_band(result, channel, turn * band_matrix(harmonics, channel) * glm::transpose(turn));
    }
    return result;
}

vec3 radiance(const Harmonics& harmonics, vec3 direction) {
    const auto functions = harmonic_functions(dvec3(direction));
    dvec3 sum(0.0);
    for (std::size_t k = 0; k < 9; ++k) sum += functions[k] * dvec3(harmonics.coefficient[k]);
    return vec3(sum);
}

vec3 irradiance(const Harmonics& harmonics, vec3 normal) {
    const auto functions = harmonic_functions(dvec3(normal));
    dvec3 sum(0.0);
    for (std::size_t k = 0; k < 9; ++k) sum += cosine_lobe[k] * functions[k] * dvec3(harmonics.coefficient[k]);
    return vec3(sum);
}

mat3 turn_about_up(float degrees) {
    const float angle = glm::radians(degrees);
    // -Z goes to (sin, 0, -cos).
    return {vec3(std::cos(angle), 0.0f, std::sin(angle)), vec3(0.0f, 1.0f, 0.0f),
            vec3(-std::sin(angle), 0.0f, std::cos(angle))};
}

}  // namespace sightlines
