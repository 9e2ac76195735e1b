// The workbench: the window, from start to end.
#pragma once

#include <filesystem>
#include <optional>

#include "app/session.h"
#include "techniques/base/progress.h"

namespace sightlines {

struct WorkbenchRequest {
    Session session;
    std::filesystem::path session_file;  ///< where the session is saved as it changes
    std::filesystem::path frame_log;     ///< CSV, one line a frame; empty: none
    std::optional<std::string> message;  ///< to be shown at the start
};

/// The session of a first start: the atrium under 1,024 lights, the picture as large as its pane.
Session first_session();

/// Opens the window and returns when the user leaves it, or when `stop` is cancelled. The session is saved by then.
/// EnvironmentError: no display, no Vulkan, device lost.
void run_workbench(const WorkbenchRequest& request, const Progress& stop);

}  // namespace sightlines
