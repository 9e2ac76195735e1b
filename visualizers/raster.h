// Finishing a drawn picture: outlines where depth jumps, fewer pixels, straight alpha.
#pragma once

#include "visualizers/offscreen_window.h"

namespace sightlines {

/// Inks silhouettes: where the surface behind is further away than `jump_m`, in `ink`, at most `strength` of it.
/// Planes never ink, however steep: 1/z is affine on them.
void ink_outlines(DrawnPixels& drawn, float jump_m, vec3 ink, float strength);

/// Averages blocks of `samples_per_axis` squared, premultiplied in, straight alpha out.
ImageRgba8 reduced(const ImageRgba8& premultiplied, int samples_per_axis);

/// `picture` (straight alpha) over an opaque colour, sRGB in [0, 1].
ImageRgba8 over_page(const ImageRgba8& picture, vec3 page);

}  // namespace sightlines
