// The time of scenes that move: play, pause, a frame on or back, and a line to drag along.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/workbench/actions.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"
#include "techniques/scene/animation.h"

namespace sightlines {
namespace {

constexpr double frame_time_s = 1.0 / 24.0;

/// The line of the scene's time from its beginning to its end, with a handle.
void draw_time_line(Frame& frame, float width, double duration_s) {
    const float height = ImGui::GetFrameHeight(), radius = 6.0f * frame.scale;
    const vec2 corner = from_imgui(ImGui::GetCursorScreenPos());
    ImGui::InvisibleButton("time", {std::max(width, 1.0f), height});
    const float begin = corner.x + radius, length = std::max(width - 2.0f * radius, 1.0f);
    if (ImGui::IsItemActive()) {
        const double share = std::clamp(static_cast<double>((ImGui::GetMousePos().x - begin) / length), 0.0, 1.0);
        // The end of a loop is its beginning: the handle stops short of it.
        frame.next.time_s = std::min(share, 0.9999) * duration_s;
        frame.ui.playing.reset();
        frame.in_gesture = true;
    }
    const auto at = static_cast<float>(looped_time_s(frame.next.time_s, duration_s) / duration_s);
    const float middle = corner.y + 0.5f * height, handle = begin + at * length;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({begin, middle}, {begin + length, middle}, frame.colours.hairline, 2.0f * frame.scale);
    list.AddLine({begin, middle}, {handle, middle}, frame.colours.accent, 2.0f * frame.scale);
    list.AddCircleFilled({handle, middle}, radius, frame.colours.accent);
}

std::string time_text(double time_s, double duration_s) {
    char text[48];
    std::snprintf(text, sizeof text, "%5.2f / %.2f s", looped_time_s(time_s, duration_s), duration_s);
    return text;
}

void action_button(Frame& frame, ActionId id, Icon icon) {
    const Action& action = find_action(id);
    if (icon_button(frame, std::string(action.title).c_str(), icon)) action.run(frame);
    tooltip(frame, std::string(action.title), keys_text(action));
    ImGui::SameLine(0.0f, 0.0f);
}

}  // namespace

void draw_time(Frame& frame, float width) {
    const double duration_s = frame.shown.duration_s;
    if (duration_s <= 0.0) return;
    const float buttons = 3.0f * ImGui::GetFrameHeight(), gap = 8.0f * frame.scale;
    const std::string text = time_text(frame.next.time_s, duration_s);
    const float text_width = width_of(frame.fonts.mono, text);
    if (width < buttons) return;
    action_button(frame, ActionId::time_back, Icon::back);
    action_button(frame, ActionId::play, frame.ui.playing ? Icon::pause : Icon::play);
    action_button(frame, ActionId::time_forward, Icon::forward);
    const float room = width - buttons - 2.0f * gap;
    const bool with_text = room > text_width + 80.0f * frame.scale;
    const float line = std::min(room - (with_text ? text_width + gap : 0.0f), 320.0f * frame.scale);
    if (line < 32.0f * frame.scale) return;
    ImGui::SameLine(0.0f, gap);
    draw_time_line(frame, line, duration_s);
    tooltip(frame, "The scene's time. It begins again at its end.");
    if (!with_text) return;
    ImGui::SameLine(0.0f, gap);
    ImGui::AlignTextToFramePadding();
    text_in(frame.fonts.mono, frame.colours.muted, text);
}

void step_time(Frame& frame, int frames) {
    if (frame.shown.duration_s <= 0.0) return;
    frame.ui.playing.reset();
    // Through whole frames from the beginning, wherever playing or the handle has stopped.
    const double now = std::round(frame.next.time_s / frame_time_s) + frames;
    frame.next.time_s = looped_time_s(now * frame_time_s, frame.shown.duration_s);
}

void toggle_playing(Frame& frame) {
    if (frame.ui.playing || frame.shown.duration_s <= 0.0)
        frame.ui.playing.reset();
    else
        frame.ui.playing = Playing{std::chrono::steady_clock::now(), frame.next.time_s};
}

void go_on_playing(Frame& frame) {
    if (!frame.ui.playing) return;
    frame.in_gesture = true;  // drafts do, and all of it is one step of undo
    const double time_s =
        played_time_s(*frame.ui.playing, frame.session, frame.shown, std::chrono::steady_clock::now());
    if (time_s != frame.session.time_s) frame.next.time_s = time_s;
}

}  // namespace sightlines
