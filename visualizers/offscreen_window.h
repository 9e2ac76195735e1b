// VTK without a display: a render window over an EGL surfaceless context (Mesa; llvmpipe where there is no GPU).
// For the .cpp files of this folder only: it shows VTK's types.
#pragma once

#include <vector>

#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include "techniques/base/image.h"

namespace sightlines {

/// A window that draws into its own framebuffer, with its own OpenGL context. It may be made on any thread, and is used
/// by one thread at a time; several live side by side in one process, beside Vulkan and GLFW too. Multisampling is off.
/// Throws EnvironmentError where EGL or OpenGL 3.2 is not available.
vtkSmartPointer<vtkRenderWindow> make_offscreen_window();

/// What was drawn: premultiplied RGBA, and the distance to the camera plane.
struct DrawnPixels {
    ImageRgba8 colour;                 ///< premultiplied by alpha; alpha 0 is the background
    std::vector<float> inverse_depth;  ///< [P] 1 / (distance along the view direction in m); 0 on the background
};

/// Renders the window at `size` (resizing it where it was another) and reads it back. The window holds one renderer
/// with a perspective camera whose clipping range is set.
DrawnPixels draw(vtkRenderWindow& window, ImageSize size);

}  // namespace sightlines
