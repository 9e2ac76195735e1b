#include "app/window/glfw_window.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

constexpr int least_width = 800, least_height = 600;
// A little under a sixtieth, so that a screen of 60 Hz never misses a beat because of it.
constexpr double least_frame_s = 0.0164;

WindowInput& input_of(GLFWwindow* window) { return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window)); }

void note_input(GLFWwindow* window) { input_of(window).events.any_input = true; }

/// Letters by what is printed on the key (GLFW numbers keys by their place), all others by their place.
int key_by_print(int key, int scancode) {
    if (key < GLFW_KEY_A || key > GLFW_KEY_Z) return key;
    const char* const print = glfwGetKeyName(key, scancode);
    if (!print || std::strlen(print) != 1) return key;
    if (*print >= 'a' && *print <= 'z') return GLFW_KEY_A + (*print - 'a');
    return *print >= 'A' && *print <= 'Z' ? *print : key;
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    note_input(window);
    if (action == GLFW_RELEASE || key == GLFW_KEY_UNKNOWN) return;
    input_of(window).events.keys.push_back({.key = key_by_print(key, scancode),
                                            .control = (modifiers & GLFW_MOD_CONTROL) != 0,
                                            .shift = (modifiers & GLFW_MOD_SHIFT) != 0,
                                            .alt = (modifiers & GLFW_MOD_ALT) != 0,
                                            .repeated = action == GLFW_REPEAT});
    input_of(window).key_places.push_back(key);
}

void on_drop(GLFWwindow* window, int count, const char** paths) {
    note_input(window);
    for (int file = 0; file < count; ++file) input_of(window).events.dropped_files.emplace_back(paths[file]);
}

/// Before Dear ImGui installs its own callbacks, which call these.
void install_callbacks(GLFWwindow* window) {
    glfwSetKeyCallback(window, on_key);
    glfwSetDropCallback(window, on_drop);
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned) { note_input(w); });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) { note_input(w); });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int) { note_input(w); });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int, int, int) { note_input(w); });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double) { note_input(w); });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int) { note_input(w); });
    glfwSetWindowIconifyCallback(window, [](GLFWwindow* w, int) { note_input(w); });
    glfwSetWindowRefreshCallback(window, note_input);
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { note_input(w); });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float, float) { note_input(w); });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) {
        note_input(w);
        input_of(w).events.closing = true;
        glfwSetWindowShouldClose(w, GLFW_FALSE);  // whether it closes is for the program to say
    });
}

bool something_happened(WindowInput& input) {
    return input.woken.exchange(false) || input.events.any_input;
}

/// Design pixels as pixels of the first monitor, no more than it has room for.
ImageSize fitting_size(ImageSize size) {
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    if (!monitor) return size;
    float scale_x = 1.0f, scale_y = 1.0f;
    glfwGetMonitorContentScale(monitor, &scale_x, &scale_y);
    int left = 0, top = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitor, &left, &top, &width, &height);
    const auto scaled = [](int length, float scale) {
        return static_cast<int>(std::lround(static_cast<float>(length) * scale));
    };
    return {std::min(scaled(size.width, scale_x), width), std::min(scaled(size.height, scale_y), height)};
}

}  // namespace

GlfwLibrary::GlfwLibrary() {
#ifdef GLFW_PLATFORM_X11
    // GLFW 3.4 on Wayland would count in other units than the framebuffer's pixels.
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (glfwInit()) return;
    const char* const name = std::getenv("DISPLAY");
    const std::string problem =
        name && *name ? "DISPLAY=" + std::string(name) + " cannot be opened" : "DISPLAY is not set";
    throw EnvironmentError("the display", problem + glfw_error_text(),
                           "start it on a desktop, or use a command that needs no display (--help lists them)");
}

GlfwLibrary::~GlfwLibrary() { glfwTerminate(); }

GlfwWindow make_glfw_window(const std::string& title, ImageSize size, WindowInput& input) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_FALSE);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "sightlines");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "sightlines");
    const ImageSize fitting = fitting_size(size);
    const int width = std::max(fitting.width, least_width), height = std::max(fitting.height, least_height);
    GlfwWindow window(glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr));
    if (!window) throw EnvironmentError("the display", "no window can be opened" + glfw_error_text());
    glfwSetWindowSizeLimits(window.get(), least_width, least_height, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window.get(), &input);
    install_callbacks(window.get());
    return window;
}

void wait_for_events(GLFWwindow* window, WindowInput& input, double wait_s, double& next_frame_s) {
    const double end_s = glfwGetTime() + wait_s;
    glfwPollEvents();
    while (!something_happened(input)) {
        const double left_s = end_s - glfwGetTime();
        if (left_s <= 0.0) break;
        glfwWaitEventsTimeout(left_s);
    }
    while (glfwGetWindowAttrib(window, GLFW_ICONIFIED) && !input.events.closing) glfwWaitEvents();
    const double early_s = next_frame_s - glfwGetTime();
    if (early_s > 0.0) {
        std::this_thread::sleep_for(std::chrono::duration<double>(early_s));
        glfwPollEvents();
    }
    next_frame_s = std::max(glfwGetTime(), next_frame_s) + least_frame_s;
}

std::string glfw_error_text() {
    const char* description = nullptr;
    if (glfwGetError(&description) == GLFW_NO_ERROR || !description) return {};
    return " (GLFW: " + std::string(description) + ")";
}

ImageSize framebuffer_size(GLFWwindow* window) {
    ImageSize size{0, 0};
    glfwGetFramebufferSize(window, &size.width, &size.height);
    return size;
}

float content_scale(GLFWwindow* window) {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window, &x, &y);
    // Monitors that say nothing sensible of themselves exist.
    return std::clamp(std::max(x, y), 0.5f, 8.0f);
}

}  // namespace sightlines
