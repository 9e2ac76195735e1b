// Where everything in the window is: a pure function of the layout and the window's size.
#pragma once

#include <array>
#include <optional>

#include "app/session.h"

namespace sightlines {

/// A rectangle in the window's pixels, (0, 0) at the top left.
struct Area {
    vec2 corner{0.0f}, size{0.0f};

    vec2 end() const { return corner + size; }
    bool contains(vec2 point) const {
        return glm::all(glm::greaterThanEqual(point, corner)) && glm::all(glm::lessThan(point, end()));
    }
    bool operator==(const Area&) const = default;
};

/// The five lines that can be dragged, named for the share in the layout that each sets.
enum class Splitter { main_width, upper_height, upper_left, lower_left, lower_middle };
constexpr std::size_t splitter_count = 5;

/// All areas of one frame. Panes that are hidden by a maximised one are empty.
struct Arrangement {
    Area top_bar, step_bar, status_bar;
    std::array<Area, pane_count> panes;          ///< by PanePlace
    std::array<Area, splitter_count> splitters;  ///< by Splitter: a band that the mouse may take hold of
};

/// `scale`: pixels for one design pixel. No pane is smaller than can be read as long as the window has at least
/// 800 x 600 design pixels; below that they shrink alike.
Arrangement arrange(const Layout& layout, ImageSize window, float scale);

/// The layout with that splitter dragged to `position` (window's pixels), as far as the panes' smallest sizes allow.
Layout dragged(Layout layout, Splitter splitter, vec2 position, ImageSize window, float scale);

/// The layout with `content` shown at `place`; what was there goes to where `content` was.
Layout with_content(Layout layout, PanePlace place, PaneContent content);

}  // namespace sightlines
