#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "techniques/rays/reference.h"

namespace sightlines {
namespace {

std::uint32_t differing_bits(const Verdicts& a, const Verdicts& b, std::size_t pixel) {
    std::uint32_t count = 0;
    const std::size_t first = pixel * a.words_per_pixel;
    for (std::size_t word = first; word < first + a.words_per_pixel; ++word)
        count += static_cast<std::uint32_t>(std::popcount(a.words[word] ^ b.words[word]));
    return count;
}

/// Fills in the errors of radiance.
void compare_radiance(const ImageRgb& ours, const ImageRgb& reference, ErrorMetrics& metrics) {
    double squares = 0.0;
    for (std::size_t p = 0; p < ours.pixels.size(); ++p) {
        for (int channel = 0; channel < 3; ++channel) {
            const double difference = static_cast<double>(ours.pixels[p][channel]) - reference.pixels[p][channel];
            squares += difference * difference;
            metrics.max_abs = std::max(metrics.max_abs, std::fabs(difference));
        }
    }
    if (!ours.pixels.empty()) metrics.rmse = std::sqrt(squares / (3.0 * static_cast<double>(ours.pixels.size())));
}

}  // namespace

ErrorMetrics compare(const RenderResult& ours, const RenderResult& reference) {
    const ImageSize size = reference.rays_asked.size;
    assert(ours.radiance.size == size && ours.shadow.size == size && reference.shadow.size == size);
    assert(ours.verdicts.words_per_pixel == reference.verdicts.words_per_pixel);
    assert(ours.verdicts.words.size() == reference.verdicts.words.size());
    ErrorMetrics metrics;
    metrics.visibility_error = ImageScalar(size, std::numeric_limits<float>::quiet_NaN());
    metrics.shadow_error = metrics.visibility_error;
    double visibility_sum = 0.0, shadow_sum = 0.0, wrong_rays = 0.0, uncancelled_rays = 0.0;
    std::size_t asking_pixels = 0;
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        const std::uint32_t asked = reference.rays_asked.pixels[p];
        if (asked == 0) continue;
        // A backend that rounds otherwise may ask a ray more at grazing angles; hence the limit.
        const double wrong =
            std::min(1.0, static_cast<double>(differing_bits(ours.verdicts, reference.verdicts, p)) / asked);
        const float shadow = ours.shadow.pixels[p] - reference.shadow.pixels[p];
        metrics.visibility_error.pixels[p] = static_cast<float>(wrong);
        metrics.shadow_error.pixels[p] = shadow;
        visibility_sum += wrong;
        shadow_sum += std::fabs(static_cast<double>(shadow));
        wrong_rays += wrong * asked;
        uncancelled_rays += std::fabs(static_cast<double>(shadow)) * asked;
        ++asking_pixels;
    }
    if (asking_pixels > 0) {
        const auto pixels = static_cast<double>(asking_pixels);
        metrics.visibility_percent = 100.0 * visibility_sum / pixels;
        metrics.shadow_percent = 100.0 * shadow_sum / pixels;
        metrics.wrong_rays = wrong_rays / pixels;
        metrics.uncancelled_rays = uncancelled_rays / pixels;
    }
    compare_radiance(ours.radiance, reference.radiance, metrics);
    return metrics;
}

}  // namespace sightlines
