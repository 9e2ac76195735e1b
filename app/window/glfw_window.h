// GLFW: the library, one window, and what happens to it.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>

#include "app/window/window.h"

namespace sightlines {

/// GLFW itself, from start to end. EnvironmentError: no display; names DISPLAY.
struct GlfwLibrary {
    GlfwLibrary();
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

struct GlfwWindowDeleter {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using GlfwWindow = std::unique_ptr<GLFWwindow, GlfwWindowDeleter>;

/// What GLFW's callbacks note down between two frames. The window points to it: it may not move.
struct WindowInput {
    WindowEvents events;
    std::vector<int> key_places;  ///< of `events.keys`, as GLFW and Dear ImGui number them: by their place
    std::atomic<bool> woken = false;
};

/// A resizable window without OpenGL whose events go to `input`. EnvironmentError where it cannot be made.
GlfwWindow make_glfw_window(const std::string& title, ImageSize size, WindowInput& input);

/// Waits at most `wait_s` for something to happen; as long as it takes while the window is minimised. Frames begin at
/// most sixty times a second: waits for `next_frame_s` too, in glfwGetTime's seconds, and moves it on.
void wait_for_events(GLFWwindow* window, WindowInput& input, double wait_s, double& next_frame_s);

/// " (GLFW: ...)" with GLFW's own words for its last error; empty where there was none.
std::string glfw_error_text();

ImageSize framebuffer_size(GLFWwindow* window);
float content_scale(GLFWwindow* window);

}  // namespace sightlines
