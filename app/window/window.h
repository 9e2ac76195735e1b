// The window on the screen: GLFW for the window, Vulkan to draw, Dear ImGui for what is drawn. Knows nothing of
// sessions.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "techniques/base/image.h"
#include "visualizers/view_state.h"

namespace sightlines {

/// Settles how a software driver of Vulkan works in this process so that it can draw. Opening a window does this too; a
/// program that starts other threads before calls it first thing.
void prepare_drivers();

/// An open window. One a process, used by the thread that made it (`wake` may be called from any).
struct Window {
    struct Objects;
    std::unique_ptr<Objects> objects;

    /// Opens a window of `size` design pixels, no larger than the monitor has room for, and makes the ImGui context. To
    /// be called before the process opens a device to compute: software devices settle at their first use how they
    /// work. EnvironmentError, with what to do: no display (it names DISPLAY), no Vulkan driver, no device that can
    /// draw on this display.
    Window(const std::string& title, ImageSize size);
    ~Window();
    Window(Window&&) noexcept;
    Window& operator=(Window&&) noexcept;
};

/// How a frame looks. Changing it makes the fonts again before the next frame.
struct WindowLook {
    Theme theme = Theme::dark;
    float text_scale = 1.0f;  ///< on top of the monitor's content scale

    bool operator==(const WindowLook&) const = default;
};

/// A key that went down, or repeats while it is held.
struct KeyPress {
    int key = 0;  ///< a GLFW_KEY_ value; letters by what is printed on the key ('Z' is Ctrl+Z's on every keyboard)
    bool control = false, shift = false, alt = false;
    bool repeated = false;

    bool operator==(const KeyPress&) const = default;
};

/// What happened since the last frame that ImGui does not tell.
struct WindowEvents {
    bool closing = false;        ///< the user wants to leave
    bool any_input = false;      ///< mouse, keyboard, resize, expose; not `wake`
    std::vector<KeyPress> keys;  ///< in order; those typed into a field too (io.WantTextInput)
    std::vector<std::filesystem::path> dropped_files;
};

/// Waits at most `wait_s` seconds for something to happen, then begins an ImGui frame (ImGui::NewFrame is called).
/// Waits inside while the window is minimised (events still come in). EnvironmentError: device lost, X server gone.
WindowEvents begin_frame(Window& window, const WindowLook& look, double wait_s);

/// Draws what ImGui was given since `begin_frame`, presents it, and returns when the drawing is done.
/// EnvironmentError: device lost, X server gone.
void end_frame(Window& window);

/// Ends a wait of `begin_frame`, from any thread.
void wake(const Window& window);

/// Whether a key (a GLFW_KEY_ value, by its place on the keyboard) is down now.
bool key_held(const Window& window, int key);

/// Pixels for one design pixel: the monitor's content scale times the look's text scale.
float scale(const Window& window);
ImageSize framebuffer_size(const Window& window);
void set_title(Window& window, const std::string& title);
/// The name of the Vulkan device that draws the window.
std::string_view device_name(const Window& window);

/// Called (from wherever the X library notices) before the process ends because the X server went away: saves the
/// session. The process then ends with one line on standard error and exit code 4.
void on_display_lost(Window& window, void (*save)(void*), void* argument);

}  // namespace sightlines
