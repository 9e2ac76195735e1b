// What the tests of the window share: frames, and pixels to compare.
#pragma once

#include <chrono>
#include <ostream>
#include <thread>

#include <gtest/gtest.h>

#include "app/window/style.h"
#include "app/window/texture.h"
#include "xvfb.h"

namespace glm {
inline std::ostream& operator<<(std::ostream& stream, u8vec4 colour) {
    return stream << int(colour.r) << ' ' << int(colour.g) << ' ' << int(colour.b) << ' ' << int(colour.a);
}
}  // namespace glm

namespace sightlines {

/// ImGui's packed colour as a pixel, opaque.
inline glm::u8vec4 pixel(ImU32 colour) {
    return {colour >> IM_COL32_R_SHIFT & 255u, colour >> IM_COL32_G_SHIFT & 255u, colour >> IM_COL32_B_SHIFT & 255u,
            255u};
}

template <class Draw>
void show_frame(Window& window, const WindowLook& look, const Draw& draw) {
    begin_frame(window, look, 0.0);
    draw(*ImGui::GetForegroundDrawList());
    end_frame(window);
}

/// Draws frames until the screen is as `is_as_wanted(picture)` says, at most some seconds: the X server takes its time
/// to show a frame. The last picture seen.
template <class Draw, class Wanted>
ImageRgba8 show_until(const Xvfb& server, Window& window, const WindowLook& look, const Draw& draw,
                      const Wanted& is_as_wanted) {
    ImageRgba8 picture;
    for (int attempt = 0; attempt < 200; ++attempt) {
        show_frame(window, look, draw);
        picture = server.screenshot();
        if (is_as_wanted(picture)) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return picture;
}

}  // namespace sightlines
