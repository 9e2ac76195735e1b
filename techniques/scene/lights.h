// Many lights: seeded, spread, coloured, each on a path of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/scene/scene.h"

namespace sightlines {

enum class LightPlacement { volume, sphere };

/// A light that was put somewhere else by hand.
struct MovedLight {
    std::uint32_t light = 0;
    vec3 position{0.0f};  ///< m

    bool operator==(const MovedLight&) const = default;
};

/// Which lights illuminate a scene: the scene's own, or `count` seeded point lights.
struct LightChoice {
    std::uint32_t count = 0;  ///< 0: the scene's own lights (a default light where it has none)
    LightPlacement placement = LightPlacement::volume;
    bool moving = false;               ///< each light goes round its own small loop with time
    bool coloured = true;              ///< hues vary; off: all white
    float brightness = 1.0f;           ///< multiplies the automatic total intensity
    std::vector<MovedLight> moved;     ///< in any order; those that do not exist are passed over
    std::uint32_t virtual_lights = 0;  ///< at most so many more, where the light of these falls: one bounce and further

    bool operator==(const LightChoice&) const = default;
};

/// The lights for `scene` at its time, without the virtual ones (techniques/rays/virtual_lights.h). Seeded lights are a
/// pure function of (choice, seed, scene's light volume, time): light k does not depend on how many there are. Point
/// lights are spread uniformly through `scene.light_volume`, or uniformly over a sphere about the bounds; their summed
/// intensity makes a mean surface near middle grey, so that the exposure does not depend on the number. Deterministic;
/// InputError above 65,536 lights.
std::vector<Light> make_lights(const Scene& scene, const LightChoice& choice, std::uint64_t seed);

}  // namespace sightlines
