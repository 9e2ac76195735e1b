// The session on disk while the window is open, and the files opened lately.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/session.h"

namespace sightlines {

/// Where the program keeps its own files: $XDG_STATE_HOME/sightlines, else ~/.local/state/sightlines.
std::filesystem::path state_folder();

/// Writes the program's own session file, atomically; makes its folder. Unlike `save_session` it keeps absolute paths:
/// the file is nobody's but the program's, so `load_own_session` trusts them. EnvironmentError as write_file.
void save_own_session(const std::filesystem::path& file, Session session);

struct OwnSession {
    Session session;
    std::string message;  ///< why the saved one could not be taken; empty where it was, or where there is none
};
/// The session saved last, or the default one. A file that is broken, or of a newer version, is put aside as
/// "session.broken.json", and the message says so. Never throws.
OwnSession load_own_session(const std::filesystem::path& file);

/// Saves the newest session given to it, atomically, on a thread of its own: at most half a second after it changed.
struct Autosave {
    struct Objects;
    std::unique_ptr<Objects> objects;

    explicit Autosave(std::filesystem::path file);
    ~Autosave();  ///< saves what is not saved yet
    Autosave(Autosave&&) noexcept;
    Autosave& operator=(Autosave&&) noexcept;
};
void save_soon(Autosave& autosave, const Session& session);
/// Now, on the calling thread; for the moment before the process ends. Never throws.
void save_now(Autosave& autosave) noexcept;
/// The last failure to save ("disk full"), or empty.
std::string save_failure(const Autosave& autosave);

/// Scene files opened lately, newest first, at most 12; a file that is missing or broken is an empty list.
std::vector<std::string> recent_scenes();
/// Puts a scene file at the head of them. Built-in scenes are always at hand and are not listed. Never throws: a list
/// that cannot be written stays as it was.
void remember_scene(const std::string& scene);

}  // namespace sightlines
