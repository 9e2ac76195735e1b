#include <filesystem>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/commands/figure.h"
#include "app/commands/render.h"
#include "app/selection.h"
#include "app/trace_text.h"
#include "techniques/base/files.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

constexpr const char* what_to_try =
    "\nTry:\n"
    "  sightlines                   (the window, where there is a display)\n"
    "  sightlines list scenes\n"
    "  sightlines render --scene trees --lights 256 --size 640x360 --reference --out trees.png\n"
    "  sightlines trace --scene atrium --lights 1024 --pixel 480,300\n"
    "  sightlines figure voxel-row --scene atrium --lights 1024 --format svg --out figures\n"
    "  sightlines bench shadow-rays --scene atrium\n"
    "  sightlines --help\n";

CommandOutput run_sample(Progress& progress) {
    const fs::path folder = "out";
    make_folder(folder);
    Session session;
    session.lights.count = 1024;
    session.size = {960, 540};
    const CommonFlags common;
    const RenderOutputs outputs{.picture = folder / "atrium.png",
                                .report = folder / "report.json",
                                .error_picture = folder / "atrium-errors.png",
                                .compression_picture = {},
                                .session = folder / "session.json"};
    Results results(thread_flag(common), command_backend(session));
    session.reference = true;
    CommandOutput output = render_to_files(session, outputs, results, common, progress);

    const SelectedRay ray = select_ray(session, results, progress);
    session.selection.pixel = ray.pixel;
    session.selection.light = ray.light;
    const fs::path trace_file = folder / "trace.json";
    write_file(trace_file, json_text(json_from_trace(session, ray)));
    output.text += "wrote " + trace_file.string() + "\n";

    FigureFlags figure;
    figure.name = "voxel-row";
    figure.formats = {"png", "svg"};
    figure.folder = folder;
    output.text += figure_to_files(session, figure, results, common, progress).text + what_to_try;
    return output;
}

}  // namespace

void add_sample_command(CLI::App& app, Command& chosen) {
    CLI::App& command = *app.add_subcommand("sample", "Make a picture, a view inside and a ray's trace into out/");
    command.footer("Example:\n  sightlines sample");
    command.callback([&chosen] { chosen = {run_sample, false}; });
}

}  // namespace sightlines
