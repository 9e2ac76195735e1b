#include "visualizers/raster.h"

#include <algorithm>
#include <cmath>

namespace sightlines {
namespace {

/// How far, in metres, the nearest neighbour on either side of a line of three stands behind its middle, less what a
/// plane would.
float step_behind_m(float before, float here, float after) {
    // Second difference of 1/z: nought on planes; dz = d(1/z) z^2.
    return (2.0f * here - before - after) / (here * here);
}

}  // namespace

void ink_outlines(DrawnPixels& drawn, float jump_m, vec3 ink, float strength) {
    const ImageSize size = drawn.colour.size;
    const auto row = static_cast<std::size_t>(size.width);
    const std::vector<float>& q = drawn.inverse_depth;
    for (int y = 1; y + 1 < size.height; ++y)
        for (int x = 1; x + 1 < size.width; ++x) {
            const std::size_t p = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
            if (q[p] == 0.0f) continue;
            const float step_m =
                std::max(step_behind_m(q[p - 1], q[p], q[p + 1]), step_behind_m(q[p - row], q[p], q[p + row]));
            const float amount = strength * std::clamp(step_m / jump_m - 0.5f, 0.0f, 1.0f);
            if (amount <= 0.0f) continue;
            glm::u8vec4& pixel = drawn.colour.pixels[p];
            const float alpha = static_cast<float>(pixel.a) / 255.0f;
            const vec3 inked = glm::mix(vec3(pixel), ink * alpha * 255.0f, amount);
            pixel = glm::u8vec4(glm::u8vec3(inked + 0.5f), pixel.a);
        }
}

ImageRgba8 reduced(const ImageRgba8& premultiplied, int samples_per_axis) {
    const int n = samples_per_axis;
    ImageRgba8 out({premultiplied.size.width / n, premultiplied.size.height / n});
    for (int y = 0; y < out.size.height; ++y)
        for (int x = 0; x < out.size.width; ++x) {
            glm::uvec4 sum(0);
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) sum += glm::uvec4(premultiplied.at(x * n + i, y * n + j));
            if (sum.a == 0) continue;
            const auto count = static_cast<unsigned>(n * n);
            const uvec3 colour = glm::min((uvec3(sum) * 255u + sum.a / 2u) / sum.a, uvec3(255u));
            out.at(x, y) = glm::u8vec4(glm::u8vec3(colour), static_cast<std::uint8_t>((sum.a + count / 2u) / count));
        }
    return out;
}

ImageRgba8 over_page(const ImageRgba8& picture, vec3 page) {
    ImageRgba8 out(picture.size);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const glm::u8vec4 pixel = picture.pixels[i];
        const vec3 mixed = glm::mix(page * 255.0f, vec3(pixel), static_cast<float>(pixel.a) / 255.0f);
        out.pixels[i] = glm::u8vec4(glm::u8vec3(mixed + 0.5f), 255);
    }
    return out;
}

}  // namespace sightlines
