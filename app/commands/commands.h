// One command, one file: each declares its flags to CLI11 and leaves behind what it does.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/session.h"
#include "techniques/base/progress.h"

namespace CLI {
class App;
}

namespace sightlines {

/// What a command has to say once its work is done and its files are written.
struct CommandOutput {
    std::string text;                ///< for standard output
    std::vector<std::string> notes;  ///< worth knowing but no error: one line each on standard error
};

/// What runs after the command line has been read.
struct Command {
    std::function<CommandOutput(Progress&)> work;
    bool quiet = false;  ///< neither a bar nor notes
};

/// Each adds its subcommand to `app`; when that is the one on the command line, parsing fills `chosen`.
void add_list_command(CLI::App& app, Command& chosen);
void add_render_command(CLI::App& app, Command& chosen);
void add_trace_command(CLI::App& app, Command& chosen);
void add_figure_command(CLI::App& app, Command& chosen);
void add_bench_command(CLI::App& app, Command& chosen);
void add_workspace_command(CLI::App& app, Command& chosen);
/// Renders the built-in atrium, a figure and a ray's trace into `out/`, and says which commands to try.
void add_sample_command(CLI::App& app, Command& chosen);

/// The flags of the window, which opens where no command is given: `chosen` is that until a command takes its place.
void add_window_flags(CLI::App& app, Command& chosen);
/// Opens the window with that session; returns when it is closed.
CommandOutput open_workspace(Session session, Progress& progress);

}  // namespace sightlines
