// The mathematical vocabulary that every part shares: GLM's vectors and matrices, and an axis-aligned box.
// Lengths are metres, the frame is right-handed with +Y up; matrices are column-major and named `to_from`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

namespace sightlines {

using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using glm::ivec3;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// An axis-aligned box; `empty()` until the first point has been added.
struct Box3 {
    vec3 lowest{std::numeric_limits<float>::infinity()};
    vec3 highest{-std::numeric_limits<float>::infinity()};

    bool operator==(const Box3&) const = default;
    bool empty() const { return !(lowest.x <= highest.x && lowest.y <= highest.y && lowest.z <= highest.z); }
    vec3 size() const { return empty() ? vec3(0.0f) : highest - lowest; }
    vec3 centre() const { return empty() ? vec3(0.0f) : 0.5f * (lowest + highest); }
    float diagonal() const { return glm::length(size()); }
    void add(vec3 point) {
        lowest = glm::min(lowest, point);
        highest = glm::max(highest, point);
    }
};

struct ImageSize {
    int width = 1280;
    int height = 720;

    bool operator==(const ImageSize&) const = default;
    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

}  // namespace sightlines
