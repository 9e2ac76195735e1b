// Looking up a material's textures: wrap modes, KHR_texture_transform, bilinear filter, sRGB decoding.
#pragma once

#include <array>

#include "techniques/scene/scene.h"

namespace sightlines {

/// The texture coordinates that a material looks up for a vertex's coordinates: scaled, then rotated, then moved
/// (KHR_texture_transform; the rotation's sign as in the extension's example and the official sample viewer: positive
/// is counter-clockwise as seen, with v pointing down).
vec2 transformed_coordinates(const TextureLookup& lookup, vec2 coordinates);

/// The four texels round a point and their weights, wrapped. Texel centres lie at (i + 0.5) / size.
struct BilinearTap {
    std::array<std::size_t, 4> texel{};  ///< indices into the pixels
    std::array<float, 4> weight{};       ///< sum to 1
};

/// `size` must not be empty. Coordinates that are not finite count as 0.
BilinearTap bilinear_tap(ImageSize size, Wrap wrap_u, Wrap wrap_v, vec2 coordinates);

/// Linear Rec. 709 in xyz (each texel is decoded from sRGB before it is filtered), alpha in w. White where the texture
/// is empty.
vec4 sample_texture(const Texture& texture, vec2 coordinates);

/// Diffuse reflectance of a triangle's material where the hit is, its texture looked up. A metal keeps half of its
/// colour: under diffuse light it would be black otherwise.
vec3 diffuse_albedo(const Scene& scene, std::uint32_t triangle, vec2 barycentric);

/// A texture looked up where the hit is; white where the material has none or the scene has no coordinates for it.
vec4 looked_up(const Scene& scene, const std::optional<TextureLookup>& lookup, std::uint32_t triangle,
               vec2 barycentric);

/// Linear value of an 8-bit sRGB channel.
float linear_from_srgb(std::uint8_t value);

}  // namespace sightlines
