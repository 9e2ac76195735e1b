// The three kinds of error (DESIGN, "Errors"): input, environment, our own fault. There is no fourth.
#pragma once

#include <stdexcept>
#include <string>

namespace sightlines {

/// What the program's exit status says. Ours: assert in debug builds, an uncaught exception elsewhere.
enum class ExitCode {
    success = 0,
    our_fault = 1,
    bad_command_line = 2,
    bad_input = 3,
    environment = 4,
    cancelled = 130
};

/// A file, a flag, a lesson or a parameter is wrong. `where` names the file (or flag), `place` the spot inside it
/// (may be empty), `problem` what is wrong, `remedy` how to mend it (may be empty). what() is all of it on one line.
struct InputError : std::runtime_error {
    InputError(std::string where, std::string place, std::string problem, std::string remedy = {});
    std::string where, place, problem, remedy;
};

/// No Vulkan device, no display, disk full, out of memory, output not writable: same form, exit code 4.
struct EnvironmentError : std::runtime_error {
    EnvironmentError(std::string where, std::string problem, std::string remedy = {});
    std::string where, problem, remedy;
};

/// Thrown by long work when its Progress was asked to stop; never an error to report.
struct Cancelled : std::exception {
    const char* what() const noexcept override { return "cancelled"; }
};

/// Of `candidates`, the one that `wrong` was most likely meant to be (edit distance), or "" if none is near.
/// Used for "unknown scene `atrum`: did you mean `atrium`?".
template <class Range>
std::string nearest_name(const std::string& wrong, const Range& candidates);

/// Number of single-letter edits (insert, delete, replace, swap of neighbours) from a to b.
int edit_distance(const std::string& a, const std::string& b);

template <class Range>
std::string nearest_name(const std::string& wrong, const Range& candidates) {
    std::string best;
    int best_distance = 1 + static_cast<int>(wrong.size() + 2) / 3;
    for (const auto& candidate : candidates) {
        const int distance = edit_distance(wrong, std::string(candidate));
        if (distance < best_distance) {
            best_distance = distance;
            best = std::string(candidate);
        }
    }
    return best;
}

}  // namespace sightlines
