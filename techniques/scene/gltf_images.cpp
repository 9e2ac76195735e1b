#include "techniques/scene/gltf_images.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <stb/stb_image.h>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/gltf_accessors.h"
#include "techniques/scene/gltf_files.h"
#include "techniques/scene/gltf_limits.h"

namespace sightlines {
namespace {

std::vector<std::uint8_t> encoded_bytes(const GltfSource& source, const GltfImage& image) {
    if (image.buffer_view) {
        const auto bytes = view_bytes(source, *image.buffer_view);
        return {bytes.begin(), bytes.end()};
    }
    if (!image.path.empty()) return read_file(image.path, gltf_limits::file_bytes / 4);
    if (image.data_uri.empty()) return {};
    auto bytes = decode_data_uri(image.data_uri);
    if (!bytes) throw InputError(source.file, image.place + ".uri", "is a malformed data URI");
    return std::move(*bytes);
}

/// The decoder knows more formats than glTF allows; only these two reach it.
bool is_png_or_jpeg(const std::vector<std::uint8_t>& bytes) {
    constexpr std::array<std::uint8_t, 8> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    constexpr std::array<std::uint8_t, 3> jpeg = {0xff, 0xd8, 0xff};
    return (bytes.size() >= png.size() && std::equal(png.begin(), png.end(), bytes.begin())) ||
           (bytes.size() >= jpeg.size() && std::equal(jpeg.begin(), jpeg.end(), bytes.begin()));
}

}  // namespace

std::optional<ImageRgba8> decode_gltf_image(const GltfSource& source, const GltfImage& image,
                                            std::uint64_t texel_limit) {
    const std::vector<std::uint8_t> bytes = encoded_bytes(source, image);
    if (!is_png_or_jpeg(bytes)) return std::nullopt;
    const auto refuse = [&](const std::string& problem, const std::string& remedy) {
        throw InputError(source.file, image.place, problem, remedy);
    };
    const int size = static_cast<int>(bytes.size());  // below the file limit of 2^29 bytes
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0 || width <= 0 || height <= 0)
        refuse("is a damaged picture", "save it again");
    if (width > gltf_limits::image_side || height > gltf_limits::image_side)
        refuse("is " + std::to_string(width) + " x " + std::to_string(height) + " texels; the limit is " +
                   std::to_string(gltf_limits::image_side) + " a side",
               "scale it down");
    if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > texel_limit)
        refuse("brings the pictures above the limit of " + std::to_string(gltf_limits::texels) + " texels in all",
               "scale them down");

    const std::unique_ptr<stbi_uc, void (*)(void*)> texels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (!texels) refuse(std::string("is a damaged picture: ") + stbi_failure_reason(), "save it again");
    ImageRgba8 picture(ImageSize{width, height});
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const stbi_uc* texel = texels.get() + 4 * i;
        picture.pixels[i] = {texel[0], texel[1], texel[2], texel[3]};
    }
    return picture;
}

}  // namespace sightlines
