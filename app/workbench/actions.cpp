#include "app/workbench/actions.h"

#include <algorithm>
#include <array>

#include <GLFW/glfw3.h>

#include "app/workbench/panes.h"

namespace sightlines {
namespace {

constexpr float exposure_step = 0.5f, text_step = 0.1f;

template <Channel channel>
void show_channel(Frame& frame) {
    frame.next.channel = channel;
}

template <int offset>
void go_by(Frame& frame) {
    go_to_step(frame, static_cast<std::int64_t>(current_step(frame)) + offset);
}

template <int offset>
void choose_ray(Frame& frame) {
    if (const auto light = neighbouring_ray(frame, offset)) select_light(frame, *light);
}

template <int sign>
void expose(Frame& frame) {
    float& stops = frame.next.display.exposure_stops;
    stops = std::clamp(stops + sign * exposure_step, -16.0f, 16.0f);
}

template <int sign>
void scale_text(Frame& frame) {
    float& text_scale = frame.next.workbench.text_scale;
    text_scale = std::clamp(text_scale + sign * text_step, 0.5f, 3.0f);
}

template <Dialog dialog>
void open_dialog(Frame& frame) {
    frame.ui.dialog = dialog;
}

/// The pane under the mouse alone, or all of them again.
void maximise(Frame& frame) {
    Layout& layout = frame.next.workbench.layout;
    if (layout.maximised) return layout.maximised.reset();
    const Arrangement areas = arrange(layout, framebuffer_size(frame.window), frame.scale);
    for (std::size_t place = 0; place < pane_count; ++place)
        if (areas.panes[place].contains({ImGui::GetMousePos().x, ImGui::GetMousePos().y}))
            layout.maximised = static_cast<PanePlace>(place);
}

/// What Escape means now, when no dialog is open: first the message, then the work, then the maximised pane.
void stop(Frame& frame) {
    if (frame.ui.message)
        frame.ui.message.reset();
    else if (!frame.shown.work.empty())
        cancel(frame.background);
    else
        frame.next.workbench.layout.maximised.reset();
}

void toggle_theme(Frame& frame) {
    Theme& theme = frame.next.workbench.theme;
    theme = theme == Theme::dark ? Theme::light : Theme::dark;
}

constexpr KeyPress plain(int key) { return {.key = key}; }
constexpr KeyPress control(int key) { return {.key = key, .control = true}; }
constexpr KeyPress control_shift(int key) { return {.key = key, .control = true, .shift = true}; }

constexpr std::string_view ray = "The selected ray", image = "Image", views = "View", session = "Session",
                           window = "Window";

constexpr std::array<Action, 37> table{{
    {ActionId::step_forward, ray, "Step forward", plain(GLFW_KEY_RIGHT), plain(GLFW_KEY_SPACE), go_by<1>},
    {ActionId::step_back, ray, "Step back", plain(GLFW_KEY_LEFT), plain(GLFW_KEY_BACKSPACE), go_by<-1>},
    {ActionId::first_step, ray, "First step", plain(GLFW_KEY_HOME), {}, go_by<-(1 << 20)>},
    {ActionId::last_step, ray, "Last step", plain(GLFW_KEY_END), {}, go_by<1 << 20>},
    {ActionId::next_ray, ray, "Next ray of the table", plain(GLFW_KEY_DOWN), {}, choose_ray<1>},
    {ActionId::previous_ray, ray, "Previous ray of the table", plain(GLFW_KEY_UP), {}, choose_ray<-1>},
    {ActionId::lit, image, "Show the lit picture", plain(GLFW_KEY_1), {}, show_channel<Channel::lit>},
    {ActionId::reference,
     image,
     "Show the ray traced picture",
     plain(GLFW_KEY_2),
     {},
     show_channel<Channel::reference>},
    {ActionId::shadow, image, "Show the shadow value", plain(GLFW_KEY_3), {}, show_channel<Channel::shadow>},
    {ActionId::lights_seen,
     image,
     "Show how many lights are seen",
     plain(GLFW_KEY_4),
     {},
     show_channel<Channel::lights_seen>},
    {ActionId::rays_asked, image, "Show how many rays are asked", plain(GLFW_KEY_5), {}, show_channel<Channel::rays>},
    {ActionId::visibility_error,
     image,
     "Show the visibility error",
     plain(GLFW_KEY_6),
     {},
     show_channel<Channel::visibility_error>},
    {ActionId::shadow_error,
     image,
     "Show the shadow error",
     plain(GLFW_KEY_7),
     {},
     show_channel<Channel::shadow_error>},
    {ActionId::compression,
     image,
     "Show what compression changed",
     plain(GLFW_KEY_8),
     {},
     show_channel<Channel::compression>},
    {ActionId::rays_traced,
     image,
     "Show how many rays are traced",
     plain(GLFW_KEY_9),
     {},
     show_channel<Channel::rays_traced>},
    {ActionId::compare,
     image,
     "Measure the error against ray tracing",
     plain(GLFW_KEY_C),
     {},
     [](Frame& frame) { frame.next.reference = !frame.next.reference; }},
    {ActionId::lights_shown,
     image,
     "Mark all lights",
     plain(GLFW_KEY_L),
     {},
     [](Frame& frame) { frame.next.workbench.lights_shown = !frame.next.workbench.lights_shown; }},
    {ActionId::exposure_up, image, "Brighter by half a stop", plain(GLFW_KEY_RIGHT_BRACKET), {}, expose<1>},
    {ActionId::exposure_down, image, "Darker by half a stop", plain(GLFW_KEY_LEFT_BRACKET), {}, expose<-1>},
    {ActionId::scene_camera,
     image,
     "Back to the scene's camera",
     plain(GLFW_KEY_R),
     {},
     [](Frame& frame) { frame.next.free_camera.reset(); }},
    {ActionId::play, image, "Play or pause the scene's time", plain(GLFW_KEY_P), {}, toggle_playing},
    {ActionId::time_forward,
     image,
     "A frame on in time",
     plain(GLFW_KEY_PERIOD),
     {},
     [](Frame& frame) { step_time(frame, 1); }},
    {ActionId::time_back,
     image,
     "A frame back in time",
     plain(GLFW_KEY_COMMA),
     {},
     [](Frame& frame) { step_time(frame, -1); }},
    {ActionId::reframe,
     views,
     "Turn the view inside back to the row",
     plain(GLFW_KEY_F),
     {},
     [](Frame& frame) { set_inside_state(frame.next, reframed(inside_state(frame.next))); }},
    {ActionId::maximise, views, "Maximise the pane under the mouse", plain(GLFW_KEY_M), {}, maximise},
    {ActionId::undo, session, "Undo", control(GLFW_KEY_Z), {}, [](Frame& frame) { frame.undo = true; }},
    {ActionId::redo, session, "Redo", control_shift(GLFW_KEY_Z), control(GLFW_KEY_Y),
     [](Frame& frame) { frame.redo = true; }},
    {ActionId::open_scene, session, "Open a scene", control(GLFW_KEY_O), {}, open_dialog<Dialog::open_scene>},
    {ActionId::open_session,
     session,
     "Open a session",
     control_shift(GLFW_KEY_O),
     {},
     open_dialog<Dialog::open_session>},
    {ActionId::save_session, session, "Save the session as", control(GLFW_KEY_S), control_shift(GLFW_KEY_S),
     open_dialog<Dialog::save_session>},
    {ActionId::theme, window, "Light or dark", plain(GLFW_KEY_T), {}, toggle_theme},
    {ActionId::larger_text, window, "Larger text", control(GLFW_KEY_EQUAL), control(GLFW_KEY_KP_ADD), scale_text<1>},
    {ActionId::smaller_text, window, "Smaller text", control(GLFW_KEY_MINUS), control(GLFW_KEY_KP_SUBTRACT),
     scale_text<-1>},
    {ActionId::stop, window, "Stop the work, close, show all panes", plain(GLFW_KEY_ESCAPE), {}, stop},
    {ActionId::make_again,
     window,
     "Go on after a stop",
     plain(GLFW_KEY_F5),
     {},
     [](Frame& frame) { resume(frame.background); }},
    {ActionId::keys, window, "This list", plain(GLFW_KEY_F1), {}, open_dialog<Dialog::keys>},
    {ActionId::quit, window, "Quit", control(GLFW_KEY_Q), {}, [](Frame& frame) { frame.ui.quitting = true; }},
}};

constexpr std::array<Gesture, 12> gesture_table{{
    {ray, "click in the image", "Select a pixel: its light rays fill the table"},
    {ray, "click in the view", "Go to the step that touched what lies there"},
    {ray, "point at a value", "Light what it is in the view inside"},
    {image, "drag", "Orbit the camera"},
    {image, "Shift or middle button, drag", "Move the camera sideways"},
    {image, "right button, drag", "Look around"},
    {image, "wheel", "Nearer or farther"},
    {image, "hold W A S D Q E", "Fly (with Shift faster)"},
    {image, "drag the lamp", "Move the selected light"},
    {views, "drag, Shift drag, wheel", "Turn, move, zoom the view inside"},
    {views, "double click on a title bar", "Maximise the pane"},
    {window, "drop a .gltf, .glb or .hdr file", "Open it"},
}};

bool same_key(const KeyPress& wanted, const KeyPress& pressed) {
    return wanted.key != 0 && wanted.key == pressed.key && wanted.control == pressed.control &&
           wanted.shift == pressed.shift && !pressed.alt;
}

std::string key_text(const KeyPress& press) {
    std::string text = press.control ? "Ctrl+" : "";
    if (press.shift) text += "Shift+";
    switch (press.key) {
        case GLFW_KEY_RIGHT:
            return text + "→";
        case GLFW_KEY_LEFT:
            return text + "←";
        case GLFW_KEY_UP:
            return text + "↑";
        case GLFW_KEY_DOWN:
            return text + "↓";
        case GLFW_KEY_SPACE:
            return text + "Space";
        case GLFW_KEY_BACKSPACE:
            return text + "Backspace";
        case GLFW_KEY_HOME:
            return text + "Home";
        case GLFW_KEY_END:
            return text + "End";
        case GLFW_KEY_ESCAPE:
            return text + "Esc";
        case GLFW_KEY_F1:
            return text + "F1";
        case GLFW_KEY_F5:
            return text + "F5";
        case GLFW_KEY_KP_ADD:
            return text + "keypad +";
        case GLFW_KEY_KP_SUBTRACT:
            return text + "keypad −";
        case GLFW_KEY_EQUAL:
            return text + "+";
        case GLFW_KEY_MINUS:
            return text + "−";
        default:
            return text + static_cast<char>(press.key);
    }
}

}  // namespace

std::span<const Action> actions() { return table; }

const Action& find_action(ActionId id) { return *std::ranges::find(table, id, &Action::id); }

std::string keys_text(const Action& action) {
    std::string text = key_text(action.key);
    if (action.other_key.key != 0) text += " or " + key_text(action.other_key);
    return text;
}

std::span<const Gesture> gestures() { return gesture_table; }

void run_keys(Frame& frame, std::span<const KeyPress> keys) {
    frame.escape = std::ranges::find(keys, GLFW_KEY_ESCAPE, &KeyPress::key) != keys.end();
    if (frame.ui.opened_dialog != Dialog::none) return;
    const bool typing = ImGui::GetIO().WantTextInput;
    for (const KeyPress& pressed : keys) {
        if (typing && !pressed.control && pressed.key != GLFW_KEY_F1) continue;
        for (const Action& action : table)
            if (same_key(action.key, pressed) || same_key(action.other_key, pressed)) action.run(frame);
    }
}

}  // namespace sightlines
