#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "techniques/base/error.h"
#include "techniques/compute/device.h"
#include "window_testing.h"

namespace sightlines {
namespace {

const WindowLook dark{.theme = Theme::dark};
const auto nothing = [](ImDrawList&) {};

/// An environment variable that is another for a while; null: not set.
struct ScopedVariable {
    ScopedVariable(const char* name_, const char* value) : name(name_) {
        if (const char* found = std::getenv(name)) before = found;
        set(value);
    }
    ~ScopedVariable() { set(before ? before->c_str() : nullptr); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

    void set(const char* value) const {
        if (value)
            setenv(name, value, 1);
        else
            unsetenv(name);
    }
    const char* name;
    std::optional<std::string> before;
};

/// What opening a window throws.
std::string opening_error() {
    try {
        const Window window("test", {800, 600});
    } catch (const EnvironmentError& error) {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(WindowFailures, WithoutADisplayTheMessageNamesTheVariable) {
    const ScopedVariable display("DISPLAY", nullptr), wayland("WAYLAND_DISPLAY", nullptr);
    const std::string error = opening_error();
    EXPECT_TRUE(contains(error, "DISPLAY is not set")) << error;
}

TEST(WindowFailures, ADisplayThatDoesNotAnswerIsNamed) {
    const ScopedVariable display("DISPLAY", ":54321"), wayland("WAYLAND_DISPLAY", nullptr);
    const std::string error = opening_error();
    EXPECT_TRUE(contains(error, "DISPLAY=:54321 cannot be opened")) << error;
}

TEST(WindowFailures, WithoutAVulkanDriverTheMessageNamesThePackage) {
    const Xvfb server({1000, 700});
    const ScopedVariable old_name("VK_ICD_FILENAMES", "/nowhere.json"), drivers("VK_DRIVER_FILES", "/nowhere.json");
    const std::string error = opening_error();
    EXPECT_TRUE(contains(error, "mesa-vulkan-drivers")) << error;
}

TEST(WindowFailures, ASoftwareDeviceThatIsSetUpForComputingOnlyIsRefusedWithTheRemedy) {
    const Xvfb server({1000, 700});
    const ScopedVariable width("LP_NATIVE_VECTOR_WIDTH", nullptr);
    const auto device = compute::open_device();  // the driver keeps its width as long as anyone uses it
    if (!contains(device->info.name, "512 bits")) GTEST_SKIP() << "the device is " << device->info.name;
    const std::string error = opening_error();
    EXPECT_TRUE(contains(error, "set LP_NATIVE_VECTOR_WIDTH=256")) << error;
}

TEST(WindowFailures, AfterAFailureAWindowCanBeOpened) {
    {
        const ScopedVariable display("DISPLAY", ":54321");
        EXPECT_NE(opening_error(), "no error");
    }
    const Xvfb server({1000, 700});
    EXPECT_EQ(opening_error(), "no error");
    EXPECT_EQ(opening_error(), "no error");
}

TEST(WindowFailures, AnErrorOfTheXProtocolIsNoReasonToEnd) {
    const Xvfb server({1000, 700});
    Window window("test", {800, 600});
    show_frame(window, dark, nothing);
    server.with_connection([](::Display* connection) {
        XDestroyWindow(connection, 0x7ffffff0);  // there is no such window
        XSync(connection, False);
    });
    show_frame(window, dark, nothing);
    EXPECT_EQ(framebuffer_size(window), (ImageSize{800, 600}));
}

/// Loses its display in the middle of work; what `save` is told goes to standard error.
[[noreturn]] void lose_the_display(void (*save)(void*)) {
    Xvfb server({1000, 700});
    Window window("test", {800, 600});
    char argument[] = "saved: all of it\n";
    on_display_lost(window, save, argument);
    for (int frame = 0;; ++frame) {
        if (frame == 3) server.stop();
        show_frame(window, dark, nothing);
    }
}

TEST(WindowFailuresDeathTest, ALostDisplaySavesTheSessionAndEndsWithOneLine) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto save = [](void* argument) { std::fputs(static_cast<const char*>(argument), stderr); };
    EXPECT_EXIT(lose_the_display(save), testing::ExitedWithCode(4),
                "^saved: all of it\nsightlines: the display was closed \\(the session is saved\\)\n$");
}

TEST(WindowFailuresDeathTest, ALostDisplayPromisesNothingWhereSavingFails) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto save = [](void*) { throw EnvironmentError("disk", "full"); };
    EXPECT_EXIT(lose_the_display(save), testing::ExitedWithCode(4), "^sightlines: the display was closed\n$");
}

}  // namespace
}  // namespace sightlines
