// Where rays first hit the array's voxels (Wang 2017, section 7: future work).
#pragma once

#include "techniques/voxel_rows/row_array.h"

namespace sightlines::voxel_rows {

/// The distance from each segment's origin to the first set voxel of the row that serves it, m; infinity where there is
/// none. Segments start on surfaces with these normals; the query's offsets apply. Sizes are equal. By the wide kernel.
void first_hits(const RowArray& array, const RowShape& query, std::span<const Segment> segments,
                std::span<const vec3> normals, std::span<float> distances_m);

/// The same for one ray by the scalar kernel.
float first_hit(const RowArray& array, const RowShape& query, const Segment& segment, vec3 normal);

}  // namespace sightlines::voxel_rows
