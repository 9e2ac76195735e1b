// The directions of a cell's masks as the view of a ray shows them, and how its point samples are merged into them.
#pragma once

#include "visualizers/ray_picture.h"

namespace sightlines {

/// The directions of both masks (square, of equal size, octahedral) on a sphere about their cell.
std::vector<ValuedPatch> folded(const PictureMap& visible, const PictureMap& occluded, const Box3& cell);

/// The picture after the first `merged` samples (1 to all; clamped): the masks of the latest by itself and of all so
/// far, those directions on the sphere, the samples in space. The made picture has no samples to merge any more.
RayPicture merged_until(const RayPicture& picture, int merged);

}  // namespace sightlines
