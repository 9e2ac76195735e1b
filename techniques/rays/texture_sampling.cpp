#include "techniques/rays/texture_sampling.h"

#include <algorithm>
#include <cmath>

namespace sightlines {
namespace {

std::array<float, 256> srgb_table() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const float value = static_cast<float>(i) / 255.0f;
        table[i] = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
    }
    return table;
}

/// The coordinate brought into one period of the texture, so that its texel index fits an int.
float periodic(float coordinate, Wrap wrap) {
    if (!std::isfinite(coordinate)) return 0.0f;
    switch (wrap) {
        case Wrap::clamp:
            return std::clamp(coordinate, 0.0f, 1.0f);
        case Wrap::repeat:
            return coordinate - std::floor(coordinate);
        case Wrap::mirrored_repeat:
            return coordinate - 2.0f * std::floor(0.5f * coordinate);
    }
    return coordinate;
}

/// A texel index at most one period outside the texture, brought inside.
int wrapped(int index, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(index, 0, size - 1);
    const int period = wrap == Wrap::repeat ? size : 2 * size;
    const int inside = ((index % period) + period) % period;
    return inside < size ? inside : 2 * size - 1 - inside;
}

struct AxisTap {
    std::array<int, 2> index{};
    float fraction = 0.0f;  // the weight of the second
};

AxisTap axis_tap(float coordinate, int size, Wrap wrap) {
    const float place = periodic(coordinate, wrap) * static_cast<float>(size) - 0.5f;
    const float whole = std::floor(place);
    const int first = static_cast<int>(whole);
    return {{wrapped(first, size, wrap), wrapped(first + 1, size, wrap)}, place - whole};
}

}  // namespace

vec2 transformed_coordinates(const TextureLookup& lookup, vec2 coordinates) {
    const vec2 scaled = coordinates * lookup.scale;
    const float cosine = std::cos(lookup.rotation_rad);
    const float sine = std::sin(lookup.rotation_rad);
    return lookup.offset + vec2(cosine * scaled.x + sine * scaled.y, cosine * scaled.y - sine * scaled.x);
}

BilinearTap bilinear_tap(ImageSize size, Wrap wrap_u, Wrap wrap_v, vec2 coordinates) {
    const AxisTap u = axis_tap(coordinates.x, size.width, wrap_u);
    const AxisTap v = axis_tap(coordinates.y, size.height, wrap_v);
    BilinearTap tap;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::size_t right = corner & 1u;
        const std::size_t below = corner >> 1u;
        tap.texel[corner] = static_cast<std::size_t>(v.index[below]) * static_cast<std::size_t>(size.width) +
                            static_cast<std::size_t>(u.index[right]);
        tap.weight[corner] =
            (right == 1 ? u.fraction : 1.0f - u.fraction) * (below == 1 ? v.fraction : 1.0f - v.fraction);
    }
    return tap;
}

vec4 sample_texture(const Texture& texture, vec2 coordinates) {
    if (texture.texels.empty()) return vec4(1.0f);
    const BilinearTap tap = bilinear_tap(texture.texels.size, texture.wrap_u, texture.wrap_v, coordinates);
    vec4 sum(0.0f);
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const glm::u8vec4 texel = texture.texels.pixels[tap.texel[corner]];
        sum += tap.weight[corner] * vec4(linear_from_srgb(texel.r), linear_from_srgb(texel.g),
                                         linear_from_srgb(texel.b), static_cast<float>(texel.a) / 255.0f);
    }
    return sum;
}

float linear_from_srgb(std::uint8_t value) {
    static const std::array<float, 256> table = srgb_table();
    return table[value];
}

vec4 looked_up(const Scene& scene, const std::optional<TextureLookup>& lookup, std::uint32_t triangle,
               vec2 barycentric) {
    if (!lookup || scene.texture_coordinates[lookup->coordinate_set].empty()) return vec4(1.0f);
    const std::vector<vec2>& all = scene.texture_coordinates[lookup->coordinate_set];
    const uvec3 vertices = scene.triangles[triangle];
    const vec2 coordinates = (1.0f - barycentric.x - barycentric.y) * all[vertices.x] +
                             barycentric.x * all[vertices.y] + barycentric.y * all[vertices.z];
    return sample_texture(scene.textures[lookup->texture], transformed_coordinates(*lookup, coordinates));
}

vec3 diffuse_albedo(const Scene& scene, std::uint32_t triangle, vec2 barycentric) {
    constexpr float metal_diffuse_share = 0.5f;
    const Material& material = scene.materials[scene.triangle_materials[triangle]];
    const vec3 base = material.base_color * vec3(looked_up(scene, material.base_color_texture, triangle, barycentric));
    return base * (1.0f - material.metallic + metal_diffuse_share * material.metallic);
}

}  // namespace sightlines
