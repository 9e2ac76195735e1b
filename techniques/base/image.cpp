#include "techniques/base/image.h"

#include <algorithm>
#include <array>
#include <cmath>

#define STB_IMAGE_STATIC
#define STB_IMAGE_WRITE_STATIC
#define STBI_ONLY_PNG
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include "techniques/base/error.h"
#include "techniques/base/files.h"

namespace sightlines {
namespace {

constexpr std::uint64_t png_limit_bytes = 256u << 20u;
constexpr float brightest_shown = 1.0e6f;  // far beyond white

float srgb_from_linear(float value) {
    return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

/// Hable's filmic curve, scaled so that 1 stays near 0.8 and white is 8.
float filmic(float x) {
    const auto curve = [](float v) {
        return (v * (0.22f * v + 0.03f) + 0.002f) / (v * (0.22f * v + 0.3f) + 0.06f) - 0.0333f;
    };
    return curve(1.6f * x) / curve(1.6f * 8.0f);
}

std::uint8_t byte_from_unit(float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

void append(void* context, void* data, int size) {
    auto& bytes = *static_cast<std::vector<std::uint8_t>*>(context);
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), from, from + size);
}

}  // namespace

ImageRgba8 shown(const ImageRgb& radiance, const Display& display) {
    ImageRgba8 picture(radiance.size);
    const float exposure = std::exp2(display.exposure_stops);
    for (std::size_t p = 0; p < radiance.pixels.size(); ++p) {
        glm::u8vec4 texel(255);
        for (int channel = 0; channel < 3; ++channel) {
            // In this order NaN becomes 0; infinity becomes white, which the tone curve would turn into NaN.
            float value = std::min(std::max(0.0f, radiance.pixels[p][channel]) * exposure, brightest_shown);
            if (display.tone_curve) value = filmic(value);
            texel[channel] = byte_from_unit(srgb_from_linear(std::clamp(value, 0.0f, 1.0f)));
        }
        picture.pixels[p] = texel;
    }
    return picture;
}

vec3 viridis(float t) {
    // Nine knots of matplotlib's viridis (CC0), linear between them.
    static constexpr std::array<std::array<float, 3>, 9> knots{{{0.267f, 0.005f, 0.329f},
                                                                {0.279f, 0.175f, 0.483f},
                                                                {0.230f, 0.322f, 0.546f},
                                                                {0.173f, 0.449f, 0.558f},
                                                                {0.128f, 0.567f, 0.551f},
                                                                {0.153f, 0.678f, 0.506f},
                                                                {0.360f, 0.785f, 0.388f},
                                                                {0.668f, 0.862f, 0.196f},
                                                                {0.993f, 0.906f, 0.144f}}};
    const float place = std::clamp(t, 0.0f, 1.0f) * 8.0f;
    const auto knot = std::min<std::size_t>(7, static_cast<std::size_t>(place));
    const float blend = place - static_cast<float>(knot);
    const auto& a = knots[knot];
    const auto& b = knots[knot + 1];
    return {a[0] + blend * (b[0] - a[0]), a[1] + blend * (b[1] - a[1]), a[2] + blend * (b[2] - a[2])};
}

ImageRgba8 colour_mapped(const ImageScalar& values, float low, float high) {
    ImageRgba8 picture(values.size);
    for (std::size_t p = 0; p < values.pixels.size(); ++p) {
        const float value = values.pixels[p];
        if (std::isnan(value)) {
            picture.pixels[p] = glm::u8vec4(128, 128, 128, 0);
            continue;
        }
        const vec3 colour = viridis((value - low) / std::max(high - low, 1e-20f));
        picture.pixels[p] = {byte_from_unit(colour.r), byte_from_unit(colour.g), byte_from_unit(colour.b), 255};
    }
    return picture;
}

std::vector<std::uint8_t> encode_png(const ImageRgba8& picture) {
    std::vector<std::uint8_t> bytes;
    stbi_write_png_to_func(append, &bytes, picture.size.width, picture.size.height, 4, picture.pixels.data(),
                           picture.size.width * 4);
    return bytes;
}

void write_png(const std::filesystem::path& file, const ImageRgba8& picture) { write_file(file, encode_png(picture)); }

void write_image(const std::filesystem::path& file, const ImageRgb& radiance, const Display& display) {
    const std::string extension = file.extension().string();
    if (extension == ".png") return write_png(file, shown(radiance, display));
    if (extension != ".hdr")
        throw InputError(file.string(), "", "pictures are written as .png or .hdr", "end the name with one of them");
    std::vector<std::uint8_t> bytes;
    stbi_write_hdr_to_func(append, &bytes, radiance.size.width, radiance.size.height, 3, &radiance.pixels.data()->x);
    write_file(file, bytes);
}

ImageRgba8 read_png(const std::filesystem::path& file) {
    const std::vector<std::uint8_t> bytes = read_file(file, png_limit_bytes);
    int width = 0, height = 0, channels = 0;
    stbi_uc* texels =
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, 4);
    if (texels == nullptr) throw InputError(file.string(), "", std::string("is not a PNG: ") + stbi_failure_reason());
    ImageRgba8 picture(ImageSize{width, height});
    std::copy_n(reinterpret_cast<const glm::u8vec4*>(texels), picture.pixels.size(), picture.pixels.begin());
    stbi_image_free(texels);
    return picture;
}

}  // namespace sightlines
