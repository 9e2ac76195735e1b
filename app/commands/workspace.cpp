#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/commands/figure.h"
#include "app/commands/flags.h"
#include "app/commands/render.h"

namespace sightlines {
namespace {

struct WorkspaceFlags {
    std::vector<std::filesystem::path> files;
    SessionFlags session;
    RenderOutputs outputs;
    FigureFlags figure;
    CommonFlags common;
};

/// The first file, changed by the others in turn, then by the flags.
Session opened_session(const WorkspaceFlags& flags) {
    Session session;
    for (const auto& file : flags.files) {
        Json json = read_json(file);
        // A scene named on the command line stands in for the one in the files, wherever that lies.
        if (json.is_object() && !flags.session.scene.empty()) json.erase("scene");
        session = patched(session, with_paths_in(std::move(json), file.parent_path(), file.string()), file.string());
    }
    return session_with_flags(std::move(session), flags.session);
}

CommandOutput run_workspace(const WorkspaceFlags& flags, Progress& progress) {
    const Session session = opened_session(flags);
    Results results(thread_flag(flags.common), command_backend(session));
    if (!flags.figure.name.empty() && flags.figure.folder.empty())
        throw InputError("--figure", "", "needs a folder to write into", "give --out FOLDER");
    if (!flags.figure.name.empty()) return figure_to_files(session, flags.figure, results, flags.common, progress);
    if (!flags.outputs.picture.empty()) return render_to_files(session, flags.outputs, results, flags.common, progress);
    return open_workspace(session, progress);
}

}  // namespace

void add_workspace_command(CLI::App& app, Command& chosen) {
    CLI::App& command =
        *app.add_subcommand("workspace", "Open a saved session in the window, render it, or make a figure of it");
    const auto flags = std::make_shared<WorkspaceFlags>();
    command
        .add_option("files", flags->files, "A session as JSON; further files change it, each a merge patch (RFC 7386)")
        ->required()
        ->type_name("FILE.json ...");
    CLI::Option* render =
        command.add_option("--render", flags->outputs.picture, "The picture to write: .png or .hdr")->type_name("FILE");
    add_figure_flags(command, flags->figure);
    command.add_option("--out", flags->figure.folder, "The folder that a figure is written into")->type_name("FOLDER");
    command.add_option("--figure", flags->figure.name, "Make this figure instead: see `sightlines list figures`")
        ->type_name("NAME")
        ->excludes(render);
    add_render_output_flags(command, flags->outputs);
    add_session_flags(command, flags->session);
    add_selection_flags(command, flags->session);
    add_common_flags(command, flags->common);
    command.footer("Example:\n  sightlines workspace atrium.json --render atrium.png");
    command.callback([flags, &chosen] {
        chosen = {[flags](Progress& progress) { return run_workspace(*flags, progress); }, flags->common.quiet};
    });
}

}  // namespace sightlines
