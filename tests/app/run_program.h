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

/// Runs the program with `arguments` in `folder` and waits. `interrupt_after_s`: sends SIGINT then.
ProgramRun run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                       std::optional<double> interrupt_after_s = {});

/// While it lives, programs that are started find no display.
struct DisplayHidden {
    std::optional<std::string> before;

    DisplayHidden();
    ~DisplayHidden();
    DisplayHidden(const DisplayHidden&) = delete;
    DisplayHidden& operator=(const DisplayHidden&) = delete;
};

/// An empty folder for the running test.
std::filesystem::path fresh_folder();

std::string text_of(const std::filesystem::path& file);
std::vector<std::string> files_in(const std::filesystem::path& folder);

}  // namespace sightlines
