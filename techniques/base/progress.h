// How long work tells how far it is, and is told to stop. Shared between the worker and whoever watches.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "techniques/base/error.h"

namespace sightlines {

/// One piece of long work. Workers call `begin`, `advance` and `check`; watchers read `stage`, `fraction` and call
/// `cancel`. Every member may be called from any thread.
struct Progress {
    /// Starts a stage of `total` equal steps, named for people ("voxelising directions").
    void begin(const std::string& stage_name, std::int64_t total) {
        const std::lock_guard lock(mutex_);
        stage_ = stage_name;
        total_ = total > 0 ? total : 1;
        done_ = 0;
    }
    /// `steps` more are done; throws Cancelled where the work was cancelled.
    void advance(std::int64_t steps = 1) {
        done_ += steps;
        check();
    }
    void check() const {
        if (cancelled_) throw Cancelled();
    }
    void cancel() { cancelled_ = true; }
    bool cancelled() const { return cancelled_; }
    /// In [0, 1], of the current stage.
    double fraction() const { return static_cast<double>(done_) / static_cast<double>(total_); }
    std::string stage() const {
        const std::lock_guard lock(mutex_);
        return stage_;
    }

private:
    mutable std::mutex mutex_;
    std::string stage_;
    std::atomic<std::int64_t> done_ = 0, total_ = 1;
    std::atomic<bool> cancelled_ = false;
};

}  // namespace sightlines
