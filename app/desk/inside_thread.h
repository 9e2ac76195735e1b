// Draws the view inside on a thread of its own (VTK has its own OpenGL context there); the window shows the newest.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "visualizers/inside_view.h"

namespace sightlines {

/// One view to draw. Equal requests give equal pixels.
struct InsideRequest {
    std::shared_ptr<const InsidePicture> picture;
    ViewState state;
    LitGeometry lit;
    ImageSize size;  ///< of the pane, in the window's pixels
    float text_scale = 1.0f;

    bool operator==(const InsideRequest&) const = default;
};

struct InsideShown {
    InsideRequest request;  ///< that was drawn
    ImageRgba8 pixels;      ///< [request.size]
    OrbitCamera camera;     ///< in force
    int samples_per_axis;   ///< 1 while something moves, 2 at rest
    double seconds = 0.0;   ///< that drawing took
};

/// Draws the newest request: at once with one sample a pixel, then again with four when it rests. Where only the marks
/// change (a step, what is pointed at), the sharp picture stays and they are drawn anew.
struct InsideThread {
    struct Objects;
    std::unique_ptr<Objects> objects;

    /// `changed` is called from the thread when there is something new to show. Starts OpenGL on the thread: a failure
    /// is told by `failure`.
    explicit InsideThread(std::function<void()> changed);
    ~InsideThread();
    InsideThread(InsideThread&&) noexcept;
    InsideThread& operator=(InsideThread&&) noexcept;
};

/// Cheap when the request equals the last one.
void draw(InsideThread& thread, const InsideRequest& request);
/// The newest drawn view, or null.
std::shared_ptr<const InsideShown> shown(const InsideThread& thread);
/// Why nothing can be drawn ("OpenGL 3.2 is not available"), or empty.
std::string failure(const InsideThread& thread);

}  // namespace sightlines
