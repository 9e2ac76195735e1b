// A session rendered into files: shared by `render`, `workspace --render` and the main job.
#pragma once

#include <filesystem>

#include "app/commands/commands.h"
#include "app/commands/flags.h"
#include "app/results.h"
#include "app/session.h"
#include "techniques/base/progress.h"

namespace sightlines {

/// Which files to write; those that are empty are not.
struct RenderOutputs {
    std::filesystem::path picture, report, error_picture, compression_picture, session;
};

/// --report, --error-out, --compression-out and --save-session; the picture's own flag is the command's.
void add_render_output_flags(CLI::App& command, RenderOutputs& outputs);

/// Checks that everything can be written, renders, writes, and gives the report (as JSON with --json, none with
/// --quiet). Nothing is written unless all of the work is done.
CommandOutput render_to_files(Session session, const RenderOutputs& outputs, Results& results,
                              const CommonFlags& common, Progress& progress);

}  // namespace sightlines
