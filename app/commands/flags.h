// The flags that several commands share, and the session that they make.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/session.h"
#include "techniques/technique.h"

namespace CLI {
class App;
}

namespace sightlines {

/// As written on the command line; empty: not given. Read only by `session_with_flags`, so that a bad value is an
/// InputError that names its flag.
struct SessionFlags {
    std::string technique, scene, camera, size, lights, virtual_lights, placement, time_s, backend, seed, pixel, light;
    std::string environment, sun, turn_deg;
    std::vector<std::string> parameters;  ///< name=value
    bool reference = false;
};

struct CommonFlags {
    std::string threads;
    bool json = false, quiet = false;
};

void add_session_flags(CLI::App& command, SessionFlags& flags);
/// --pixel X,Y and --light K.
void add_selection_flags(CLI::App& command, SessionFlags& flags);
void add_common_flags(CLI::App& command, CommonFlags& flags);

/// `session` with every flag that was given in place of its own value. InputError names the flag.
Session session_with_flags(Session session, const SessionFlags& flags);

/// InputError unless `text` is a whole number in the range (and nothing else).
std::int64_t whole_number(const std::string& flag, const std::string& text, std::int64_t lowest, std::int64_t highest);
/// InputError unless `text` is a finite number in the range.
double real_number(const std::string& flag, const std::string& text, double lowest, double highest);
/// Two whole numbers with `separator` between them: 480x270, 12,34.
ivec2 two_numbers(const std::string& flag, const std::string& text, char separator, int lowest, int highest);

int thread_flag(const CommonFlags& flags);

/// What Results needs to know of the machine: the driver is asked only where the session leaves the choice open.
Backend command_backend(const Session& session);

/// Now, before the long work: EnvironmentError for a file that could not be written later, InputError where two of
/// them are one. Empty paths are left out.
void check_outputs(const std::vector<std::filesystem::path>& files);
/// Now: EnvironmentError where `folder` is none and could not be made. `make_folder` makes it, parents included, when
/// there is something to put into it.
void check_folder(const std::filesystem::path& folder);
void make_folder(const std::filesystem::path& folder);
/// InputError unless the name ends in one of `extensions` (".png").
void check_extension(const std::filesystem::path& file, const std::vector<std::string>& extensions);

/// JSON as the program writes it to files and the terminal: indented; bytes that are not UTF-8 are replaced.
std::string json_text(const Json& json);

}  // namespace sightlines
