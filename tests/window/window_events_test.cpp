#include <algorithm>
#include <cstdlib>
#include <thread>

#include <GLFW/glfw3.h>

#include "window_testing.h"

namespace sightlines {
namespace {

constexpr glm::u8vec4 red{200, 10, 20, 255};
const WindowLook dark{.theme = Theme::dark};
const auto nothing = [](ImDrawList&) {};

/// Shows frames until `happened(events)`, at most some seconds; whether it did.
template <class Happened>
bool wait_until(Window& window, const Happened& happened) {
    for (int attempt = 0; attempt < 200; ++attempt) {
        const WindowEvents events = begin_frame(window, dark, 0.02);
        const bool now = happened(events);
        end_frame(window);
        if (now) return true;
    }
    return false;
}

/// Until the window is there to take keys and clicks.
void settle(Window& window) {
    for (int frame = 0; frame < 5; ++frame) show_frame(window, dark, nothing);
}

TEST(WindowEvents, TheFramebufferFollowsTheWindowsSize) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    settle(window);
    server.with_connection(
        [](::Display* connection) { XResizeWindow(connection, Xvfb::top_window(connection), 950, 650); });
    EXPECT_TRUE(wait_until(window, [&](const WindowEvents& events) {
        return events.any_input && framebuffer_size(window) == ImageSize{950, 650};
    }));
    const auto draw = [](ImDrawList& list) { list.AddRectFilled({940, 640}, {950, 650}, IM_COL32(200, 10, 20, 255)); };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(949, 649) == red; });
    EXPECT_EQ(seen.at(949, 649), red);
    EXPECT_EQ(seen.at(939, 639), pixel(colours(Theme::dark).page));
    EXPECT_EQ(ImGui::GetIO().DisplaySize.x, 950.0f);
}

TEST(WindowEvents, AWindowIsNeverSmallerThanItsContentsNeed) {
    const Xvfb server({1000, 700});
    Window window("test", {100, 100});
    settle(window);
    EXPECT_EQ(framebuffer_size(window), (ImageSize{800, 600}));
}

TEST(WindowEvents, TheWindowHasItsTitleAndItsClass) {
    const Xvfb server({1000, 700});
    Window window("first", {800, 600});
    settle(window);
    set_title(window, "second");
    settle(window);
    server.with_connection([](::Display* connection) {
        const ::Window shown = Xvfb::top_window(connection);
        char* name = nullptr;
        ASSERT_NE(XFetchName(connection, shown, &name), 0);
        EXPECT_STREQ(name, "second");
        XFree(name);
        XClassHint hint{};
        ASSERT_NE(XGetClassHint(connection, shown, &hint), 0);
        EXPECT_STREQ(hint.res_class, "sightlines");
        XFree(hint.res_name);
        XFree(hint.res_class);
    });
}

TEST(WindowEvents, TheUsersWishToCloseIsToldOnce) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    settle(window);
    server.with_connection([](::Display* connection) {
        XEvent message{};
        message.xclient.type = ClientMessage;
        message.xclient.window = Xvfb::top_window(connection);
        message.xclient.message_type = XInternAtom(connection, "WM_PROTOCOLS", False);
        message.xclient.format = 32;
        message.xclient.data.l[0] = static_cast<long>(XInternAtom(connection, "WM_DELETE_WINDOW", False));
        XSendEvent(connection, message.xclient.window, False, NoEventMask, &message);
    });
    EXPECT_TRUE(wait_until(window, [](const WindowEvents& events) { return events.closing; }));
    EXPECT_FALSE(begin_frame(window, dark, 0.0).closing);
    end_frame(window);
}

TEST(WindowEvents, AnotherThreadCanEndAWait) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    while (begin_frame(window, dark, 0.2).any_input) end_frame(window);  // until the opening's own events are over
    end_frame(window);
    std::thread waker([&] { wake(window); });
    // Without the wake this would outlast the test's time.
    const WindowEvents events = begin_frame(window, dark, 3600.0);
    waker.join();
    end_frame(window);
    EXPECT_FALSE(events.any_input);  // nobody touched it
    EXPECT_FALSE(events.closing);
}

TEST(WindowEvents, KeysAreSeenHoweverShortlyTheyAreDown) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    settle(window);
    ASSERT_EQ(std::system("xdotool mousemove 400 300 key ctrl+z key Return"), 0);
    // All of it has arrived before the next frame begins, so each key is up again by then.
    std::vector<KeyPress> keys;
    bool return_seen_by_imgui = false;
    wait_until(window, [&](const WindowEvents& events) {
        keys.insert(keys.end(), events.keys.begin(), events.keys.end());
        return_seen_by_imgui |= ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
        return std::ranges::any_of(keys, [](const KeyPress& press) { return press.key == GLFW_KEY_ENTER; });
    });
    const auto z = std::ranges::find(keys, static_cast<int>('Z'), &KeyPress::key);
    ASSERT_NE(z, keys.end());
    EXPECT_TRUE(z->control);
    EXPECT_FALSE(z->shift || z->alt || z->repeated);
    EXPECT_TRUE(return_seen_by_imgui);
    // And they are up afterwards.
    show_frame(window, dark, nothing);
    show_frame(window, dark, [](ImDrawList&) {
        EXPECT_FALSE(ImGui::IsKeyDown(ImGui::GetKeyIndex(ImGuiKey_Enter)));
        EXPECT_FALSE(ImGui::GetIO().KeyCtrl);
    });
}

TEST(WindowEvents, TheScaleIsTheMonitorsTimesTheText) {
    const Xvfb server({1000, 700}, 192);
    Window window("test", {800, 600});
    show_frame(window, dark, nothing);
    EXPECT_FLOAT_EQ(scale(window), 2.0f);
    const float size = fonts(window).text->FontSize;
    show_frame(window, {.theme = Theme::dark, .text_scale = 0.5f}, nothing);
    EXPECT_FLOAT_EQ(scale(window), 1.0f);
    EXPECT_NEAR(fonts(window).text->FontSize, 0.5f * size, 1.0f);
}

TEST(WindowEvents, AFrameThatWasNeverEndedDoesNotStopTheNext) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    begin_frame(window, dark, 0.0);
    const auto draw = [](ImDrawList& list) { list.AddRectFilled({0, 0}, {100, 100}, IM_COL32(200, 10, 20, 255)); };
    const ImageRgba8 seen =
        show_until(server, window, dark, draw, [](const ImageRgba8& p) { return p.at(50, 50) == red; });
    EXPECT_EQ(seen.at(50, 50), red);
}

}  // namespace
}  // namespace sightlines
