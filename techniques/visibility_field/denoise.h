// Noise taken out of a picture of irradiance by a wavelet transform that keeps edges (H. Dammertz et al.: Edge-Avoiding
// A-Trous Wavelet Transform for Fast Global Illumination Filtering. HPG 2010).
#pragma once

#include "techniques/base/image.h"
#include "techniques/scene/surface_buffer.h"

namespace sightlines::visibility_field {

constexpr int most_denoising_passes = 5;

/// Passes of 5 x 5 pixels, twice as far apart in each as in the one before. Neighbours count as far as they lie in the
/// pixel's plane, look the same way and are about as bright. The background is left as it is.
void denoise(const SurfaceBuffer& surfaces, int passes, int threads, ImageRgb& irradiance);

}  // namespace sightlines::visibility_field
