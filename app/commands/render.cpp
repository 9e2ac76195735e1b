#include <memory>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/commands/flags.h"
#include "app/commands/render.h"
#include "app/report.h"
#include "app/table.h"
#include "techniques/base/files.h"

namespace sightlines {

void add_render_output_flags(CLI::App& command, RenderOutputs& outputs) {
    command.add_option("--report", outputs.report, "Write what was measured, as JSON")->type_name("FILE.json");
    command
        .add_option("--error-out", outputs.error_picture,
                    "Write the share of wrongly judged rays as a picture (asks for --reference)")
        ->type_name("FILE.png");
    command
        .add_option("--compression-out", outputs.compression_picture,
                    "Write the share of rays that compression changed as a picture (asks for --reference)")
        ->type_name("FILE.png");
    command.add_option("--save-session", outputs.session, "Write the session, for `sightlines workspace`")
        ->type_name("FILE.json");
}

void check_render_outputs(const RenderOutputs& outputs) {
    check_extension(outputs.picture, {".png", ".hdr"});
    for (const auto& file : {outputs.error_picture, outputs.compression_picture})
        if (!file.empty()) check_extension(file, {".png"});
    check_outputs(
        {outputs.picture, outputs.report, outputs.error_picture, outputs.compression_picture, outputs.session});
}

CommandOutput render_to_files(Session session, const RenderOutputs& outputs, Results& results,
                              const CommonFlags& common, Progress& progress) {
    check_render_outputs(outputs);
    session.reference = session.reference || !outputs.error_picture.empty() || !outputs.compression_picture.empty();
    RenderReport report = render_session(session, results, progress);
    if (!outputs.compression_picture.empty()) report.compression = results.compression(session, progress);
    CommandOutput output{{}, report.scene->value.notes};
    if (report.environment) {
        const auto& notes = report.environment->value.map->notes;
        output.notes.insert(output.notes.end(), notes.begin(), notes.end());
        if (session.lights != LightChoice{})
            output.notes.push_back("the lights are left out: " + session.technique + " is lit by the environment only");
    } else if (session.environment != EnvironmentChoice{}) {
        output.notes.push_back("the environment is left out: " + session.technique + " knows lights only");
    }
    progress.check();
    if (outputs.picture.extension() == ".hdr")
        write_image(outputs.picture, report.picture->value.radiance, session.display);
    else
        write_png(outputs.picture, shown_channel(report));
    const auto write_channel = [&](const std::filesystem::path& file, Channel channel) {
        if (file.empty()) return;
        RenderReport shown = report;
        shown.session.channel = channel;
        write_png(file, shown_channel(shown));
    };
    write_channel(outputs.error_picture, Channel::visibility_error);
    write_channel(outputs.compression_picture, Channel::compression);
    const Json json = json_from_report(report);
    if (!outputs.report.empty()) write_file(outputs.report, json_text(json));
    if (!outputs.session.empty()) save_session(outputs.session, session);
    if (common.json) output.text = json_text(json);
    if (common.json || common.quiet) return output;
    output.text = text_from_report(report) + "\nwrote " + outputs.picture.string() + "\n";
    if (!outputs.error_picture.empty())
        output.text += "wrote " + outputs.error_picture.string() + " (dark: no ray judged wrongly; brightest: " +
                       percent_text(100.0 * static_cast<double>(visibility_error_shown)) + " or more)\n";
    if (!outputs.compression_picture.empty())
        output.text += "wrote " + outputs.compression_picture.string() + " (dark: no ray changed; brightest: " +
                       percent_text(100.0 * static_cast<double>(compression_shown)) + " or more)\n";
    for (const auto& file : {outputs.report, outputs.session})
        if (!file.empty()) output.text += "wrote " + file.string() + "\n";
    return output;
}

void add_render_command(CLI::App& app, Command& chosen) {
    struct Flags {
        SessionFlags session;
        RenderOutputs outputs;
        CommonFlags common;
    };
    CLI::App& command = *app.add_subcommand("render", "Make a picture, and measure how");
    const auto flags = std::make_shared<Flags>();
    add_session_flags(command, flags->session);
    command.add_option("--out", flags->outputs.picture, "The picture to write: .png, or .hdr (linear)")
        ->required()
        ->type_name("FILE");
    add_render_output_flags(command, flags->outputs);
    add_common_flags(command, flags->common);
    command.footer(
        "Example:\n  sightlines render --technique voxel_rows --scene atrium --lights 1024 --size 640x360 "
        "--reference --out atrium.png");
    command.callback([flags, &chosen] {
        chosen = {[flags](Progress& progress) {
                      const Session session = session_with_flags({}, flags->session);
                      Results results(thread_flag(flags->common), command_backend(session));
                      return render_to_files(session, flags->outputs, results, flags->common, progress);
                  },
                  flags->common.quiet};
    });
}

}  // namespace sightlines
