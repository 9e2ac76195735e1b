// Undo and redo: a list of sessions.
#pragma once

#include <vector>

#include "app/session.h"

namespace sightlines {

/// The session as it is, those before it, and those that were undone. A value.
struct History {
    Session now;
    std::vector<Session> past;    ///< oldest first, at most `most_undo_steps`
    std::vector<Session> future;  ///< the next to redo last
    bool gesture_open = false;    ///< the latest edit may still go on: further ones join it
};
constexpr std::size_t most_undo_steps = 500;

/// `next` becomes the session. Edits of one gesture (a drag, a scrub, a burst of wheel steps) are one step of undo:
/// while `in_gesture`, edits join the one that opened it. Nothing where `next` equals the session.
void edit(History& history, const Session& next, bool in_gesture);
/// The mouse was released: the next edit is a step of its own.
void end_gesture(History& history);
bool can_undo(const History& history);
bool can_redo(const History& history);
void undo(History& history);
void redo(History& history);

}  // namespace sightlines
