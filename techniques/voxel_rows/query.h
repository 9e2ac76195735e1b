// Asking the array: one ray through the scalar kernel, many through the wide one, whole pictures by either backend.
#pragma once

#include <span>

#include "techniques/rays/reference.h"
#include "techniques/technique.h"
#include "techniques/voxel_rows/object_rows.h"
#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

/// The array's shape with the query's parameters (offsets, subrays) and what the lights ask for.
RowShape make_query(const RowArray& array, const ParameterValues& parameters, std::span<const Light> lights);

/// Algorithm 3 by the scalar kernel. The segment starts on the surface with this normal; the normal offset is applied.
bool is_blocked(const RowArray& array, const RowShape& query, const Segment& segment, vec3 normal);

/// Algorithm 5, lines 4 to 10, by the scalar kernel: whether any of the objects is in the way.
bool is_blocked(std::span<const ObjectInstance> objects, const Segment& segment, vec3 normal);

/// Algorithm 3 for many rays at once by the wide kernel. answers[k] is 0 or 1. Sizes are
/// equal.
void are_blocked(const RowArray& array, const RowShape& query, std::span<const Segment> segments,
                 std::span<const vec3> normals, std::span<std::uint8_t> answers);

/// Algorithm 4 on the CPU, by the wide kernel; where there are objects, each ray by Algorithm 5.
RenderResult render_on_cpu(const RowArray& array, const RenderRequest& request, Progress& progress,
                           const Objects& objects = {});

/// Only asks and counts, as the benchmark does.
QueryCount count_blocked_on_cpu(const RowArray& array, const RenderRequest& request, const Objects& objects = {});

}  // namespace sightlines::voxel_rows
