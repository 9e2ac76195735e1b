// The look of the window: fonts, colours, spacing. An 8 pixel rhythm, one accent colour, light and dark.
#pragma once

#include <imgui.h>

#include "app/window/window.h"

namespace sightlines {

/// The fonts of the current frame; valid until the look changes. Greek, arrows and mathematical signs are in all.
struct Fonts {
    ImFont* text = nullptr;       ///< Inter, 14 design pixels
    ImFont* text_bold = nullptr;  ///< Inter semi-bold, 14
    ImFont* small = nullptr;      ///< Inter, 12: captions, units, help
    ImFont* mono = nullptr;       ///< JetBrains Mono, 13: numbers and source
};
const Fonts& fonts(const Window& window);

/// Colours by meaning, sRGB with alpha, in ImGui's packed form.
struct Colours {
    ImU32 page;    ///< behind and between the panes
    ImU32 pane;    ///< a pane's ground
    ImU32 header;  ///< a pane's title bar, the top bar, the bottom bar
    ImU32 raised;  ///< buttons, fields
    ImU32 raised_hovered, raised_active;
    ImU32 hairline;           ///< rules between things
    ImU32 ink, muted, faint;  ///< text: primary, secondary, disabled and placeholders. ink and muted >= 4.5 : 1 on pane
    ImU32 accent;             ///< the one accent colour: selection, the step, active controls
    ImU32 accent_hovered;
    ImU32 on_accent;          ///< text on it
    ImU32 accent_wash;        ///< a selected row, the lit source line: the accent thinned over the pane
    ImU32 wrong, wrong_wash;  ///< a wrong verdict, an error message (never by colour alone)
    ImU32 good;               ///< agreement, done
    ImU32 code_keyword, code_type, code_number, code_comment, code_macro, code_text;  ///< the source pane
};
const Colours& colours(Theme theme);

}  // namespace sightlines
