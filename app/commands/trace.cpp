#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/commands/flags.h"
#include "app/selection.h"
#include "app/trace_text.h"
#include "techniques/base/files.h"

namespace sightlines {
namespace {

struct TraceFlags {
    SessionFlags session;
    CommonFlags common;
    std::string ray;
    std::filesystem::path out;
};

/// --ray K: the light of the pixel's K-th ray, counting only the lights in front of it.
std::uint32_t light_of_ray(const Session& session, const std::string& text, Results& results, Progress& progress) {
    if (!session.selection.pixel || session.selection.light)
        throw InputError("--ray", "", "counts the rays of one pixel", "give --pixel X,Y, and not --light");
    Session first = session;
    first.selection.light.reset();
    const SelectedRay any = select_ray(first, results, progress);
    const auto surfaces = results.surfaces(session, progress);
    const auto pixel = static_cast<std::size_t>(any.pixel.y) * static_cast<std::size_t>(session.size.width) +
                       static_cast<std::size_t>(any.pixel.x);
    const auto asked = asked_lights(surfaces->value, pixel, pixel_lights(session, pixel, results, progress));
    return asked[static_cast<std::size_t>(whole_number("--ray", text, 0, static_cast<std::int64_t>(asked.size()) - 1))];
}

CommandOutput run_trace(const TraceFlags& flags, Progress& progress) {
    Session session = session_with_flags({}, flags.session);
    if (!flags.out.empty()) check_extension(flags.out, {".json"});
    check_outputs({flags.out});
    Results results(thread_flag(flags.common), command_backend(session));
    results.cache_folder = default_cache_folder();
    CommandOutput output{{}, results.scene(session, progress)->value.notes};
    if (!flags.ray.empty()) session.selection.light = light_of_ray(session, flags.ray, results, progress);
    const SelectedRay ray = select_ray(session, results, progress);
    progress.check();
    const Json json = json_from_trace(session, ray);
    if (!flags.out.empty()) write_file(flags.out, json_text(json));
    if (flags.common.json)
        output.text = json_text(json);
    else if (!flags.common.quiet || flags.out.empty())
        output.text = text_from_trace(session, ray);
    if (!flags.common.json && !flags.common.quiet && !flags.out.empty())
        output.text += "\nwrote " + flags.out.string() + "\n";
    return output;
}

}  // namespace

void add_trace_command(CLI::App& app, Command& chosen) {
    CLI::App& command = *app.add_subcommand("trace", "Record one ray, step by step");
    const auto flags = std::make_shared<TraceFlags>();
    add_session_flags(command, flags->session);
    add_selection_flags(command, flags->session);
    command.add_option("--ray", flags->ray, "Instead of --light: the pixel's K-th ray, counted from 0")->type_name("K");
    command.add_option("--out", flags->out, "Write everything that was recorded, as JSON")->type_name("FILE.json");
    add_common_flags(command, flags->common);
    command.footer(
        "Without --pixel: one near the middle; without --light: one that is judged wrongly, if there is one.\n\n"
        "Example:\n  sightlines trace --scene atrium --lights 1024 --size 640x360 --pixel 320,180 --out ray.json");
    command.callback([flags, &chosen] {
        chosen = {[flags](Progress& progress) { return run_trace(*flags, progress); }, flags->common.quiet};
    });
}

}  // namespace sightlines
