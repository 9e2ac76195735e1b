#include "techniques/visibility_field/glossy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shaders/glossy.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

constexpr float least_roughness = 0.05f;

float luminance(vec3 colour) { return glm::dot(colour, vec3(0.2126f, 0.7152f, 0.0722f)); }

vec3 facet_reflectance(vec3 head_on, float cosine) {
    return head_on + (vec3(1.0f) - head_on) * kernel::towards_all(cosine);
}

}  // namespace

Gloss make_gloss(vec3 albedo, float roughness, float metalness) {
    const vec3 base = albedo / (1.0f - 0.5f * metalness);
    const float kept = std::max(roughness, least_roughness);
    return {base * (1.0f - metalness), glm::mix(vec3(0.04f), base, metalness), kept * kept};
}

GlossySurface glossy_surface(const Gloss& gloss, vec3 to_eye) {
    GlossySurface surface{};
    surface.to_eye = to_eye;
    surface.head_on = gloss.head_on;
    const vec3 leaving = vec3(1.0f) - facet_reflectance(gloss.head_on, to_eye.z);
    surface.evenly = leaving * gloss.diffuse * std::numbers::inv_pi_v<float>;
    surface.stretched = glm::normalize(vec3(gloss.width * to_eye.x, gloss.width * to_eye.y, to_eye.z));
    const float across = std::hypot(surface.stretched.x, surface.stretched.y);
    surface.side = across > 0.0f ? vec3(-surface.stretched.y, surface.stretched.x, 0.0f) / across : vec3(1, 0, 0);
    surface.up = glm::cross(surface.stretched, surface.side);
    surface.lean = 0.5f * (1.0f + surface.stretched.z);
    surface.width = gloss.width;
    surface.hidden_from_eye = kernel::hidden_to_seen(gloss.width, to_eye.z);
    return surface;
}

vec3 reflected_share(const Gloss& gloss, vec3 to_eye, vec3 to_light) {
    if (to_eye.z <= 0.0f || to_light.z <= 0.0f) return vec3(0.0f);
    return kernel::reflection_of(glossy_surface(gloss, to_eye), to_light).share;
}

vec3 mirrored_sample(float width, vec3 to_eye, vec2 numbers) {
    return kernel::mirrored_direction(glossy_surface({vec3(0.0f), vec3(0.0f), width}, to_eye), numbers.x, numbers.y);
}

float mirrored_density(float width, vec3 to_eye, vec3 to_light) {
    if (to_eye.z <= 0.0f || to_eye.z + to_light.z <= 0.0f) return 0.0f;
    return kernel::reflection_of(glossy_surface({vec3(0.0f), vec3(0.0f), width}, to_eye), to_light).density;
}

float mirrored_share(const Gloss& gloss, vec3 to_eye) {
    const float mirrored = luminance(facet_reflectance(gloss.head_on, to_eye.z)), even = luminance(gloss.diffuse);
    return even <= 0.0f ? 1.0f : std::clamp(mirrored / (mirrored + even), 0.25f, 0.9f);
}

}  // namespace sightlines::visibility_field
