// What happens when the X server goes away, or finds fault with a request.
#pragma once

namespace sightlines {

/// Who is told before the process ends because the display is gone. Lives as long as the window.
struct DisplayLost {
    void (*save)(void*) = nullptr;
    void* argument = nullptr;

    /// From now on a lost display calls `save`, writes one line and ends the process with exit code 4, and an error of
    /// the X protocol is no reason to end it. One at a time.
    DisplayLost();
    ~DisplayLost();
    DisplayLost(const DisplayLost&) = delete;
    DisplayLost& operator=(const DisplayLost&) = delete;
};

/// GLFW puts the X library's own handler back, which ends the process, whenever it has looked for errors itself.
void survive_protocol_errors();

}  // namespace sightlines
