#include "shaders/recording.h"  // first: makes the kernel below record

#include "shaders/ray_tree.h"
#include "tests/rays/recorded_ray_tree.h"

namespace sightlines::test {

RecordedTreeRay recorded_tree_ray(const RayTree& tree, vec3 origin, vec3 direction) {
    recording_kernel::Recording recording;
    const bool blocked = recording_kernel::is_blocked_by_tree(
        {{tree.nodes.data()}, {tree.triangles.data()}, {tree.cutouts.data()}, tree.node_count()}, origin, direction);
    return {blocked, std::move(recording.steps)};
}

}  // namespace sightlines::test
