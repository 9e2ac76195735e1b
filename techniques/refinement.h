// How a picture is made piece by piece: coarse first, then finer, so that something shows at once.
#pragma once

#include <vector>

#include "techniques/technique.h"

namespace sightlines {

/// A pass over the picture: takes the pixels whose x and y are multiples of `stride`, but not those of an earlier pass
/// (both multiples of `skip_stride`; 0: nothing was taken before).
struct RefinementPass {
    int stride = 1, skip_stride = 0;
};

/// Every 4th pixel, every 2nd, all; or all at once where nobody watches.
std::vector<RefinementPass> refinement_passes(bool watched);

/// A result of the request's size: the background's black, nothing asked; verdicts where the request wants them.
/// InputError where the verdicts would not fit into memory.
RenderResult blank_result(const RenderRequest& request);

/// After a coarse pass: each computed pixel of `rect` fills the stride x stride block right of and below it, except
/// where that shows the background.
void fill_blocks(RenderResult& result, const SurfaceBuffer& surfaces, PixelRect rect, int stride);

/// Sets `rays` to the sum over all pixels.
void count_rays(RenderResult& result);

}  // namespace sightlines
