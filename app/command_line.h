// The command line: which command, with which flags, and what its end means to the shell.
#pragma once

#include "techniques/base/error.h"

namespace sightlines {

/// Runs the program. Errors become one line on standard error and the exit code of their kind.
ExitCode run_command_line(int argc, const char* const* argv);

}  // namespace sightlines
