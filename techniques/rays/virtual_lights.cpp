#include "techniques/rays/virtual_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "techniques/base/parallel.h"
#include "techniques/base/random.h"
#include "techniques/rays/embree_handles.h"
#include "techniques/rays/texture_sampling.h"

namespace sightlines {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr int most_bounces = 64;
constexpr std::int64_t particles_per_task = 64;

/// Random numbers of one particle: a few for its start, a few for each bounce.
constexpr std::uint32_t draws_at_start = 8, draws_per_bounce = 4;

struct Particle {
    vec3 origin{0.0f}, direction{0.0f};
    vec3 flux{0.0f};  ///< W, of a single particle that carries all
};

/// Two directions square to a unit vector and each other.
std::pair<vec3, vec3> across(vec3 axis) {
    const vec3 helper = std::abs(axis.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    const vec3 first = glm::normalize(glm::cross(axis, helper));
    return {first, glm::cross(axis, first)};
}

/// The unit vector at an angle, by its cosine, from `axis`.
vec3 about(vec3 axis, float cosine, float turn) {
    const auto [first, second] = across(axis);
    const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f)), azimuth = 2.0f * pi * turn;
    return cosine * axis + sine * (std::cos(azimuth) * first + std::sin(azimuth) * second);
}

/// A spot's cone as the kernels know it: full within the inner cosine, falling as a square to the outer.
struct Cone {
    float inner, width;
    float full_share() const { return (1.0f - inner) / (1.0f - inner + width / 3.0f); }
};

Cone cone_of(const Light& light) {
    const float inner = std::cos(glm::radians(light.inner_cone_deg)),
                outer = std::cos(glm::radians(light.outer_cone_deg));
    const float width = std::max(inner - outer, 1.0e-4f);
    return {outer + width, width};
}

Particle started(const Light& light, const Box3& bounds, std::uint64_t seed, std::uint32_t particle) {
    const float u = random_unit(seed, particle, 1), v = random_unit(seed, particle, 2),
                w = random_unit(seed, particle, 3);
    Particle start{light.position, light.direction, light_flux(light, bounds)};
    switch (light.kind) {
        case LightKind::point:
            start.direction = sphere_direction(u, v);
            break;
        case LightKind::spot: {
            // Within the full cone evenly; in the rest by the integral of the squared falloff.
            const Cone cone = cone_of(light);
            const float cosine = w < cone.full_share() ? cone.inner + u * (1.0f - cone.inner)
                                                       : cone.inner - cone.width * (1.0f - std::cbrt(u));
            start.direction = about(light.direction, cosine, v);
            break;
        }
        case LightKind::directional: {
            const auto [first, second] = across(light.direction);
            const float radius = 0.5f * bounds.diagonal(), out = radius * std::sqrt(u), turn = 2.0f * pi * v;
            start.origin = bounds.centre() - 2.0f * radius * light.direction +
                           out * (std::cos(turn) * first + std::sin(turn) * second);
            break;
        }
        case LightKind::surface:
            start.direction = about(light.direction, std::sqrt(u), v);
            break;
    }
    return start;
}

struct Emission {
    const Scene& scene;
    const EmbreeScene& embree;
    std::span<const Light> primary;
    std::vector<double> power_up_to;  ///< [primary], W; the last is the total
    std::uint64_t seed;

    /// How far a light stands off its patch: as far as the middle between it and what lies before it, at most.
    float lift_over(vec3 place, vec3 normal) const {
        const float lift_m = virtual_light_lift * scene.bounds.diagonal();
        const auto before = closest_hit(embree, place, normal, 2.0f * lift_m);
        return before ? 0.5f * before->distance_m : lift_m;
    }

    /// The lights that one particle leaves, as if it were the only one.
    void follow(std::uint32_t number, std::vector<Light>& left) const {
        const double total = power_up_to.back(), at = total * static_cast<double>(random_unit(seed, number, 0));
        const auto index =
            std::min(static_cast<std::size_t>(std::ranges::upper_bound(power_up_to, at) - power_up_to.begin()),
                     primary.size() - 1);
        const double chance = (power_up_to[index] - (index > 0 ? power_up_to[index - 1] : 0.0)) / total;
        if (!(chance > 0.0)) return;
        Particle particle = started(primary[index], scene.bounds, seed, number);
        particle.flux *= static_cast<float>(1.0 / chance);
        for (std::uint32_t bounce = 0; bounce < most_bounces; ++bounce) {
            const auto hit =
                closest_hit(embree, particle.origin, particle.direction, std::numeric_limits<float>::infinity());
            if (!hit) return;
            const uvec3 corners = scene.triangles[hit->triangle];
            const vec3 a = scene.positions[corners.x];
            vec3 normal = glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a);
            const float length = glm::length(normal);
            if (!(length > 0.0f)) return;
            normal /= glm::dot(normal, particle.direction) > 0.0f ? -length : length;
            const vec3 albedo = diffuse_albedo(scene, hit->triangle, hit->barycentric);
            const float kept = std::max({albedo.r, albedo.g, albedo.b});
            if (!(kept > 0.0f)) return;
            Light patch;
            patch.kind = LightKind::surface;
            const vec3 place = particle.origin + hit->distance_m * particle.direction;
            const vec3 off = place + surface_offset_m(embree) * normal;
            patch.position = place + lift_over(off, normal) * normal;
            patch.direction = normal;
            patch.intensity = particle.flux * albedo / pi;
            left.push_back(patch);
            const std::uint32_t draw = draws_at_start + draws_per_bounce * bounce;
            if (random_unit(seed, number, draw) >= kept) return;
            particle.flux *= albedo / kept;
            particle.origin = off;
            particle.direction =
                about(normal, std::sqrt(random_unit(seed, number, draw + 1)), random_unit(seed, number, draw + 2));
        }
    }
};

}  // namespace

vec3 light_flux(const Light& light, const Box3& bounds) {
    switch (light.kind) {
        case LightKind::point:
            return 4.0f * pi * light.intensity;
        case LightKind::spot: {
            const Cone cone = cone_of(light);
            return 2.0f * pi * (1.0f - cone.inner + cone.width / 3.0f) * light.intensity;
        }
        case LightKind::directional: {
            const float radius = 0.5f * bounds.diagonal();
            return pi * radius * radius * light.intensity;
        }
        case LightKind::surface:
            return pi * light.intensity;
    }
    return vec3(0.0f);
}

std::vector<Light> virtual_lights(const Scene& scene, const EmbreeScene& embree, std::span<const Light> primary,
                                  std::uint32_t count, std::uint64_t seed, int threads, Progress& progress) {
    std::vector<Light> lights;
    Emission emission{scene, embree, primary, {}, seed ^ 0x76706c73u};
    double power = 0.0;
    for (const Light& light : primary) {
        const vec3 flux = light_flux(light, scene.bounds);
        power += static_cast<double>(std::max(flux.r + flux.g + flux.b, 0.0f));
        emission.power_up_to.push_back(power);
    }
    if (count == 0 || !(power > 0.0) || scene.triangles.empty()) return lights;
    const std::int64_t most_particles = static_cast<std::int64_t>(count) * most_particles_per_light;
    progress.begin("following light particles", count);
    std::int64_t followed = 0;
    for (bool full = false; !full && followed < most_particles;) {
        // A batch at a time; its particles are taken in order until one would leave too many lights.
        const std::int64_t batch =
            std::min<std::int64_t>(most_particles - followed, std::max<std::int64_t>(count / 2, 256));
        std::vector<std::vector<Light>> left(static_cast<std::size_t>(batch));
        const std::int64_t tasks = (batch + particles_per_task - 1) / particles_per_task;
        parallel_for(tasks, threads, [&](std::int64_t task) {
            progress.check();
            for (std::int64_t i = task * particles_per_task; i < std::min((task + 1) * particles_per_task, batch); ++i)
                emission.follow(static_cast<std::uint32_t>(followed + i), left[static_cast<std::size_t>(i)]);
        });
        for (const std::vector<Light>& of_particle : left) {
            full = lights.size() + of_particle.size() > count;
            if (full) break;
            lights.insert(lights.end(), of_particle.begin(), of_particle.end());
            ++followed;
            progress.advance(static_cast<std::int64_t>(of_particle.size()));
        }
    }
    const float share = 1.0f / static_cast<float>(std::max<std::int64_t>(followed, 1));
    const float nearest_m =
        1.2f * scene.bounds.diagonal() / std::sqrt(static_cast<float>(std::max<std::size_t>(lights.size(), 1)));
    for (Light& light : lights) {
        light.intensity *= share;
        light.nearest_m = nearest_m;
    }
    return lights;
}

}  // namespace sightlines
