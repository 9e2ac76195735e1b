// Long work on a terminal: Ctrl-C stops it cleanly, a bar shows how far it is.
#pragma once

#include <functional>

#include "techniques/base/progress.h"

namespace sightlines {

/// From now on SIGINT and SIGTERM reach only `run_watched`, on whichever thread. To be called first thing in main,
/// before any other thread exists (they inherit it).
void hold_stop_signals();

/// Runs `work` on this thread. A second thread cancels its progress when a stop signal comes (a second one ends the
/// process at once), and draws a progress bar on standard error where `show_bar`. Passes on what `work` throws.
void run_watched(const std::function<void(Progress&)>& work, bool show_bar);

}  // namespace sightlines
