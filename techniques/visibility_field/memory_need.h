// What a field takes, told before anything is allocated.
#pragma once

#include <cstdint>
#include <string>

#include "techniques/base/types.h"
#include "techniques/scene/scene.h"

namespace sightlines::visibility_field {

struct BakeOptions;

/// "2.4 MB"
std::string memory_text(double bytes);

/// What the need for memory depends on.
struct SurfaceExtent {
    Box3 bounds;           ///< at all times
    double area_m2 = 0.0;  ///< of the sides that are sampled
    std::size_t triangles = 0;
    bool moves = false;  ///< then what stands still is kept, with the answers to its rays
};

/// What a bake takes at its peak, bytes, at most: Embree's trees, bricks, samples, the parts of triangles in cells,
/// masks.
double bake_bytes(const SurfaceExtent& surface, const BakeOptions& options);

/// EnvironmentError where a bake takes more than `available_bytes`: says what it would take, and which larger cells
/// would fit.
void require_memory(const SurfaceExtent& surface, const BakeOptions& options, std::uint64_t available_bytes);
void require_memory(const Scene& scene, const BakeOptions& options, std::uint64_t available_bytes);

}  // namespace sightlines::visibility_field
