// What a field takes, told before anything is allocated.
#pragma once

#include <cstdint>
#include <string>

#include "techniques/base/types.h"

namespace sightlines::visibility_field {

struct BakeOptions;

/// "2.4 MB"
std::string memory_text(double bytes);

/// What a bake takes at its peak, bytes, at most: bricks, samples, the parts of triangles in cells, and masks.
/// `area_m2` and `triangles` are those of the scene.
double bake_bytes(const Box3& bounds, double area_m2, std::size_t triangles, const BakeOptions& options);

/// EnvironmentError where a bake takes more than `available_bytes`: says what it would take, and which larger cells
/// would fit.
void require_memory(const Box3& bounds, double area_m2, std::size_t triangles, const BakeOptions& options,
                    std::uint64_t available_bytes);

}  // namespace sightlines::visibility_field
