// Where to stand in a scene whose file does not say.
#pragma once

#include <vector>

#include "techniques/scene/scene.h"

namespace sightlines {

/// Cameras for `scene`, of which only the triangles and the bounds are read. An object: `outside`, which shows all of
/// it. A room, or a court that is open above: first `inside`, which looks along it from one end, then `outside`.
/// A scene is a room where from its middle most horizontal and downward lines meet the front of a triangle: a closed
/// object shows its triangles' backs from there. Every triangle is read a few times: about 20 ms for 260,000 of them.
std::vector<Camera> automatic_cameras(const Scene& scene);

}  // namespace sightlines
