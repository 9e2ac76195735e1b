// The scene's time while it is played.
#pragma once

#include <chrono>

#include "app/desk/background.h"

namespace sightlines {

/// The scene's time runs as the clock does, but only moves on when the picture of the last moment is there.
struct Playing {
    std::chrono::steady_clock::time_point since;
    double from_s = 0.0;  ///< the scene's time then
};

/// The time that the session goes on to, s: its own until the technique's own picture of that moment is shown (a
/// preview does not count) or none can be made, then what the clock has come to at `now`, looped.
double played_time_s(const Playing& playing, const Session& session, const Shown& shown,
                     std::chrono::steady_clock::time_point now);

}  // namespace sightlines
