#include "app/watch.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <string>
#include <thread>

#include <unistd.h>

namespace sightlines {
namespace {

constexpr int bar_width = 30;
constexpr auto bar_delay = std::chrono::milliseconds(500);

sigset_t stop_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

void draw_bar(const Progress& progress) {
    const std::string stage = progress.stage();
    if (stage.empty()) return;
    const double fraction = std::fmin(1.0, std::fmax(0.0, progress.fraction()));
    const int full = static_cast<int>(fraction * bar_width);
    std::string bar(static_cast<std::size_t>(full), '=');
    bar.resize(bar_width, ' ');
    std::fprintf(stderr, "\r\033[K  [%s] %3d %%  %s", bar.c_str(), static_cast<int>(100.0 * fraction), stage.c_str());
    std::fflush(stderr);
}

void watch(const std::stop_token& stop, Progress& progress, bool show_bar) {
    const sigset_t signals = stop_signals();
    const timespec pause{0, 50'000'000};
    const auto start = std::chrono::steady_clock::now();
    bool drawn = false;
    while (!stop.stop_requested()) {
        if (sigtimedwait(&signals, nullptr, &pause) > 0) {
            if (progress.cancelled()) _exit(static_cast<int>(ExitCode::cancelled));
            progress.cancel();
        }
        if (!show_bar || std::chrono::steady_clock::now() - start < bar_delay) continue;
        draw_bar(progress);
        drawn = true;
    }
    if (drawn) std::fputs("\r\033[K", stderr);
}

}  // namespace

void hold_stop_signals() {
    const sigset_t signals = stop_signals();
    // A shell may have started us with SIGINT ignored (in the background); a signal that is sent all the same counts.
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

void run_watched(const std::function<void(Progress&)>& work, bool show_bar) {
    Progress progress;
    const std::jthread watcher([&](const std::stop_token& stop) { watch(stop, progress, show_bar); });
    work(progress);
}

}  // namespace sightlines
