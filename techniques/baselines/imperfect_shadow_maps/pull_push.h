// Filling the holes of a map of distances from coarser and coarser copies of it (Ritschel 2008; the pull and push of
// Marroquim 2007).
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace sightlines::baselines {

constexpr float hole = std::numeric_limits<float>::infinity();

/// The coarser copies' memory, kept from one map to the next.
struct PullPushScratch {
    std::vector<std::vector<float>> levels;
};

/// `distances`: [resolution * pitch], `hole` where nothing was drawn. Pull: a texel of the next copy is the mean of
/// those of its four that are at most `tolerance` (a share, doubled from copy to copy) farther than the nearest of
/// them. Push: a hole becomes the mean of the coarser texels around it, weighted as bilinear interpolation does, again
/// of those within the tolerance of the nearest. `levels` copies are made: holes wider than 2^levels texels stay.
void fill_holes(std::span<float> distances, int resolution, int pitch, int levels, float tolerance,
                PullPushScratch& scratch);

}  // namespace sightlines::baselines
