// The real program, run as a user runs it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sightlines {

struct ProgramRun {
    int exit_code = -1;  ///< negative: ended by that signal
    std::string output, errors;
};

/// A signal for the running program.
struct SendSignal {
    int signal;
    double after_s;
};

/// Runs the program with `arguments` in `folder` and waits.
ProgramRun run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                       std::optional<SendSignal> send = {});

/// While it lives, a variable of the environment has this value for programs that are started, or none.
struct VariableSet {
    std::string name;
    std::optional<std::string> before;

    VariableSet(const std::string& name_, const std::optional<std::string>& value);
    ~VariableSet();
    VariableSet(const VariableSet&) = delete;
    VariableSet& operator=(const VariableSet&) = delete;
};

/// While it lives, programs that are started find no display.
struct DisplayHidden {
    VariableSet display{"DISPLAY", {}};
};

/// An empty folder for the running test.
std::filesystem::path fresh_folder();

std::string text_of(const std::filesystem::path& file);
std::vector<std::string> files_in(const std::filesystem::path& folder);

}  // namespace sightlines
