// The real window on a display of its own, driven by mouse and keys (xdotool) as a user would, and watched through its
// saved session and what is on the screen.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "app/session.h"
#include "app/workbench/layout.h"

namespace sightlines {

struct Xvfb;

/// The program with its window, started with `session` and killed with the object if it still runs. The display must
/// live longer.
struct DrivenWindow {
    std::filesystem::path session_file, errors_file;
    pid_t process = -1;

    /// Writes the session to `folder`/session.json first, unless it is there.
    DrivenWindow(const std::filesystem::path& folder, const Session& session,
                 const std::vector<std::string>& more_arguments = {});
    ~DrivenWindow();
    DrivenWindow(const DrivenWindow&) = delete;
    DrivenWindow& operator=(const DrivenWindow&) = delete;
};

/// "mousemove 10 20 click 1"
void drive(const std::string& xdotool_arguments);
void click(vec2 at);
void drag(vec2 from, vec2 to);

/// The session as it is on disk.
Session saved_session(const DrivenWindow& window);
/// Waits until the saved session is as `wanted`; false after a minute, or when the program has ended.
bool session_becomes(const DrivenWindow& window, const std::function<bool(const Session&)>& wanted);
/// Waits for the end of the program; its exit code, negative: the signal that ended it; nothing after a minute.
std::optional<int> exit_code(DrivenWindow& window);

/// Waits until the screen above the status bar (which tells times) is as tests/workbench/golden/`name`.png, but for one
/// pixel in a hundred. After a minute: why not, and where the candidate was written; else empty.
std::string difference_from_golden(const Xvfb& display, const std::string& name);

}  // namespace sightlines
