// The small things that panes are made of.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <imgui.h>

#include "app/workbench/frame.h"

namespace sightlines {

inline ImVec2 to_imgui(vec2 v) { return {v.x, v.y}; }
inline vec2 from_imgui(ImVec2 v) { return {v.x, v.y}; }
/// An sRGB colour of the views' palette.
inline ImU32 packed(vec3 colour) { return ImGui::ColorConvertFloat4ToU32({colour.x, colour.y, colour.z, 1.0f}); }

/// How far the mouse may move in a click, in design pixels, and how much nearer one step of its wheel comes.
constexpr float click_slack = 4.0f, wheel_step = 1.12f;

/// Panes and bars lie behind; what overlaps them lies above, whatever is clicked.
enum class Layer { behind, above };
/// An ImGui window over exactly that area, without frame or title, closed by ImGui::End().
/// `ground` 0: none. `padding` in design pixels.
void begin_area(const Frame& frame, const char* name, const Area& area, ImU32 ground, vec2 padding, Layer layer,
                ImGuiWindowFlags flags = 0);

void text_in(ImFont* font, ImU32 colour, std::string_view text);
/// Ends in an ellipsis where it is wider than `width`; the whole text then shows on hover.
void elided_text(ImFont* font, ImU32 colour, const std::string& text, float width);
/// The text as far as it fits, with an ellipsis.
std::string elided(ImFont* font, const std::string& text, float width);
float width_of(ImFont* font, std::string_view text);
/// Text that wraps at the right edge of the content.
void wrapped_text(ImFont* font, ImU32 colour, const std::string& text);
/// Right edge at `right` (position in the window's content).
void text_right(ImFont* font, ImU32 colour, std::string_view text, float right);
/// In the middle of an otherwise empty pane: what will appear here, and how to make it appear.
void empty_pane_text(const Frame& frame, const std::string& title, const std::string& how);

/// A box of explanation beside the mouse while the last item is hovered.
void tooltip(const Frame& frame, const std::string& text, const std::string& keys = {});

enum class Icon {
    to_start,
    back,
    forward,
    to_end,
    play,
    pause,
    undo,
    redo,
    help,
    close,
    maximise,
    restore,
    stop,
    down,
    check,
    frame
};
/// A square button with a drawn symbol, as high as a text button. `enabled` false: shown faintly, does nothing.
bool icon_button(const Frame& frame, const char* id, Icon icon, bool enabled = true);
void draw_icon(ImDrawList& list, Icon icon, vec2 centre, float size, ImU32 colour);

/// A button that opens a menu: "Sponza v". True when the popup `id` is open: draw its items, then ImGui::EndPopup().
bool menu_button(const Frame& frame, const char* id, const std::string& text, float width = 0.0f);
/// One line of a menu with an explanation under it; true when chosen.
bool menu_item(const Frame& frame, const std::string& title, const std::string& about, bool chosen,
               const std::string& keys = {});

/// A switch with its label; true when it was changed.
bool toggle(const Frame& frame, const char* label, bool& value);

/// The font and its size as a scope.
struct FontScope {
    explicit FontScope(ImFont* font) { ImGui::PushFont(font); }
    ~FontScope() { ImGui::PopFont(); }
    FontScope(const FontScope&) = delete;
    FontScope& operator=(const FontScope&) = delete;
};

}  // namespace sightlines
