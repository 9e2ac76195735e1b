// Pictures inside and beside glTF files.
#pragma once

#include <cstdint>
#include <optional>

#include "techniques/base/image.h"
#include "techniques/scene/gltf_source.h"

namespace sightlines {

/// Decodes a PNG or JPEG of at most `texel_limit` texels to RGBA, 8 bits a channel, as stored (colour is sRGB). Nothing
/// where the picture is of another format or left to an unknown extension. InputError where it is damaged or too large.
std::optional<ImageRgba8> decode_gltf_image(const GltfSource& source, const GltfImage& image,
                                            std::uint64_t texel_limit);

}  // namespace sightlines
