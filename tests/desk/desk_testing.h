// A small session, and how a test waits for the threads: by what they say, never by the clock.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>

#include "app/desk/background.h"

namespace sightlines {

inline Session small_session() {
    Session session;
    session.scene = "cornell";
    session.size = {48, 32};
    session.lights.count = 8;
    session.backend = BackendChoice::cpu;
    session.parameters["voxel_rows"] = {{"resolution", 32.0}, {"angle_step", 6.0}};
    return session;
}

/// A session whose structure takes some seconds to build.
inline Session long_session() {
    Session session = small_session();
    session.scene = "atrium";
    session.parameters["voxel_rows"] = {{"resolution", 128.0}, {"angle_step", 2.0}, {"build", 1.0}};
    return session;
}

/// Wakes a test when something has changed.
struct Watch {
    std::mutex mutex;
    std::condition_variable wake;
    std::uint64_t changes = 0;

    std::function<void()> callback() {
        return [this] {
            {
                const std::lock_guard lock(mutex);
                ++changes;
            }
            wake.notify_all();
        };
    }
    /// Whether `what` became true, asked after each change, and now and then for what grows without a word (progress).
    /// Two minutes are for a machine that is stuck.
    bool until(const std::function<bool()>& what) {
        const auto latest = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (std::chrono::steady_clock::now() < latest) {
            std::uint64_t seen = 0;
            {
                const std::lock_guard lock(mutex);
                seen = changes;
            }
            if (what()) return true;
            std::unique_lock lock(mutex);
            wake.wait_for(lock, std::chrono::milliseconds(20), [&] { return changes != seen; });
        }
        return false;
    }
};

/// The background of a window that is not there.
struct Desk {
    Results results{0, Backend::cpu};
    Watch watch;
    Background background{results, watch.callback()};

    bool until(const std::function<bool(const Shown&)>& what) {
        return watch.until([&] { return what(shown(background)); });
    }
    /// Waits for the finished picture of the session, and the reference's figures where it asks for them.
    bool complete(const Session& session) {
        return until([&](const Shown& now) {
            return now.picture && now.picture->state == PictureState::complete && now.picture->session == session &&
                   now.work.empty() && (!session.reference || now.errors);
        });
    }
    bool followed(std::uint32_t light) {
        return until([&](const Shown& now) {
            return now.ray && now.inside && now.ray->light == light &&
                   std::get<VoxelRowPicture>(*now.inside).ray.target == now.ray->trace.ray.target;
        });
    }
};

}  // namespace sightlines
