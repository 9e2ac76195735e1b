// The wide compilation of the octahedral map, for tests that compare it with the scalar one.
#pragma once

#include <span>
#include <vector>

#include "techniques/base/types.h"

namespace sightlines::visibility_field::testing {

/// row * size + column of each direction's texel.
std::vector<int> wide_texels(std::span<const vec3> directions, int size);

}  // namespace sightlines::visibility_field::testing
