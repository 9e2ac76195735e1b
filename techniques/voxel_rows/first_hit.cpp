#include <limits>

#include "shaders/voxel_rows_first_hit.h"
#include "techniques/voxel_rows/first_hits.h"

namespace sightlines::voxel_rows {

float first_hit(const RowArray& array, const RowShape& query, const Segment& segment, vec3 normal) {
    const vec3 origin = scalar_kernel::ray_origin(query, segment.origin, normal);
    const scalar_kernel::RowHit found =
        scalar_kernel::first_hit(query, {array.grid.frames.data()}, {array.words.words.data()}, origin, segment.target);
    return found.hit ? found.share * glm::distance(segment.origin, segment.target)
                     : std::numeric_limits<float>::infinity();
}

}  // namespace sightlines::voxel_rows
