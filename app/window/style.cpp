#include "app/window/style.h"

#include <cmath>

#include "app/window/fonts.h"
#include "visualizers/theme.h"

namespace sightlines {
namespace {

/// 0xRRGGBB, as colours are written everywhere, in ImGui's order of bytes.
constexpr ImU32 rgb(unsigned hex, unsigned alpha = 255) {
    return IM_COL32(hex >> 16 & 255u, hex >> 8 & 255u, hex & 255u, alpha);
}

// Panes have the ground of the views (visualizers/theme.h), so that a view has no edge in its pane.
constexpr Colours dark_colours{.page = rgb(0x0D0F13),
                               .pane = rgb(0x14171C),
                               .header = rgb(0x1A1E25),
                               .raised = rgb(0x262C35),
                               .raised_hovered = rgb(0x303742),
                               .raised_active = rgb(0x3A4350),
                               .hairline = rgb(0x2A303A),
                               .ink = rgb(0xE8ECF2),
                               .muted = rgb(0x9AA4B2),
                               .faint = rgb(0x667080),
                               .accent = rgb(0x6AA6F8),
                               .accent_hovered = rgb(0x86B8FC),
                               .on_accent = rgb(0x0B1320),
                               .accent_wash = rgb(0x6AA6F8, 44),
                               .wrong = rgb(0xFF7B72),
                               .wrong_wash = rgb(0xFF7B72, 40),
                               .good = rgb(0x5DC994),
                               .code_keyword = rgb(0xC3A6F2),
                               .code_type = rgb(0x73C5D6),
                               .code_number = rgb(0xE3B76B),
                               .code_comment = rgb(0x8F9AA9),
                               .code_macro = rgb(0xEE9A78),
                               .code_text = rgb(0xDDE2EA)};

constexpr Colours light_colours{.page = rgb(0xE6E7E9),
                                .pane = rgb(0xFAFAF8),
                                .header = rgb(0xF1F1F0),
                                .raised = rgb(0xE6E8EB),
                                .raised_hovered = rgb(0xDBDEE3),
                                .raised_active = rgb(0xCED3DA),
                                .hairline = rgb(0xD6D9DE),
                                .ink = rgb(0x1B1F24),
                                .muted = rgb(0x5B6470),
                                .faint = rgb(0x9299A3),
                                .accent = rgb(0x2563EB),
                                .accent_hovered = rgb(0x1D51C6),
                                .on_accent = rgb(0xFFFFFF),
                                .accent_wash = rgb(0x2563EB, 34),
                                .wrong = rgb(0xBE2A25),
                                .wrong_wash = rgb(0xBE2A25, 30),
                                .good = rgb(0x166F42),
                                .code_keyword = rgb(0x7239B5),
                                .code_type = rgb(0x0B6A80),
                                .code_number = rgb(0x8E5400),
                                .code_comment = rgb(0x5D6673),
                                .code_macro = rgb(0xA9431B),
                                .code_text = rgb(0x1B1F24)};

/// Half of what is below shows through.
constexpr ImU32 faded(ImU32 colour) { return (colour & ~IM_COL32_A_MASK) | (128u << IM_COL32_A_SHIFT); }

void set_colours(ImGuiStyle& style, const Colours& c) {
    const auto set = [&](ImGuiCol which, ImU32 colour) {
        style.Colors[which] = ImGui::ColorConvertU32ToFloat4(colour);
    };
    constexpr ImU32 none = IM_COL32(0, 0, 0, 0);
    set(ImGuiCol_Text, c.ink);
    set(ImGuiCol_TextDisabled, c.faint);
    set(ImGuiCol_TextSelectedBg, c.accent_wash);
    set(ImGuiCol_WindowBg, c.pane);
    set(ImGuiCol_ChildBg, none);
    set(ImGuiCol_PopupBg, c.header);
    set(ImGuiCol_MenuBarBg, c.header);
    set(ImGuiCol_Border, c.hairline);
    set(ImGuiCol_BorderShadow, none);
    set(ImGuiCol_FrameBg, c.raised);
    set(ImGuiCol_FrameBgHovered, c.raised_hovered);
    set(ImGuiCol_FrameBgActive, c.raised_active);
    set(ImGuiCol_TitleBg, c.header);
    set(ImGuiCol_TitleBgActive, c.header);
    set(ImGuiCol_TitleBgCollapsed, c.header);
    set(ImGuiCol_ScrollbarBg, none);
    set(ImGuiCol_ScrollbarGrab, c.raised_active);
    set(ImGuiCol_ScrollbarGrabHovered, c.faint);
    set(ImGuiCol_ScrollbarGrabActive, c.muted);
    set(ImGuiCol_CheckMark, c.accent);
    set(ImGuiCol_SliderGrab, faded(c.accent));  // the value is written over it
    set(ImGuiCol_SliderGrabActive, faded(c.accent_hovered));
    set(ImGuiCol_Button, c.raised);
    set(ImGuiCol_ButtonHovered, c.raised_hovered);
    set(ImGuiCol_ButtonActive, c.raised_active);
    set(ImGuiCol_Header, c.accent_wash);
    set(ImGuiCol_HeaderHovered, c.raised_hovered);
    set(ImGuiCol_HeaderActive, c.raised_active);
    set(ImGuiCol_Separator, c.hairline);
    set(ImGuiCol_SeparatorHovered, c.accent);
    set(ImGuiCol_SeparatorActive, c.accent_hovered);
    set(ImGuiCol_ResizeGrip, none);
    set(ImGuiCol_ResizeGripHovered, c.raised_hovered);
    set(ImGuiCol_ResizeGripActive, c.raised_active);
    set(ImGuiCol_Tab, c.header);
    set(ImGuiCol_TabHovered, c.raised_hovered);
    set(ImGuiCol_TabActive, c.pane);
    set(ImGuiCol_TabUnfocused, c.header);
    set(ImGuiCol_TabUnfocusedActive, c.pane);
    set(ImGuiCol_PlotLines, c.muted);
    set(ImGuiCol_PlotLinesHovered, c.accent);
    set(ImGuiCol_PlotHistogram, c.accent);
    set(ImGuiCol_PlotHistogramHovered, c.accent_hovered);
    set(ImGuiCol_TableHeaderBg, c.header);
    set(ImGuiCol_TableBorderStrong, c.hairline);
    set(ImGuiCol_TableBorderLight, c.hairline);
    set(ImGuiCol_TableRowBg, none);
    set(ImGuiCol_TableRowBgAlt, none);
    set(ImGuiCol_DragDropTarget, c.accent);
    set(ImGuiCol_NavHighlight, c.accent);
    set(ImGuiCol_NavWindowingHighlight, c.accent);
    set(ImGuiCol_NavWindowingDimBg, IM_COL32(0, 0, 0, 96));
    set(ImGuiCol_ModalWindowDimBg, IM_COL32(0, 0, 0, 96));
}

}  // namespace

const Colours& colours(Theme theme) { return theme == Theme::dark ? dark_colours : light_colours; }

void apply_style(Theme theme, float scale) {
    const auto length = [scale](float design_pixels) { return std::round(design_pixels * scale); };
    const auto both = [&](float x, float y) { return ImVec2(length(x), length(y)); };
    ImGuiStyle style;
    style.WindowPadding = both(16.0f, 12.0f);
    style.FramePadding = both(8.0f, 4.0f);
    style.ItemSpacing = both(8.0f, 8.0f);
    style.ItemInnerSpacing = both(8.0f, 4.0f);
    style.CellPadding = both(8.0f, 4.0f);
    style.IndentSpacing = length(16.0f);
    style.ColumnsMinSpacing = length(8.0f);
    style.ScrollbarSize = length(10.0f);
    style.GrabMinSize = length(10.0f);
    style.WindowMinSize = both(64.0f, 32.0f);
    style.DisplaySafeAreaPadding = both(4.0f, 4.0f);
    style.WindowRounding = style.PopupRounding = length(6.0f);
    style.ChildRounding = style.FrameRounding = style.GrabRounding = style.TabRounding = length(4.0f);
    style.ScrollbarRounding = length(5.0f);
    style.WindowBorderSize = style.PopupBorderSize = style.ChildBorderSize = std::fmax(1.0f, std::floor(scale));
    style.FrameBorderSize = style.TabBorderSize = 0.0f;
    style.WindowTitleAlign = ImVec2(0.0f, 0.5f);
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.SelectableTextAlign = ImVec2(0.0f, 0.5f);
    style.DisabledAlpha = 0.45f;
    style.MouseCursorScale = scale;
    style.CircleTessellationMaxError = 0.15f;
    set_colours(style, colours(theme));
    ImGui::GetStyle() = style;
}

}  // namespace sightlines
