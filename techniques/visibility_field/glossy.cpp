#include "techniques/visibility_field/glossy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float least_roughness = 0.05f;

/// Smith's function of masking: how many times more facets are hidden than seen.
float hidden_to_seen(float width, vec3 direction) {
    const float squared = direction.z * direction.z;
    const float slope = width * width * std::max(0.0f, 1.0f - squared) / std::max(squared, 1.0e-20f);
    return 0.5f * (std::sqrt(1.0f + slope) - 1.0f);
}

float luminance(vec3 colour) { return glm::dot(colour, vec3(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace

Gloss make_gloss(vec3 albedo, float roughness, float metalness) {
    const vec3 base = albedo / (1.0f - 0.5f * metalness);
    const float kept = std::max(roughness, least_roughness);
    return {base * (1.0f - metalness), glm::mix(vec3(0.04f), base, metalness), kept * kept};
}

vec3 facet_reflectance(vec3 head_on, float cosine) {
    const float missing = std::clamp(1.0f - cosine, 0.0f, 1.0f), squared = missing * missing;
    return head_on + (vec3(1.0f) - head_on) * (squared * squared * missing);
}

float normal_density(float width, vec3 normal) {
    if (normal.z <= 0.0f) return 0.0f;
    const float w = width * width;
    // Instead of 1 - z * z, which loses all digits near the middle.
    const float spread = (normal.x * normal.x + normal.y * normal.y) + w * normal.z * normal.z;
    return w / (pi * spread * spread);
}

float seen_share(float width, vec3 direction) { return 1.0f / (1.0f + hidden_to_seen(width, direction)); }

vec3 reflected_share(const Gloss& gloss, vec3 to_eye, vec3 to_light) {
    if (to_eye.z <= 0.0f || to_light.z <= 0.0f) return vec3(0.0f);
    const vec3 half = glm::normalize(to_eye + to_light);
    const vec3 facets = facet_reflectance(gloss.head_on, glm::dot(to_eye, half));
    const float seen = 1.0f / (1.0f + hidden_to_seen(gloss.width, to_eye) + hidden_to_seen(gloss.width, to_light));
    const float mirrored = normal_density(gloss.width, half) * seen / (4.0f * to_eye.z * to_light.z);
    // What enters below the facets, and leaves again: by the surface as a whole, or light from the side would grow.
    const vec3 entering = vec3(1.0f) - facet_reflectance(gloss.head_on, to_light.z);
    const vec3 leaving = vec3(1.0f) - facet_reflectance(gloss.head_on, to_eye.z);
    return facets * mirrored + entering * leaving * gloss.diffuse / pi;
}

vec3 mirrored_sample(float width, vec3 to_eye, vec2 numbers) {
    // The surface is stretched so that its facets become a hemisphere; of that the half disc that is seen is drawn
    // from.
    const vec3 stretched = glm::normalize(vec3(width * to_eye.x, width * to_eye.y, to_eye.z));
    const float across = stretched.x * stretched.x + stretched.y * stretched.y;
    const vec3 side =
        across > 0.0f ? vec3(-stretched.y, stretched.x, 0.0f) / std::sqrt(across) : vec3(1.0f, 0.0f, 0.0f);
    const vec3 up = glm::cross(stretched, side);
    const float radius = std::sqrt(numbers.x), angle = 2.0f * pi * numbers.y;
    const float x = radius * std::cos(angle);
    const float lean = 0.5f * (1.0f + stretched.z);
    const float y = (1.0f - lean) * std::sqrt(std::max(0.0f, 1.0f - x * x)) + lean * radius * std::sin(angle);
    const vec3 on_hemisphere = x * side + y * up + std::sqrt(std::max(0.0f, 1.0f - x * x - y * y)) * stretched;
    const vec3 normal =
        glm::normalize(vec3(width * on_hemisphere.x, width * on_hemisphere.y, std::max(1.0e-6f, on_hemisphere.z)));
    return 2.0f * glm::dot(to_eye, normal) * normal - to_eye;
}

float mirrored_density(float width, vec3 to_eye, vec3 to_light) {
    if (to_eye.z <= 0.0f) return 0.0f;
    const vec3 sum = to_eye + to_light;
    const float length = glm::length(sum);
    if (length <= 0.0f) return 0.0f;
    return seen_share(width, to_eye) * normal_density(width, sum / length) / (4.0f * to_eye.z);
}

float mirrored_share(const Gloss& gloss, vec3 to_eye) {
    const float mirrored = luminance(facet_reflectance(gloss.head_on, to_eye.z)), even = luminance(gloss.diffuse);
    return even <= 0.0f ? 1.0f : std::clamp(mirrored / (mirrored + even), 0.25f, 0.9f);
}

}  // namespace sightlines::visibility_field
