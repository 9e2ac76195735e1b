// Images: plain arrays of pixels, row-major, top row first; and how they become files.
#pragma once

#include <filesystem>
#include <vector>

#include "techniques/base/types.h"

namespace sightlines {

/// `pixels[y * width + x]`, y = 0 the top row.
template <class Pixel>
struct Image {
    ImageSize size{0, 0};
    std::vector<Pixel> pixels;

    Image() = default;
    explicit Image(ImageSize size_, Pixel fill = Pixel{}) : size(size_), pixels(size_.pixels(), fill) {}
    bool operator==(const Image&) const = default;
    bool empty() const { return pixels.empty(); }
    Pixel& at(int x, int y) {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
    }
    const Pixel& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
    }
};

using ImageRgb = Image<vec3>;  ///< linear Rec. 709 radiance
using ImageScalar = Image<float>;
using ImageRgba8 = Image<glm::u8vec4>;  ///< sRGB, as shown and saved

/// How radiance becomes what is seen: exposure in stops, then the tone curve, then the sRGB transfer function.
struct Display {
    float exposure_stops = 0.0f;
    bool tone_curve = true;  ///< a filmic shoulder; off: clipped at 1

    bool operator==(const Display&) const = default;
};

ImageRgba8 shown(const ImageRgb& radiance, const Display& display);

/// Scalar picture through the perceptually uniform colour map (viridis), `low` to `high`; NaN is transparent grey.
ImageRgba8 colour_mapped(const ImageScalar& values, float low, float high);
/// Viridis at t in [0, 1], sRGB.
vec3 viridis(float t);

/// Writes by extension: `.png` (tone-mapped sRGB) or `.hdr` (linear RGBE). Complete or not at all.
/// Throws InputError for another extension, EnvironmentError where the file cannot be written.
void write_image(const std::filesystem::path& file, const ImageRgb& radiance, const Display& display);
void write_png(const std::filesystem::path& file, const ImageRgba8& picture);
std::vector<std::uint8_t> encode_png(const ImageRgba8& picture);
/// Reads a PNG as written by write_png (golden pictures). Throws InputError.
ImageRgba8 read_png(const std::filesystem::path& file);

}  // namespace sightlines
