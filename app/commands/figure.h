// A view inside as a figure in files: shared by `figure`, `workspace --figure` and the main job.
#pragma once

#include <filesystem>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/flags.h"
#include "app/results.h"
#include "app/session.h"

namespace sightlines {

struct FigureFlags {
    std::string name, dpi;
    std::vector<std::string> formats;  ///< png, svg, pdf, vtk; empty: png
    std::filesystem::path folder;
};

/// --format, --dpi and --out; the figure's name is the command's own.
void add_figure_flags(CLI::App& command, FigureFlags& flags);

/// Makes the figure of the session's selected ray in every format that is asked for.
CommandOutput figure_to_files(const Session& session, const FigureFlags& flags, Results& results,
                              const CommonFlags& common, Progress& progress);

}  // namespace sightlines
