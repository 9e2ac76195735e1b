// A display of the test's own: an Xvfb that lives as long as the object, and what is seen on it. Include it last: the X
// library defines None, Bool, Success and other words as macros.
#pragma once

#include <csignal>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "techniques/base/image.h"

#undef KeyPress  // a number of the X library, a type of ours

namespace sightlines {

/// Whether the server takes pictures from memory that it shares with the program, or through its socket.
enum class PictureTransfer { shared_memory, socket };

/// While it lives, DISPLAY names it. The screen has no window manager: windows open at its upper left corner.
struct Xvfb {
    std::string display;  ///< ":7"
    pid_t process = -1;
    std::optional<std::string> display_before;

    explicit Xvfb(ImageSize screen, int dots_per_inch = 96, PictureTransfer transfer = PictureTransfer::shared_memory) {
        int number[2];
        if (pipe(number) != 0) throw std::runtime_error("no pipe");
        const std::string size = std::to_string(screen.width) + "x" + std::to_string(screen.height) + "x24";
        const std::string number_to = std::to_string(number[1]);
        process = fork();
        if (process == 0) {
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDERR_FILENO);
            const char* const switched = transfer == PictureTransfer::shared_memory ? "+extension" : "-extension";
            execlp("Xvfb", "Xvfb", "-displayfd", number_to.c_str(), "-screen", "0", size.c_str(), "-nolisten", "tcp",
                   "-noreset", switched, "MIT-SHM", nullptr);
            _exit(127);
        }
        close(number[1]);
        display = ":";
        for (char digit = 0; read(number[0], &digit, 1) == 1 && digit != '\n';) display += digit;
        close(number[0]);
        if (display == ":") throw std::runtime_error("Xvfb does not start");
        if (const char* before = std::getenv("DISPLAY")) display_before = before;
        setenv("DISPLAY", display.c_str(), 1);
        set_dots_per_inch(dots_per_inch);
    }
    ~Xvfb() {
        stop();
        if (display_before)
            setenv("DISPLAY", display_before->c_str(), 1);
        else
            unsetenv("DISPLAY");
    }
    Xvfb(const Xvfb&) = delete;
    Xvfb& operator=(const Xvfb&) = delete;

    /// As if the server had crashed.
    void stop() {
        if (process < 0) return;
        kill(process, SIGKILL);
        waitpid(process, nullptr, 0);
        process = -1;
        // What a server that is killed leaves behind.
        unlink(("/tmp/.X" + display.substr(1) + "-lock").c_str());
        unlink(("/tmp/.X11-unix/X" + display.substr(1)).c_str());
    }

    /// Runs `use` with a connection to the server, closed afterwards.
    template <class Use>
    auto with_connection(const Use& use) const {
        ::Display* const connection = XOpenDisplay(display.c_str());
        if (!connection) throw std::runtime_error("Xvfb does not answer");
        struct Closer {
            ::Display* connection;
            ~Closer() { XCloseDisplay(connection); }
        } const closer{connection};
        return use(connection);
    }

    /// As desktops say it, and as GLFW reads it.
    void set_dots_per_inch(int dots_per_inch) const {
        with_connection([&](::Display* connection) {
            const std::string resources = "Xft.dpi:\t" + std::to_string(dots_per_inch) + "\n";
            XChangeProperty(connection, DefaultRootWindow(connection), XA_RESOURCE_MANAGER, XA_STRING, 8,
                            PropModeReplace, reinterpret_cast<const unsigned char*>(resources.data()),
                            static_cast<int>(resources.size()));
        });
    }

    /// The uppermost of the windows on the screen.
    static ::Window top_window(::Display* connection) {
        ::Window root = 0, parent = 0, *children = nullptr, found = 0;
        unsigned count = 0;
        XQueryTree(connection, DefaultRootWindow(connection), &root, &parent, &children, &count);
        for (unsigned child = 0; child < count; ++child) {
            XWindowAttributes attributes{};
            if (XGetWindowAttributes(connection, children[child], &attributes) && attributes.map_state == IsViewable)
                found = children[child];
        }
        if (children) XFree(children);
        return found;
    }

    /// What is on the screen now.
    ImageRgba8 screenshot() const {
        return with_connection([](::Display* connection) {
            const int screen = DefaultScreen(connection);
            ImageRgba8 picture({DisplayWidth(connection, screen), DisplayHeight(connection, screen)});
            XImage* const image =
                XGetImage(connection, RootWindow(connection, screen), 0, 0, static_cast<unsigned>(picture.size.width),
                          static_cast<unsigned>(picture.size.height), AllPlanes, ZPixmap);
            for (int y = 0; y < picture.size.height; ++y)
                for (int x = 0; x < picture.size.width; ++x) {
                    const unsigned long pixel = XGetPixel(image, x, y);
                    picture.at(x, y) = {pixel >> 16 & 255u, pixel >> 8 & 255u, pixel & 255u, 255u};
                }
            XDestroyImage(image);
            return picture;
        });
    }
};

}  // namespace sightlines
