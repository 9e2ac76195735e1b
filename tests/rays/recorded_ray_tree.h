// The recording compilation of the ray tree's traversal, in a unit of its own.
#pragma once

#include <vector>

#include "shaders/trace.h"
#include "techniques/rays/ray_tree.h"

namespace sightlines::test {

struct RecordedTreeRay {
    bool blocked = false;
    std::vector<TraceStep> steps;
};
RecordedTreeRay recorded_tree_ray(const RayTree& tree, vec3 origin, vec3 direction);

}  // namespace sightlines::test
