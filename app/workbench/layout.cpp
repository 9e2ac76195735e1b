#include "app/workbench/layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightlines {
namespace {

// Design pixels, multiples of 8.
constexpr float top_bar_height = 48.0f, step_bar_height = 48.0f, status_bar_height = 24.0f;
constexpr float gap = 4.0f;   ///< between panes
constexpr float grip = 8.0f;  ///< the band around the gap that takes the mouse
constexpr float least_pane_width = 160.0f, least_pane_height = 120.0f, least_side_width = 216.0f;

/// `share` of `length`, kept `least_before` from the start and `least_after` from the end; where both do not fit, in
/// proportion to them. Whole pixels.
float divided(float share, float start, float length, float least_before, float least_after) {
    if (length < least_before + least_after)
        return std::round(start + length * least_before / (least_before + least_after));
    return std::round(std::clamp(start + share * length, start + least_before, start + length - least_after));
}

/// The positions of the five lines between the panes, in the window's pixels.
struct Lines {
    float left = 0.0f, top = 0.0f, right = 0.0f, bottom = 0.0f;  ///< around all panes
    float main_right = 0.0f, upper_bottom = 0.0f, upper_middle = 0.0f, lower_first = 0.0f, lower_second = 0.0f;
};

Lines lines_of(const Layout& layout, ImageSize window, float scale) {
    Lines lines;
    lines.top = std::round(top_bar_height * scale);
    lines.right = static_cast<float>(window.width);
    lines.bottom = std::max(
        lines.top, static_cast<float>(window.height) - std::round((step_bar_height + status_bar_height) * scale));
    const float least_width = least_pane_width * scale, least_height = least_pane_height * scale;
    lines.main_right = divided(layout.main_width, 0.0f, lines.right, 3.0f * least_width, least_side_width * scale);
    lines.upper_bottom = divided(layout.upper_height, lines.top, lines.bottom - lines.top, least_height, least_height);
    lines.upper_middle = divided(layout.upper_left, 0.0f, lines.main_right, least_width, least_width);
    lines.lower_first = divided(layout.lower_left, 0.0f, lines.main_right, least_width, 2.0f * least_width);
    const float rest = lines.main_right - lines.lower_first;
    const float share = (layout.lower_middle * lines.main_right - lines.lower_first) / std::max(rest, 1.0f);
    lines.lower_second = divided(share, lines.lower_first, rest, least_width, least_width);
    return lines;
}

Area area(float left, float top, float right, float bottom) {
    return {{left, top}, {std::max(right - left, 0.0f), std::max(bottom - top, 0.0f)}};
}

std::array<Area, splitter_count> splitters_of(const Lines& lines, float half_grip) {
    const auto upright = [&](float x, float top, float bottom) {
        return area(x - half_grip, top, x + half_grip, bottom);
    };
    return {upright(lines.main_right, lines.top, lines.bottom),
            area(lines.left, lines.upper_bottom - half_grip, lines.main_right, lines.upper_bottom + half_grip),
            upright(lines.upper_middle, lines.top, lines.upper_bottom),
            upright(lines.lower_first, lines.upper_bottom, lines.bottom),
            upright(lines.lower_second, lines.upper_bottom, lines.bottom)};
}

float& share_of(Layout& layout, Splitter splitter) {
    switch (splitter) {
        case Splitter::main_width:
            return layout.main_width;
        case Splitter::upper_height:
            return layout.upper_height;
        case Splitter::upper_left:
            return layout.upper_left;
        case Splitter::lower_left:
            return layout.lower_left;
        case Splitter::lower_middle:
            break;
    }
    return layout.lower_middle;
}

float position_of(const Lines& lines, Splitter splitter) {
    switch (splitter) {
        case Splitter::main_width:
            return lines.main_right;
        case Splitter::upper_height:
            return lines.upper_bottom;
        case Splitter::upper_left:
            return lines.upper_middle;
        case Splitter::lower_left:
            return lines.lower_first;
        case Splitter::lower_middle:
            break;
    }
    return lines.lower_second;
}

/// The share that puts the splitter at `coordinate`.
float share_at(const Lines& lines, Splitter splitter, float coordinate) {
    const bool level = splitter == Splitter::upper_height;
    const float start = level ? lines.top : 0.0f;
    const float end = level ? lines.bottom : splitter == Splitter::main_width ? lines.right : lines.main_right;
    return std::clamp((coordinate - start) / std::max(end - start, 1.0f), 0.05f, 0.95f);
}

}  // namespace

Arrangement arrange(const Layout& layout, ImageSize window, float scale) {
    const Lines lines = lines_of(layout, window, scale);
    const float step_height = std::round(step_bar_height * scale);
    Arrangement areas;
    areas.top_bar = area(0.0f, 0.0f, lines.right, lines.top);
    areas.step_bar = area(0.0f, lines.bottom, lines.right, lines.bottom + step_height);
    areas.status_bar = area(0.0f, lines.bottom + step_height, lines.right, static_cast<float>(window.height));
    const auto place = [&](PanePlace where) -> Area& { return areas.panes[static_cast<std::size_t>(where)]; };
    if (layout.maximised) {
        place(*layout.maximised) = area(lines.left, lines.top, lines.right, lines.bottom);
        return areas;
    }
    // Half a gap on each side of a line.
    const float half = std::max(1.0f, std::round(0.5f * gap * scale));
    place(PanePlace::upper_left) = area(lines.left, lines.top, lines.upper_middle - half, lines.upper_bottom - half);
    place(PanePlace::upper_right) =
        area(lines.upper_middle + half, lines.top, lines.main_right - half, lines.upper_bottom - half);
    place(PanePlace::lower_left) = area(lines.left, lines.upper_bottom + half, lines.lower_first - half, lines.bottom);
    place(PanePlace::lower_middle) =
        area(lines.lower_first + half, lines.upper_bottom + half, lines.lower_second - half, lines.bottom);
    place(PanePlace::lower_right) =
        area(lines.lower_second + half, lines.upper_bottom + half, lines.main_right - half, lines.bottom);
    place(PanePlace::side) = area(lines.main_right + half, lines.top, lines.right, lines.bottom);
    areas.splitters = splitters_of(lines, 0.5f * grip * scale);
    return areas;
}

Layout dragged(Layout layout, Splitter splitter, vec2 position, ImageSize window, float scale) {
    const Lines before = lines_of(layout, window, scale);
    share_of(layout, splitter) =
        share_at(before, splitter, splitter == Splitter::upper_height ? position.y : position.x);
    // What the panes' smallest sizes made of it is what is kept, so that the next drag starts where the line is.
    const Lines after = lines_of(layout, window, scale);
    share_of(layout, splitter) = share_at(after, splitter, position_of(after, splitter));
    return layout;
}

Layout with_content(Layout layout, PanePlace place, PaneContent content) {
    const auto elsewhere = std::ranges::find(layout.panes, content);
    PaneContent& here = layout.panes[static_cast<std::size_t>(place)];
    if (elsewhere != layout.panes.end()) *elsewhere = here;
    here = content;
    return layout;
}

}  // namespace sightlines
