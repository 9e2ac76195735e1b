// The body of voxel_rows_first_hit*.comp: one invocation a ray.

#include "voxel_rows_first_hit.h"
#include "voxel_rows_first_hit_data.h"

layout(local_size_x = 64) in;

// Known when the pipeline is made, so that loops unroll and what is not asked for costs nothing.
layout(constant_id = 0) const int resolution = 128;
layout(constant_id = 1) const int words_per_row = 4;
layout(constant_id = 6) const int index_bits = 0;
layout(constant_id = 7) const int index_start = 0;

layout(push_constant, scalar) uniform Push { FirstHitJob job; };

void main() {
    const uint k = gl_GlobalInvocationID.x;
    if (k >= job.rays) return;
    RowShape query = job.query;
    query.resolution = resolution;
    query.words_per_row = words_per_row;
    query.index_bits = index_bits;
    query.index_start = index_start;
    const HitRay ray = job.asked.v[k];
    const vec3 origin = ray_origin(query, ray.position, ray.normal);
    const RowHit found = first_hit(query, job.frames, job.rows, origin, ray.target);
    job.shares.v[k] = found.hit ? found.share : -1.0f;
}
