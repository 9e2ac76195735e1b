// Boxes of a recorded trace: of cells, voxels, rows, objects.
#pragma once

#include <string>
#include <utility>

#include "shaders/trace.h"
#include "techniques/base/types.h"

namespace sightlines {

/// What lies between `low` and `high` of an own frame (voxels of a grid, an object), as a box in the world, m.
inline TraceGeometry box_geometry(std::string name, const mat4& world_from_own, vec3 low, vec3 high) {
    const mat3 axes(world_from_own);
    const vec3 size = high - low;
    return {std::move(name),
            TraceShape::box,
            {vec3(world_from_own * vec4(low, 1.0f)), axes[0] * size.x, axes[1] * size.y, axes[2] * size.z}};
}

/// A box along the world's axes.
inline TraceGeometry box_geometry(std::string name, const Box3& box) {
    return box_geometry(std::move(name), mat4(1.0f), box.lowest, box.highest);
}

}  // namespace sightlines
