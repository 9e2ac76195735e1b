// What the views inside show of a visibility field.
#pragma once

#include <vector>

#include "app/selection.h"
#include "visualizers/ray_picture.h"

namespace sightlines {

/// The field's cells, by how much of their directions is occluded.
std::vector<ValuedBox> field_cells(const Structure& structure);

/// The cell that is picked (selection.voxel), or else the one that the ray starts in, as the session's view shows it:
/// "ray" both masks, flat and folded; "merging" how its point samples make them; "atlas" its layer in the paper's
/// layout. The rest of the picture must be made.
void add_field(RayPicture& picture, const Session& session, const SelectedRay& ray, const Structure& structure);

}  // namespace sightlines
