#include "app/window/display_lost.h"

#include <cassert>
#include <cstdio>
#include <utility>

#include <X11/Xlib.h>
#include <unistd.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

// The X library calls a plain function without an argument of ours, so what that function needs has to be found from
// here: the one place where the program cannot do without a variable of its own.
DisplayLost* current = nullptr;

int on_display_gone(Display*) {
    bool saved = false;
    try {
        if (const auto save = current ? std::exchange(current->save, nullptr) : nullptr) {
            save(current->argument);
            saved = true;
        }
    } catch (...) {
        saved = false;  // the line below then promises nothing
    }
    std::fputs(
        saved ? "sightlines: the display was closed (the session is saved)\n" : "sightlines: the display was closed\n",
        stderr);
    // Not exit(): destructors would talk to the display that is gone.
    _exit(static_cast<int>(ExitCode::environment));
}

int on_protocol_error(Display*, XErrorEvent*) { return 0; }

}  // namespace

DisplayLost::DisplayLost() {
    assert(current == nullptr);
    current = this;
    XSetIOErrorHandler(on_display_gone);
    survive_protocol_errors();
}

DisplayLost::~DisplayLost() {
    XSetIOErrorHandler(nullptr);
    XSetErrorHandler(nullptr);
    current = nullptr;
}

void survive_protocol_errors() { XSetErrorHandler(on_protocol_error); }

}  // namespace sightlines
