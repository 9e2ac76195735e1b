#include "app/desk/autosave.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <pwd.h>
#include <unistd.h>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/builtin_scenes.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_recent_scenes = 12;
constexpr auto gathering_time = std::chrono::milliseconds(250);  ///< a drag's many sessions are one write
constexpr auto retry_time = std::chrono::seconds(2);

bool is_builtin(const std::string& scene) {
    return std::ranges::any_of(builtin_scenes(), [&](const SceneModel& model) { return model.name == scene; });
}

void make_folder_of(const fs::path& file) {
    std::error_code failure;
    fs::create_directories(file.parent_path(), failure);  // write_file says what is wrong where this could not be done
}

/// What writers that were killed have left beside the file.
void remove_leftovers(const fs::path& file) noexcept {
    std::error_code failure;
    const std::string prefix = file.filename().string() + ".writing-";
    for (const fs::directory_entry& entry : fs::directory_iterator(file.parent_path(), failure)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(prefix)) continue;
        const int process = std::atoi(name.c_str() + prefix.size());
        if (process > 0 && kill(process, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), failure);
    }
}

fs::path recent_file() { return state_folder() / "recent.json"; }

}  // namespace

fs::path state_folder() {
    const char* state = std::getenv("XDG_STATE_HOME");
    if (state != nullptr && fs::path(state).is_absolute()) return fs::path(state) / "sightlines";
    const char* home = std::getenv("HOME");
    const passwd* user = home == nullptr ? getpwuid(getuid()) : nullptr;
    if (user != nullptr) home = user->pw_dir;
    return fs::path(home == nullptr ? "/" : home) / ".local" / "state" / "sightlines";
}

void save_own_session(const fs::path& file, Session session) {
    if (!is_builtin(session.scene)) session.scene = fs::absolute(session.scene).string();
    std::string& surroundings = session.environment.file;
    if (!surroundings.empty()) surroundings = fs::absolute(surroundings).string();
    make_folder_of(file);
    write_file(file, json_from_session(session).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

OwnSession load_own_session(const fs::path& file) {
    std::error_code failure;
    if (!fs::exists(file, failure)) return {};
    try {
        return {session_from_json(read_json(file), file.string()), {}};
    } catch (const std::exception& error) {
        const fs::path kept = file.parent_path() / (file.stem().string() + ".broken" + file.extension().string());
        fs::rename(file, kept, failure);
        const std::string where = failure ? "It will be written over." : "It is kept as " + kept.string() + ".";
        return {Session{},
                "The saved session cannot be read, so this is a new one. " + where + " (" + error.what() + ")"};
    }
}

struct Autosave::Objects {
    fs::path file;
    mutable std::mutex mutex;  ///< of what follows; never held while writing
    std::condition_variable wake;
    std::optional<Session> unsaved, saved;
    std::string failure;
    bool closing = false;
    std::mutex writing;  ///< one writer at a time: they share the temporary file's name
    std::thread thread;

    explicit Objects(fs::path file_) : file(std::move(file_)) {
        remove_leftovers(file);
        thread = std::thread([this] { run(); });
    }
    Objects(const Objects&) = delete;
    Objects& operator=(const Objects&) = delete;
    ~Objects() {
        {
            const std::lock_guard lock(mutex);
            closing = true;
        }
        wake.notify_all();
        thread.join();
    }

    /// Whether everything is saved.
    bool write() noexcept {
        const std::lock_guard one_writer(writing);
        std::unique_lock lock(mutex);
        if (!unsaved) return true;
        try {
            const Session session = *unsaved;
            lock.unlock();
            save_own_session(file, session);
            lock.lock();
            failure.clear();
            if (unsaved == session) unsaved.reset();
            saved = session;
        } catch (const std::exception& error) {
            if (!lock.owns_lock()) lock.lock();
            failure = error.what();
            return false;
        }
        return !unsaved;
    }

    void run() {
        std::unique_lock lock(mutex);
        while (!closing) {
            wake.wait(lock, [&] { return closing || unsaved; });
            wake.wait_for(lock, gathering_time, [&] { return closing; });
            lock.unlock();
            write();
            lock.lock();
            if (!failure.empty()) wake.wait_for(lock, retry_time, [&] { return closing; });
        }
        lock.unlock();
        write();
    }
};

Autosave::Autosave(fs::path file) : objects(std::make_unique<Objects>(std::move(file))) {}
Autosave::~Autosave() = default;
Autosave::Autosave(Autosave&&) noexcept = default;
Autosave& Autosave::operator=(Autosave&&) noexcept = default;

void save_soon(Autosave& autosave, const Session& session) {
    {
        const std::lock_guard lock(autosave.objects->mutex);
        if (!autosave.objects->unsaved && autosave.objects->saved == session) return;
        autosave.objects->unsaved = session;
    }
    autosave.objects->wake.notify_all();
}

void save_now(Autosave& autosave) noexcept { autosave.objects->write(); }

std::string save_failure(const Autosave& autosave) {
    const std::lock_guard lock(autosave.objects->mutex);
    return autosave.objects->failure;
}

std::vector<std::string> recent_scenes() {
    try {
        if (!fs::exists(recent_file())) return {};
        auto scenes = read_json(recent_file()).get<std::vector<std::string>>();
        if (scenes.size() > most_recent_scenes) scenes.resize(most_recent_scenes);
        return scenes;
    } catch (const std::exception&) {
        return {};
    }
}

void remember_scene(const std::string& scene) {
    if (is_builtin(scene)) return;
    try {
        const std::string path = fs::absolute(scene).string();
        std::vector<std::string> scenes = recent_scenes();
        std::erase(scenes, path);
        scenes.insert(scenes.begin(), path);
        if (scenes.size() > most_recent_scenes) scenes.resize(most_recent_scenes);
        make_folder_of(recent_file());
        write_file(recent_file(), Json(scenes).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    } catch (const std::exception&) {
        return;  // as promised: the list is a convenience
    }
}

}  // namespace sightlines
