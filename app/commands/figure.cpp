#include "app/commands/figure.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "app/inside.h"
#include "app/selection.h"
#include "techniques/base/error.h"
#include "visualizers/figure.h"

namespace sightlines {
namespace {

constexpr double lowest_dpi = 36.0, highest_dpi = 1200.0;

}  // namespace

void add_figure_flags(CLI::App& command, FigureFlags& flags) {
    command.add_option("--format", flags.formats, "png, svg, pdf or vtk (for ParaView); several may be given")
        ->type_name("F");
    command.add_option("--dpi", flags.dpi, "Dots per inch of what is not drawn as vectors")->type_name("N");
}

CommandOutput figure_to_files(const Session& session, const FigureFlags& flags, Results& results,
                              const CommonFlags& common, Progress& progress) {
    const std::string name = flags.name == "all" ? std::string(shown_figure(session)) : flags.name;
    const FigureRow& figure = find_figure(name);
    if (!figure.technique.empty() && session.technique != figure.technique)
        throw InputError("figure " + name, "", "shows the inside of " + std::string(figure.technique),
                         "give --technique " + std::string(figure.technique));
    if (!can_show(figure, session))
        throw InputError("figure " + name, "", "shows a structure that is compressed", "give --set compression=on");
    FigureOptions options;
    if (!flags.dpi.empty()) options.dpi = static_cast<float>(real_number("--dpi", flags.dpi, lowest_dpi, highest_dpi));
    std::vector<FigureFormat> formats;
    for (const std::string& format : flags.formats) formats.push_back(parse_figure_format(format));
    if (formats.empty()) formats.push_back(options.format);
    check_folder(flags.folder);

    const SelectedRay ray = select_ray(session, results, progress);
    Session shown = session;
    show_figure(shown, name);
    UnpackedVoxels unpacked;
    const InsidePicture picture = inside_picture(shown, ray, results, progress, unpacked);
    progress.begin("drawing the figure", static_cast<std::int64_t>(formats.size()));
    InsideView view;
    make_folder(flags.folder);
    CommandOutput output{{}, results.scene(session, progress)->value.notes};
    Json files = Json::array();
    for (const FigureFormat format : formats) {
        progress.check();
        options.format = format;
        const auto written = write_figure(view, picture, name, view_state(session, name), options, flags.folder);
        for (const auto& file : written) files.push_back(file.string());
        if (!common.json && !common.quiet) output.text += "wrote " + written.front().string() + "\n";
        progress.advance();
    }
    if (common.json)
        output.text = json_text({{"figure", name},
                                 {"pixel", {ray.pixel.x, ray.pixel.y}},
                                 {"light", ray.light},
                                 {"blocked", ray.trace.blocked},
                                 {"embree_blocked", ray.truly_blocked},
                                 {"files", files}});
    return output;
}

void add_figure_command(CLI::App& app, Command& chosen) {
    struct Flags {
        SessionFlags session;
        FigureFlags figure;
        CommonFlags common;
    };
    CLI::App& command = *app.add_subcommand("figure", "Draw a view inside, for a slide, a paper or ParaView");
    const auto flags = std::make_shared<Flags>();
    command.add_option("name", flags->figure.name, "Which one: see `sightlines list figures`; or all")
        ->required()
        ->type_name("NAME");
    add_figure_flags(command, flags->figure);
    command.add_option("--out", flags->figure.folder, "The folder to write into")->required()->type_name("FOLDER");
    add_session_flags(command, flags->session);
    add_selection_flags(command, flags->session);
    add_common_flags(command, flags->common);
    command.footer(
        "Without --pixel: one near the middle; without --light: one that is judged wrongly, if there is one.\n\n"
        "Example:\n  sightlines figure voxel-row --scene atrium --lights 1024 --format svg --out figures");
    command.callback([flags, &chosen] {
        chosen = {[flags](Progress& progress) {
                      const Session session = session_with_flags({}, flags->session);
                      Results results(thread_flag(flags->common), command_backend(session));
                      results.cache_folder = default_cache_folder();
                      return figure_to_files(session, flags->figure, results, flags->common, progress);
                  },
                  flags->common.quiet};
    });
}

}  // namespace sightlines
