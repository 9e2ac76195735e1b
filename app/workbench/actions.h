// Everything that a key does, in one table: keys, menus and the list under F1 come from it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "app/workbench/frame.h"

namespace sightlines {

enum class ActionId {
    step_forward,
    step_back,
    first_step,
    last_step,
    next_ray,
    previous_ray,
    lit,
    reference,
    shadow,
    lights_seen,
    rays_asked,
    visibility_error,
    shadow_error,
    compression,
    rays_traced,
    compare,
    lights_shown,
    exposure_up,
    exposure_down,
    scene_camera,
    play,
    time_forward,
    time_back,
    reframe,
    maximise,
    undo,
    redo,
    open_scene,
    open_session,
    save_session,
    theme,
    larger_text,
    smaller_text,
    stop,
    make_again,
    keys,
    quit,
};

struct Action {
    ActionId id;
    std::string_view group, title;
    KeyPress key, other_key;  ///< either does it; key 0: none
    void (*run)(Frame&);
};

std::span<const Action> actions();
const Action& find_action(ActionId id);
/// "Ctrl+Shift+Z or Ctrl+Y"
std::string keys_text(const Action& action);

/// What the mouse and held keys do, for the list under F1.
struct Gesture {
    std::string_view group, how, what;
};
std::span<const Gesture> gestures();

/// Runs the actions of the keys that were pressed. While text is being typed only those with Ctrl and function keys
/// count.
void run_keys(Frame& frame, std::span<const KeyPress> keys);

}  // namespace sightlines
