// Indirect light as lights: where light particles meet a surface, the lit patch becomes a light of its own
// (Keller 1997, "Instant radiosity"; Wang 2017, Figure 9).
#pragma once

#include <span>
#include <vector>

#include "techniques/rays/embree_scene.h"

namespace sightlines {

/// How many particles at most are followed for each virtual light that is asked for.
constexpr std::uint32_t most_particles_per_light = 16;

/// How far a virtual light stands off its surface, of the bounds' diagonal: two voxels of a grid of 128, so that a
/// technique that knows surfaces only to a voxel does not take the light's own for a blocker.
constexpr float virtual_light_lift = 2.0f / 128.0f;

/// The flux of a light, W, by channel. A directional light's goes through the disc that holds `bounds`.
vec3 light_flux(const Light& light, const Box3& bounds);

/// At most `count` lights of kind `surface` that stand for the light which `primary` throws on the scene's surfaces and
/// these on each other: particles leave the primary lights in proportion to their power and bounce by the cosine law,
/// each bounce kept with the surface's albedo as probability (Russian roulette); every hit leaves a light that carries
/// what the patch reflects. Fewer than `count` where the scene catches less than one particle in 16. `scene` is the one
/// that `embree` was built from.
///
/// Nearer than nearest_m (1.2 of the bounds' diagonal over the root of the lights' number: about how far apart they
/// are) a light counts as that far away, so that no corner burns out; what that takes away falls as lights are added.
///
/// A function of its arguments: random numbers are hashes of seed, particle and bounce, the same on any number of
/// threads.
std::vector<Light> virtual_lights(const Scene& scene, const EmbreeScene& embree, std::span<const Light> primary,
                                  std::uint32_t count, std::uint64_t seed, int threads, Progress& progress);

}  // namespace sightlines
