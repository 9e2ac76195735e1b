#include "app/desk/history.h"

#include <utility>

namespace sightlines {

void edit(History& history, const Session& next, bool in_gesture) {
    if (next == history.now) return;
    if (!(in_gesture && history.gesture_open)) {
        if (history.past.size() == most_undo_steps) history.past.erase(history.past.begin());
        history.past.push_back(std::move(history.now));
    }
    history.now = next;
    history.future.clear();
    history.gesture_open = in_gesture;
}

void end_gesture(History& history) {
    // A drag that came back to where it began has changed nothing.
    if (history.gesture_open && !history.past.empty() && history.past.back() == history.now) history.past.pop_back();
    history.gesture_open = false;
}

bool can_undo(const History& history) { return !history.past.empty(); }

bool can_redo(const History& history) { return !history.future.empty(); }

void undo(History& history) {
    end_gesture(history);
    if (!can_undo(history)) return;
    history.future.push_back(std::move(history.now));
    history.now = std::move(history.past.back());
    history.past.pop_back();
}

void redo(History& history) {
    end_gesture(history);
    if (!can_redo(history)) return;
    history.past.push_back(std::move(history.now));
    history.now = std::move(history.future.back());
    history.future.pop_back();
}

}  // namespace sightlines
