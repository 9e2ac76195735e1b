#include "app/workbench/widgets.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "app/table.h"

namespace sightlines {
namespace {

constexpr const char* ellipsis = "…";

/// The start of the UTF-8 character before `at`.
std::size_t character_before(std::string_view text, std::size_t at) {
    do {
        --at;
    } while (at > 0 && (static_cast<unsigned char>(text[at]) & 0xC0u) == 0x80u);
    return at;
}

}  // namespace

void begin_area(const Frame& frame, const char* name, const Area& area, ImU32 ground, vec2 padding, Layer layer,
                ImGuiWindowFlags flags) {
    ImGui::SetNextWindowPos(to_imgui(area.corner));
    ImGui::SetNextWindowSize(to_imgui(glm::max(area.size, vec2(1.0f))));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, to_imgui(padding * frame.scale));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoBackground | flags |
                     (layer == Layer::behind ? ImGuiWindowFlags_NoBringToFrontOnFocus : 0));
    ImGui::PopStyleVar(4);
    if (ground == 0) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRectFullScreen();
    fill_opaque(frame.window, list, to_imgui(area.corner), to_imgui(area.size), ground);
    list.PopClipRect();
}

void text_in(ImFont* font, ImU32 colour, std::string_view text) {
    const FontScope scope(font);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    ImGui::PopStyleColor();
}

float width_of(ImFont* font, std::string_view text) {
    return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, text.data(), text.data() + text.size()).x;
}

std::string elided(ImFont* font, const std::string& text, float width) {
    if (width_of(font, text) <= width) return text;
    std::size_t end = text.size();
    const float room = width - width_of(font, ellipsis);
    while (end > 0 && width_of(font, std::string_view(text).substr(0, end)) > room) end = character_before(text, end);
    return text.substr(0, end) + ellipsis;
}

void elided_text(ImFont* font, ImU32 colour, const std::string& text, float width) {
    const std::string shown = elided(font, text, width);
    text_in(font, colour, shown);
    if (shown != text && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
}

void wrapped_text(ImFont* font, ImU32 colour, const std::string& text) {
    ImGui::PushTextWrapPos(0.0f);
    text_in(font, colour, text);
    ImGui::PopTextWrapPos();
}

void text_right(ImFont* font, ImU32 colour, std::string_view text, float right) {
    ImGui::SetCursorPosX(right - width_of(font, text));
    text_in(font, colour, text);
}

void empty_pane_text(const Frame& frame, const std::string& title, const std::string& how) {
    const ImVec2 room = ImGui::GetContentRegionAvail(), start = ImGui::GetCursorPos();
    const float width = std::min(room.x - 16.0f * frame.scale, 320.0f * frame.scale);
    struct Line {
        ImFont* font;
        std::string text;
    };
    std::vector<Line> lines;
    const auto add = [&](ImFont* font, const std::string& text) {
        const float letters = width / (0.87f * width_of(font, "n"));  // most are narrower
        for (const std::string& line : wrapped(text, static_cast<std::size_t>(std::max(letters, 8.0f))))
            lines.push_back({font, line});
    };
    add(frame.fonts.text_bold, title);
    add(frame.fonts.small, how);
    const float height = static_cast<float>(lines.size()) * ImGui::GetTextLineHeightWithSpacing();
    ImGui::SetCursorPosY(start.y + std::max(4.0f * frame.scale, 0.45f * (room.y - height)));
    for (const Line& line : lines) {
        ImGui::SetCursorPosX(start.x + 0.5f * (room.x - width_of(line.font, line.text)));
        text_in(line.font, frame.colours.muted, line.text);
    }
}

void tooltip(const Frame& frame, const std::string& text, const std::string& keys) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(320.0f * frame.scale);
    text_in(frame.fonts.small, frame.colours.ink, text);
    if (!keys.empty()) text_in(frame.fonts.small, frame.colours.muted, keys);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

namespace {

/// Draws in the square from (-1, -1) to (1, 1).
struct IconPen {
    ImDrawList& list;
    vec2 centre;
    float half, line;
    ImU32 colour;

    ImVec2 at(float x, float y) const { return {centre.x + x * half, centre.y + y * half}; }
    void stroke(std::initializer_list<vec2> points, bool closed = false) const {
        for (const vec2& point : points) list.PathLineTo(at(point.x, point.y));
        list.PathStroke(colour, closed ? ImDrawFlags_Closed : ImDrawFlags_None, line);
    }
    void arrow(float from, float to) const {
        list.AddTriangleFilled(at(from, -0.75f), at(to, 0.0f), at(from, 0.75f), colour);
    }
    void block(vec2 low, vec2 high) const { list.AddRectFilled(at(low.x, low.y), at(high.x, high.y), colour); }
    void turn(float side) const {
        stroke({{-0.35f * side, -0.85f}, {-0.8f * side, -0.35f}, {-0.35f * side, 0.15f}});
        stroke({{-0.8f * side, -0.35f},
                {0.3f * side, -0.35f},
                {0.65f * side, -0.15f},
                {0.75f * side, 0.2f},
                {0.6f * side, 0.55f},
                {0.25f * side, 0.75f},
                {-0.3f * side, 0.75f}});
    }
    void letter(const char* text) const {
        ImFont* const font = ImGui::GetFont();
        const float size = 1.35f * half;
        const ImVec2 extent = font->CalcTextSizeA(size, FLT_MAX, 0.0f, text);
        list.AddText(font, size, {centre.x - 0.5f * extent.x, centre.y - 0.5f * extent.y}, colour, text);
    }
};

}  // namespace

void draw_icon(ImDrawList& list, Icon icon, vec2 centre, float size, ImU32 colour) {
    const IconPen pen{list, centre, 0.5f * size, std::max(1.0f, 0.13f * size), colour};
    switch (icon) {
        case Icon::forward:
            return pen.arrow(-0.45f, 0.7f);
        case Icon::back:
            return pen.arrow(0.45f, -0.7f);
        case Icon::to_end:
            pen.arrow(-0.75f, 0.35f);
            return pen.block({0.45f, -0.75f}, {0.75f, 0.75f});
        case Icon::to_start:
            pen.arrow(0.75f, -0.35f);
            return pen.block({-0.75f, -0.75f}, {-0.45f, 0.75f});
        case Icon::play:
            return pen.arrow(-0.55f, 0.75f);
        case Icon::pause:
            pen.block({-0.6f, -0.7f}, {-0.15f, 0.7f});
            return pen.block({0.15f, -0.7f}, {0.6f, 0.7f});
        case Icon::undo:
            return pen.turn(1.0f);
        case Icon::redo:
            return pen.turn(-1.0f);
        case Icon::help:
            list.AddCircle(to_imgui(centre), pen.half, colour, 0, pen.line);
            return pen.letter("?");
        case Icon::close:
            pen.stroke({{-0.6f, -0.6f}, {0.6f, 0.6f}});
            return pen.stroke({{-0.6f, 0.6f}, {0.6f, -0.6f}});
        case Icon::maximise:
            return pen.stroke({{-0.7f, -0.7f}, {0.7f, -0.7f}, {0.7f, 0.7f}, {-0.7f, 0.7f}}, true);
        case Icon::restore:
            pen.stroke({{-0.75f, -0.2f}, {0.3f, -0.2f}, {0.3f, 0.75f}, {-0.75f, 0.75f}}, true);
            return pen.stroke({{-0.2f, -0.75f}, {0.75f, -0.75f}, {0.75f, 0.25f}});
        case Icon::stop:
            return pen.block({-0.6f, -0.6f}, {0.6f, 0.6f});
        case Icon::down:
            return pen.stroke({{-0.5f, -0.25f}, {0.0f, 0.3f}, {0.5f, -0.25f}});
        case Icon::check:
            return pen.stroke({{-0.7f, 0.0f}, {-0.2f, 0.5f}, {0.7f, -0.5f}});
        case Icon::frame:
            for (const float x : {-1.0f, 1.0f})
                for (const float y : {-1.0f, 1.0f})
                    pen.stroke({{0.75f * x, 0.3f * y}, {0.75f * x, 0.75f * y}, {0.3f * x, 0.75f * y}});
            return;
    }
}

bool icon_button(const Frame& frame, const char* id, Icon icon, bool enabled) {
    const float side = ImGui::GetFrameHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(id, {side, side}) && enabled;
    const bool hovered = enabled && ImGui::IsItemHovered();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (hovered)
        list.AddRectFilled(corner, {corner.x + side, corner.y + side},
                           ImGui::IsItemActive() ? frame.colours.raised_active : frame.colours.raised_hovered,
                           ImGui::GetStyle().FrameRounding);
    draw_icon(list, icon, {corner.x + 0.5f * side, corner.y + 0.5f * side}, std::round(13.0f * frame.scale),
              !enabled  ? frame.colours.faint
              : hovered ? frame.colours.ink
                        : frame.colours.muted);
    return pressed;
}

bool menu_button(const Frame& frame, const char* id, const std::string& text, float width) {
    const float arrow = std::round(9.0f * frame.scale), padding = ImGui::GetStyle().FramePadding.x;
    const float natural = width_of(ImGui::GetFont(), text) + arrow + 3.0f * padding;
    const ImVec2 size{width > 0.0f ? width : natural, ImGui::GetFrameHeight()};
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    // No PushID: the popup, once open, has a stack of its own, from which there would be nothing to pop.
    const std::string button = std::string("##") + id, menu = button + " menu";
    if (ImGui::InvisibleButton(button.c_str(), size)) ImGui::OpenPopup(menu.c_str());
    const bool lit = ImGui::IsItemHovered() || ImGui::IsPopupOpen(menu.c_str());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y},
                       lit ? frame.colours.raised_hovered : frame.colours.raised, ImGui::GetStyle().FrameRounding);
    const std::string shown = elided(ImGui::GetFont(), text, size.x - arrow - 3.0f * padding + 1.0f);
    list.AddText({corner.x + padding, corner.y + ImGui::GetStyle().FramePadding.y}, frame.colours.ink, shown.c_str());
    draw_icon(list, Icon::down, {corner.x + size.x - padding - 0.5f * arrow, corner.y + 0.5f * size.y}, arrow,
              frame.colours.muted);
    ImGui::SetNextWindowPos({corner.x, corner.y + size.y + 2.0f * frame.scale}, ImGuiCond_Appearing);
    return ImGui::BeginPopup(menu.c_str());
}

bool menu_item(const Frame& frame, const std::string& title, const std::string& about, bool chosen,
               const std::string& keys) {
    const float mark = 20.0f * frame.scale, padding = 4.0f * frame.scale;
    const float text_width =
        std::max(width_of(frame.fonts.text, title) +
                     (keys.empty() ? 0.0f : 32.0f * frame.scale + width_of(frame.fonts.small, keys)),
                 std::min(width_of(frame.fonts.small, about), 340.0f * frame.scale));
    const ImVec2 about_size = about.empty() ? ImVec2(0.0f, 0.0f)
                                            : frame.fonts.small->CalcTextSizeA(frame.fonts.small->FontSize, FLT_MAX,
                                                                               text_width + 1.0f, about.c_str());
    const float width = std::max(ImGui::GetContentRegionAvail().x, mark + text_width + 2.0f * padding);
    const float height = frame.fonts.text->FontSize + about_size.y + 2.0f * padding;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushID(title.c_str());
    const bool pressed = ImGui::InvisibleButton("##item", {width, height});
    ImGui::PopID();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered())
        list.AddRectFilled(corner, {corner.x + width, corner.y + height}, frame.colours.accent_wash,
                           ImGui::GetStyle().FrameRounding);
    if (chosen)
        draw_icon(list, Icon::check, {corner.x + 0.5f * mark, corner.y + padding + 0.5f * frame.fonts.text->FontSize},
                  std::round(11.0f * frame.scale), frame.colours.accent);
    list.AddText(frame.fonts.text, frame.fonts.text->FontSize, {corner.x + mark, corner.y + padding}, frame.colours.ink,
                 title.c_str());
    if (!keys.empty())
        list.AddText(frame.fonts.small, frame.fonts.small->FontSize,
                     {corner.x + width - padding - width_of(frame.fonts.small, keys), corner.y + padding},
                     frame.colours.muted, keys.c_str());
    if (!about.empty())
        list.AddText(frame.fonts.small, frame.fonts.small->FontSize,
                     {corner.x + mark, corner.y + padding + frame.fonts.text->FontSize}, frame.colours.muted,
                     about.c_str(), nullptr, text_width + 1.0f);
    if (pressed) ImGui::CloseCurrentPopup();
    return pressed;
}

bool toggle(const Frame& frame, const char* label, bool& value) {
    const float height = std::round(16.0f * frame.scale), width = std::round(28.0f * frame.scale);
    const float label_width = width_of(ImGui::GetFont(), label);
    const float row = ImGui::GetFrameHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float gap = 8.0f * frame.scale;
    const bool pressed = ImGui::InvisibleButton(label, {width + gap + label_width, row});
    if (pressed) value = !value;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float top = corner.y + 0.5f * (row - height);
    const bool hovered = ImGui::IsItemHovered();
    const ImU32 track = value ? (hovered ? frame.colours.accent_hovered : frame.colours.accent)
                              : (hovered ? frame.colours.raised_active : frame.colours.raised_hovered);
    list.AddRectFilled({corner.x, top}, {corner.x + width, top + height}, track, 0.5f * height);
    const float knob = corner.x + (value ? width - 0.5f * height : 0.5f * height);
    list.AddCircleFilled({knob, top + 0.5f * height}, 0.5f * height - 2.0f * frame.scale,
                         value ? frame.colours.on_accent : frame.colours.muted);
    list.AddText({corner.x + width + gap, corner.y + 0.5f * (row - ImGui::GetFontSize())}, frame.colours.ink, label);
    return pressed;
}

}  // namespace sightlines
