#include <algorithm>
#include <cmath>
#include <string>

#include "window_testing.h"

using namespace std::string_literals;

namespace sightlines {
namespace {

/// WCAG 2.1: from 1 (none) to 21 (black on white).
double contrast(ImU32 a, ImU32 b) {
    const auto luminance = [](ImU32 colour) {
        const auto linear = [](int byte) {
            const double value = byte / 255.0;
            return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
        };
        const glm::u8vec4 bytes = pixel(colour);
        return 0.2126 * linear(bytes.r) + 0.7152 * linear(bytes.g) + 0.0722 * linear(bytes.b);
    };
    const double brighter = std::max(luminance(a), luminance(b)), darker = std::min(luminance(a), luminance(b));
    return (brighter + 0.05) / (darker + 0.05);
}

/// A translucent colour over an opaque one.
ImU32 over(ImU32 wash, ImU32 ground) {
    const ImVec4 top = ImGui::ColorConvertU32ToFloat4(wash), below = ImGui::ColorConvertU32ToFloat4(ground);
    const auto mix = [&](float a, float b) { return top.w * a + (1.0f - top.w) * b; };
    return ImGui::ColorConvertFloat4ToU32({mix(top.x, below.x), mix(top.y, below.y), mix(top.z, below.z), 1.0f});
}

TEST(Style, TextCanBeReadOnEveryGroundItStandsOn) {
    EXPECT_NEAR(contrast(IM_COL32_BLACK, IM_COL32_WHITE), 21.0, 1.0e-9);
    for (const Theme theme : {Theme::dark, Theme::light, Theme::print}) {
        const Colours& c = colours(theme);
        for (const ImU32 ground : {c.page, c.pane, c.header, c.raised, c.raised_hovered, c.raised_active,
                                   over(c.accent_wash, c.pane), over(c.wrong_wash, c.pane)})
            EXPECT_GE(contrast(c.ink, ground), 4.5);
        for (const ImU32 ground : {c.page, c.pane, c.header, over(c.accent_wash, c.pane)})
            EXPECT_GE(contrast(c.muted, ground), 4.5);
        EXPECT_GE(contrast(c.on_accent, c.accent), 4.5);
        EXPECT_GE(contrast(c.on_accent, c.accent_hovered), 4.5);
        EXPECT_GE(contrast(c.wrong, over(c.wrong_wash, c.pane)), 4.5);
        for (const ImU32 ground : {c.pane, c.header, over(c.accent_wash, c.pane)}) {
            EXPECT_GE(contrast(c.good, ground), 4.5);
            EXPECT_GE(contrast(c.wrong, ground), 4.5);
        }
        EXPECT_GE(contrast(c.accent, c.pane), 4.5);
    }
}

TEST(Style, TheSourceCanBeReadOnTheLitLineToo) {
    for (const Theme theme : {Theme::dark, Theme::light}) {
        const Colours& c = colours(theme);
        for (const ImU32 colour :
             {c.code_keyword, c.code_type, c.code_number, c.code_comment, c.code_macro, c.code_text}) {
            EXPECT_GE(contrast(colour, c.pane), 4.5);
            EXPECT_GE(contrast(colour, over(c.accent_wash, c.pane)), 4.5);
        }
    }
}

TEST(Style, EveryFontHasTheSignsThatTheTextsUse) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    begin_frame(window, {}, 0.0);
    const Fonts& all = fonts(window);
    for (const ImFont* font : {all.text, all.text_bold, all.small, all.mono}) {
        ASSERT_NE(font, nullptr);
        for (const char32_t sign : U"Aé°²³·×½εθλπσφωΔΣΩ–—…‘’“”←→↑↓⇒≤≥≈≠∞√∈∩∪∑∫▲▼▶◀●○◆✓✗₀ᵥ"s)
            EXPECT_NE(font->FindGlyphNoFallback(static_cast<ImWchar>(sign)), nullptr)
                << "U+" << std::hex << static_cast<unsigned>(sign);
    }
    end_frame(window);
}

TEST(Style, NumbersInTheMonospacedFontLineUp) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    for (const float text_scale : {1.0f, 1.25f, 2.0f}) {
        begin_frame(window, {.theme = Theme::dark, .text_scale = text_scale}, 0.0);
        for (const char sign : std::string("0123456789.-+ abcxyzABC"))
            EXPECT_EQ(fonts(window).mono->GetCharAdvance(static_cast<ImWchar>(sign)),
                      fonts(window).mono->GetCharAdvance('0'));
        end_frame(window);
    }
}

}  // namespace
}  // namespace sightlines
