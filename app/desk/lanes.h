// What the window's side of the background and its two threads share. Internal to this folder.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "app/desk/background.h"
#include "app/report.h"

namespace sightlines {

using Clock = std::chrono::steady_clock;

/// The newest thing that the window asked for.
struct Wanted {
    Session session;
    bool dragging = false;
    std::uint64_t number = 0;  ///< grows with each
};

/// What a lane is doing.
struct LaneWork {
    std::shared_ptr<Progress> progress{};  ///< null: nothing
    Session session{};
    bool draft = false;
    bool building = false;                    ///< a structure: long
    mutable const Progress* timed = nullptr;  ///< whose stage the following two belong to
    mutable std::string stage{};
    mutable Clock::time_point began{};
};

/// A heavy thing that is shown no longer. The window's own copies go within a frame; the lanes wait for that, so that
/// it is never the window that frees gigabytes.
using Retired = std::vector<std::shared_ptr<const void>>;

struct Background::Objects {
    Results& results;
    const std::function<void()> changed;

    mutable std::mutex mutex;  ///< of everything below; held for moments only
    std::condition_variable wake;
    bool closing = false;
    std::optional<Wanted> wanted;
    std::optional<Session> ready;  ///< the stage_key that scene, lights, surfaces and structure are there for
    std::optional<std::string> trial_wanted;
    std::optional<SceneTrial> trial;
    bool trying = false;
    LaneWork picture_work, rays_work;
    Shown shown;
    Retired retired;

    std::thread picture_lane, rays_lane;

    Objects(Results& results_, std::function<void()> changed_);
    Objects(const Objects&) = delete;
    Objects& operator=(const Objects&) = delete;
    ~Objects();
};

/// What decides whether a picture must be made again: nothing of the looks or the selection.
Session picture_key(const Session& session);
/// The same, without what is only needed to compare.
Session stage_key(const Session& session);
/// What decides which rays are followed and recorded; `light`: also which of a pixel's.
Session rays_key(const Session& session, bool light);

/// Changes what is shown, under the lock, and tells the window. `change(Shown&)` must be quick.
template <class Change>
void put_out(Background::Objects& objects, const Change& change) {
    {
        const std::lock_guard lock(objects.mutex);
        change(objects.shown);
        ++objects.shown.number;
    }
    objects.wake.notify_all();
    objects.changed();
}

/// Puts `next` in the place of something shown. The lock must be held.
template <class Value>
void replace_shown(Background::Objects& objects, std::shared_ptr<const Value>& now, std::shared_ptr<const Value> next) {
    if (now == next) return;
    if (now) objects.retired.push_back(std::move(now));
    now = std::move(next);
}

/// Lets go of what only we hold still. Takes and releases the lock.
void free_retired(Background::Objects& objects);

/// Runs `work` and puts a failure where `place` points to, of the session. Cancelled work leaves no trace.
template <class Run>
void run_work(Background::Objects& objects, const Session& session, std::optional<Failure> Shown::*place,
              const Run& run) {
    const auto fail = [&](const std::string& message, bool environment) {
        put_out(objects, [&](Shown& shown) { shown.*place = Failure{message, session, environment}; });
    };
    try {
        run();
        bool failed_before = false;
        {
            const std::lock_guard lock(objects.mutex);
            failed_before = (objects.shown.*place).has_value();
        }
        if (failed_before) put_out(objects, [&](Shown& shown) { (shown.*place).reset(); });
    } catch (const Cancelled&) {
        return;
    } catch (const InputError& error) {
        fail(error.what(), false);
    } catch (const EnvironmentError& error) {
        fail(error.what(), true);
    } catch (const std::bad_alloc&) {
        fail("There is not enough memory for this. Choose a lower resolution, a larger angle step or a smaller scene.",
             true);
    }
}

/// The two threads, until `closing`.
void run_picture_lane(Background::Objects& objects);
void run_rays_lane(Background::Objects& objects);

}  // namespace sightlines
