#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/desk/autosave.h"
#include "app/workbench/workbench.h"

namespace sightlines {
namespace {

struct WindowFlags {
    std::filesystem::path session, frame_log;
};

CommandOutput open_window(const WindowFlags& flags, Progress& progress) {
    WorkbenchRequest request;
    request.session_file = flags.session.empty() ? state_folder() / "session.json" : flags.session;
    request.frame_log = flags.frame_log;
    request.session = first_session();
    if (std::filesystem::exists(request.session_file)) {
        OwnSession saved = load_own_session(request.session_file);
        if (saved.message.empty())
            request.session = std::move(saved.session);
        else
            request.message = saved.message;
    }
    run_workbench(request, progress);
    return {};
}

}  // namespace

void add_window_flags(CLI::App& app, Command& chosen) {
    const auto flags = std::make_shared<WindowFlags>();
    app.add_option("--session", flags->session,
                   "The session that the window opens, and saves as it changes (default: the last one)")
        ->type_name("FILE.json");
    app.add_option("--frame-log", flags->frame_log, "Write a line for each frame of the window")->type_name("FILE.csv");
    chosen = {[flags](Progress& progress) { return open_window(*flags, progress); }, true};
}

CommandOutput open_workspace(Session session, Progress& progress) {
    run_workbench({std::move(session), state_folder() / "session.json", {}, {}}, progress);
    return {};
}

}  // namespace sightlines
