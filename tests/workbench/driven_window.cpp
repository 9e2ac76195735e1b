#include "driven_window.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "app/desk/autosave.h"
#include "tests/window/xvfb.h"  // last: it brings the macros of the X library

namespace sightlines {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto patience = std::chrono::seconds(60);
constexpr auto pause = std::chrono::milliseconds(50);

/// Asks again and again until `done`, or patience is over.
bool wait_until(const std::function<bool()>& done) {
    const auto start = Clock::now();
    while (!done()) {
        if (Clock::now() - start > patience) return false;
        std::this_thread::sleep_for(pause);
    }
    return true;
}

bool has_ended(const DrivenWindow& window) {
    siginfo_t ended{};
    return waitid(P_PID, static_cast<id_t>(window.process), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           ended.si_pid == window.process;
}

ImageRgba8 without_status_bar(ImageRgba8 screen) {
    const Arrangement areas = arrange({}, screen.size, 1.0f);
    screen.size.height = static_cast<int>(areas.status_bar.corner.y);
    screen.pixels.resize(screen.size.pixels());
    return screen;
}

std::size_t different_pixels(const ImageRgba8& a, const ImageRgba8& b) {
    if (a.size != b.size) return std::max(a.pixels.size(), b.pixels.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::ivec4 difference = glm::abs(glm::ivec4(a.pixels[i]) - glm::ivec4(b.pixels[i]));
        different += std::max({difference.r, difference.g, difference.b}) > 24;
    }
    return different;
}

}  // namespace

DrivenWindow::DrivenWindow(const fs::path& folder, const Session& session,
                           const std::vector<std::string>& more_arguments)
    : session_file(folder / "session.json"), errors_file(folder / "errors.txt") {
    if (!fs::exists(session_file)) save_own_session(session_file, session);
    std::vector<std::string> arguments{SIGHTLINES_PROGRAM, "--session", session_file.string()};
    arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string errors = errors_file.string(), state = (folder / "state").string();
    process = fork();
    if (process == 0) {
        const int file = open(errors.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
        setenv("XDG_STATE_HOME", state.c_str(), 1);
        if (dup2(file, STDERR_FILENO) < 0 || chdir(folder.c_str()) != 0) _exit(126);
        execv(argv[0], argv.data());
        _exit(127);
    }
    if (!wait_until([&] {
            return std::system("xdotool search --onlyvisible --class sightlines >/dev/null 2>&1") == 0 ||
                   has_ended(*this);
        }))
        ADD_FAILURE() << "no window appears";
    // Without a window manager the keys go where the mouse is.
    drive("mousemove 5 5");
}

DrivenWindow::~DrivenWindow() {
    if (process < 0) return;
    kill(process, SIGKILL);
    waitpid(process, nullptr, 0);
}

void drive(const std::string& xdotool_arguments) {
    if (std::system(("xdotool " + xdotool_arguments).c_str()) != 0) ADD_FAILURE() << "xdotool " << xdotool_arguments;
}

void click(vec2 at) {
    const std::string position = std::to_string(std::lround(at.x)) + " " + std::to_string(std::lround(at.y));
    drive("mousemove " + position + " sleep 0.15 click 1 sleep 0.15");
}

void drag(vec2 from, vec2 to) {
    const auto text = [](vec2 at) {
        return std::to_string(std::lround(at.x)) + " " + std::to_string(std::lround(at.y));
    };
    std::string path = "mousemove " + text(from) + " sleep 0.15 mousedown 1 sleep 0.15";
    for (int part = 1; part <= 5; ++part)
        path += " mousemove " + text(glm::mix(from, to, static_cast<float>(part) / 5.0f)) + " sleep 0.1";
    drive(path + " mouseup 1 sleep 0.15");
}

Session saved_session(const DrivenWindow& window) { return load_own_session(window.session_file).session; }

bool session_becomes(const DrivenWindow& window, const std::function<bool(const Session&)>& wanted) {
    return wait_until([&] { return wanted(saved_session(window)) || has_ended(window); }) &&
           wanted(saved_session(window));
}

std::optional<int> exit_code(DrivenWindow& window) {
    if (!wait_until([&] { return has_ended(window); })) return std::nullopt;
    int status = 0;
    waitpid(window.process, &status, 0);
    window.process = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string difference_from_golden(const Xvfb& display, const std::string& name) {
    const fs::path golden = fs::path(SIGHTLINES_SOURCE_FOLDER) / "tests/workbench/golden" / (name + ".png");
    const fs::path candidate = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / (name + ".png");
    const bool exists = fs::exists(golden);
    const ImageRgba8 expected = exists ? read_png(golden) : ImageRgba8{};
    std::size_t different = 0;
    ImageRgba8 screen;
    const bool same = wait_until([&] {
        screen = without_status_bar(display.screenshot());
        different = different_pixels(screen, expected);
        return exists && different <= screen.pixels.size() / 100;
    });
    if (same) return {};
    write_png(candidate, screen);
    return std::to_string(different) + " pixels differ from " + golden.string() + "; if " + candidate.string() +
           " is right, put it there";
}

}  // namespace sightlines
