#include "app/workbench/layout.h"

#include <gtest/gtest.h>

namespace sightlines {
namespace {

struct Case {
    ImageSize window;
    float scale;
};
constexpr Case cases[] = {{{800, 600}, 1.0f},   {{1280, 720}, 1.0f},  {{1600, 900}, 1.0f}, {{2560, 1440}, 2.0f},
                          {{3840, 2160}, 1.0f}, {{3840, 2160}, 2.0f}, {{1600, 1200}, 2.0f}};

std::vector<Area> all_areas(const Arrangement& areas) {
    std::vector<Area> all(areas.panes.begin(), areas.panes.end());
    all.insert(all.end(), {areas.top_bar, areas.step_bar, areas.status_bar});
    return all;
}

bool overlap(const Area& a, const Area& b) {
    return a.corner.x < b.end().x && b.corner.x < a.end().x && a.corner.y < b.end().y && b.corner.y < a.end().y;
}

TEST(Layout, KeepsEveryAreaInsideTheWindowAndApart) {
    for (const Case& one : cases) {
        const std::vector<Area> areas = all_areas(arrange({}, one.window, one.scale));
        for (std::size_t i = 0; i < areas.size(); ++i) {
            EXPECT_GE(areas[i].corner.x, 0.0f);
            EXPECT_GE(areas[i].corner.y, 0.0f);
            EXPECT_LE(areas[i].end().x, static_cast<float>(one.window.width));
            EXPECT_LE(areas[i].end().y, static_cast<float>(one.window.height));
            for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(areas[i], areas[j])) << i << " and " << j;
        }
    }
}

TEST(Layout, GivesEveryPaneRoomToBeReadWhateverTheSharesAre) {
    for (const Case& one : cases)
        for (const float share : {0.05f, 0.3f, 0.5f, 0.95f}) {
            Layout layout;
            layout.main_width = layout.upper_height = layout.upper_left = share;
            layout.lower_left = layout.lower_middle = share;
            for (const Area& pane : arrange(layout, one.window, one.scale).panes) {
                EXPECT_GE(pane.size.x, 150.0f * one.scale);
                EXPECT_GE(pane.size.y, 110.0f * one.scale);
            }
        }
}

TEST(Layout, GivesPictureAndViewMostOfTheWindow) {
    const Arrangement areas = arrange({}, {1600, 900}, 1.0f);
    const auto area = [](const Area& a) { return a.size.x * a.size.y; };
    const float both = area(areas.panes[static_cast<std::size_t>(PanePlace::upper_left)]) +
                       area(areas.panes[static_cast<std::size_t>(PanePlace::upper_right)]);
    float panes = 0.0f;
    for (const Area& pane : areas.panes) panes += area(pane);
    EXPECT_GT(both, 0.5f * panes);
}

TEST(Layout, PutsASplitterWhereItIsDraggedTo) {
    constexpr ImageSize window{1600, 900};
    for (const Splitter splitter : {Splitter::main_width, Splitter::upper_height, Splitter::upper_left,
                                    Splitter::lower_left, Splitter::lower_middle}) {
        const auto middle_of = [&](const Layout& layout) {
            const Area area = arrange(layout, window, 1.0f).splitters[static_cast<std::size_t>(splitter)];
            return area.corner + 0.5f * area.size;
        };
        const vec2 to = middle_of({}) + vec2(-37.0f, -29.0f);
        const vec2 now = middle_of(dragged({}, splitter, to, window, 1.0f));
        if (splitter == Splitter::upper_height)
            EXPECT_NEAR(now.y, to.y, 1.0f);
        else
            EXPECT_NEAR(now.x, to.x, 1.0f);
    }
}

TEST(Layout, StopsASplitterAtTheSmallestPane) {
    const Layout layout = dragged({}, Splitter::upper_left, {-500.0f, 0.0f}, {1600, 900}, 1.0f);
    const Arrangement areas = arrange(layout, {1600, 900}, 1.0f);
    EXPECT_GT(areas.panes[static_cast<std::size_t>(PanePlace::upper_left)].size.x, 150.0f);
    // A drag back by a little moves it at once.
    const Layout back = dragged(layout, Splitter::upper_left, {200.0f, 0.0f}, {1600, 900}, 1.0f);
    EXPECT_GT(back.upper_left, layout.upper_left);
}

TEST(Layout, ShowsAMaximisedPaneAloneBetweenTheBars) {
    Layout layout;
    layout.maximised = PanePlace::lower_middle;
    const Arrangement areas = arrange(layout, {1000, 700}, 1.0f);
    for (std::size_t place = 0; place < pane_count; ++place) {
        if (static_cast<PanePlace>(place) == PanePlace::lower_middle) {
            EXPECT_EQ(areas.panes[place].size.x, 1000.0f);
            EXPECT_EQ(areas.panes[place].corner.y, areas.top_bar.end().y);
            EXPECT_EQ(areas.panes[place].end().y, areas.step_bar.corner.y);
        } else {
            EXPECT_EQ(areas.panes[place].size, vec2(0.0f));
        }
    }
    for (const Area& splitter : areas.splitters) EXPECT_EQ(splitter.size, vec2(0.0f));
}

TEST(Layout, SwapsContentsSoThatNoneIsLost) {
    const Layout layout = with_content({}, PanePlace::side, PaneContent::image);
    EXPECT_EQ(layout.panes[static_cast<std::size_t>(PanePlace::side)], PaneContent::image);
    EXPECT_EQ(layout.panes[static_cast<std::size_t>(PanePlace::upper_left)], PaneContent::parameters);
    EXPECT_EQ(with_content(layout, PanePlace::side, PaneContent::image), layout);
}

}  // namespace
}  // namespace sightlines
