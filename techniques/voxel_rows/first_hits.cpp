#include <algorithm>
#include <limits>

#include "shaders/wide.h"  // first: makes the kernels below wide

#include "shaders/voxel_rows_first_hit.h"
#include "techniques/voxel_rows/first_hits.h"

namespace sightlines::voxel_rows {

namespace wide = wide_kernel;

void first_hits(const RowArray& array, const RowShape& query, std::span<const Segment> segments,
                std::span<const vec3> normals, std::span<float> distances_m) {
    constexpr std::size_t lanes = wide::lanes;
    const wide::FrameTable frames{array.grid.frames.data()};
    const wide::Rows rows{array.words.words.data()};
    for (std::size_t start = 0; start < segments.size(); start += lanes) {
        const std::size_t count = std::min(lanes, segments.size() - start);
        alignas(64) float numbers[9][lanes];
        for (std::size_t lane = 0; lane < lanes; ++lane) {  // idle lanes repeat the last ray
            const std::size_t k = start + std::min(lane, count - 1);
            for (int axis = 0; axis < 3; ++axis) {
                numbers[axis][lane] = segments[k].origin[axis];
                numbers[3 + axis][lane] = segments[k].target[axis];
                numbers[6 + axis][lane] = normals[k][axis];
            }
        }
        const auto three = [&](int k) {
            return wide::Vec3{wide::load(numbers[k]), wide::load(numbers[k + 1]), wide::load(numbers[k + 2])};
        };
        const wide::Vec3 origin = wide::ray_origin(query, three(0), three(6));
        const wide::RowHit found = wide::first_hit(query, frames, rows, origin, three(3));
        alignas(64) float shares[lanes];
        wide::store(found.share, shares);
        const std::uint32_t hit = wide::bits_of(found.hit);
        for (std::size_t lane = 0; lane < count; ++lane) {
            const Segment& segment = segments[start + lane];
            distances_m[start + lane] = (hit >> lane & 1u) != 0
                                            ? shares[lane] * glm::distance(segment.origin, segment.target)
                                            : std::numeric_limits<float>::infinity();
        }
    }
}

}  // namespace sightlines::voxel_rows
