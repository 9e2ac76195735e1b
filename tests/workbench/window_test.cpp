// The whole program, as a user meets it.
#include <fstream>

#include <gtest/gtest.h>

#include "app/workbench/panes.h"
#include "driven_window.h"
#include "tests/app/run_program.h"
#include "tests/window/xvfb.h"  // last: it brings the macros of the X library

namespace sightlines {
namespace {

constexpr ImageSize screen{1024, 640};

/// Small enough to be quick, large enough that every pane has something to show.
Session small_session() {
    Session session;
    session.scene = "cornell";
    session.lights.count = 48;
    session.parameters["voxel_rows"] = {{"resolution", 64.0}, {"angle_step", 4.0}};
    session.workbench.fit_picture = true;
    return session;
}

Area body_of(PaneContent content, ImageSize window = screen) {
    const Layout layout;
    const Arrangement areas = arrange(layout, window, 1.0f);
    const auto place = std::ranges::find(layout.panes, content) - layout.panes.begin();
    return pane_body(areas.panes[static_cast<std::size_t>(place)], 1.0f);
}

vec2 within(const Area& area, vec2 share) { return glm::floor(area.corner + share * area.size); }

void write_text(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

TEST(Window, TakesAUserFromAPixelThroughItsStepsAndBack) {
    const auto folder = fresh_folder();
    const Xvfb display(screen);
    DrivenWindow window(folder, small_session());

    EXPECT_EQ(difference_from_golden(display, "started"), "");
    const Area image = body_of(PaneContent::image);
    click(within(image, {0.3f, 0.8f}));
    ASSERT_TRUE(session_becomes(window, [](const Session& session) { return session.selection.pixel.has_value(); }));
    const ivec2 pixel = *saved_session(window).selection.pixel;
    EXPECT_EQ(pixel, ivec2(within(image, {0.3f, 0.8f}) - image.corner));
    drive("mousemove 5 5");
    EXPECT_EQ(difference_from_golden(display, "picked"), "");

    drive("key Right sleep 0.1 key Right sleep 0.1 key Right sleep 0.1 key Left");
    ASSERT_TRUE(session_becomes(window, [](const Session& session) { return session.selection.step == 2; }));
    EXPECT_EQ(saved_session(window).selection.pixel, pixel);

    const Area inside = body_of(PaneContent::inside);
    drag(within(inside, {0.5f, 0.7f}), within(inside, {0.7f, 0.6f}));
    ASSERT_TRUE(session_becomes(
        window, [](const Session& session) { return !session.views.empty() && session.views[0].state.camera; }));
    drive("mousemove 5 5");
    EXPECT_EQ(difference_from_golden(display, "turned"), "");

    const Session before = saved_session(window);
    const Area parameters = body_of(PaneContent::parameters);
    click({parameters.end().x - 52.0f, parameters.corner.y + 71.0f});
    drive("key ctrl+a type 32");
    drive("key Return");
    ASSERT_TRUE(session_becomes(window, [](const Session& session) {
        return technique_parameters(session) == ParameterValues{{"resolution", 32.0}, {"angle_step", 4.0}};
    }));
    drive("mousemove 5 5");
    EXPECT_EQ(difference_from_golden(display, "coarser"), "");

    drive("key ctrl+z");
    EXPECT_TRUE(session_becomes(window, [&](const Session& session) { return session == before; }));

    write_text(folder / "broken.glb", "glTF, or so it says");
    drive("key ctrl+o sleep 0.3 type broken.glb");
    drive("key Return sleep 0.3 mousemove 5 5");
    EXPECT_EQ(difference_from_golden(display, "refused"), "");
    EXPECT_EQ(saved_session(window), before);

    drive("search --onlyvisible --class sightlines windowsize 900 620");
    const Area narrow = body_of(PaneContent::image, {900, 620});
    EXPECT_TRUE(session_becomes(window, [&](const Session& session) {
        return session.size == ImageSize{static_cast<int>(narrow.size.x), static_cast<int>(narrow.size.y)};
    }));

    drive("key ctrl+q");
    EXPECT_EQ(exit_code(window), 0);
    EXPECT_EQ(saved_session(window).selection.step, 2u);
}

TEST(Window, ChoosesFromAMenu) {
    const auto folder = fresh_folder();
    const Xvfb display(screen);
    DrivenWindow window(folder, small_session());
    EXPECT_EQ(difference_from_golden(display, "started"), "");
    const vec2 corner = body_of(PaneContent::image).corner;
    click(corner + vec2(130.0f, -16.0f));  // what the picture shows
    drive("sleep 0.5");
    click(corner + vec2(130.0f, 126.0f));  // the third of its rows
    EXPECT_TRUE(session_becomes(window, [](const Session& session) { return session.channel == Channel::shadow; }));
}

TEST(Window, ComesBackAsItWasAfterAKill) {
    const auto folder = fresh_folder();
    const Xvfb display(screen);
    Session left;
    {
        DrivenWindow window(folder, small_session());
        EXPECT_EQ(difference_from_golden(display, "started"), "");
        click(within(body_of(PaneContent::image), {0.6f, 0.7f}));
        ASSERT_TRUE(
            session_becomes(window, [](const Session& session) { return session.selection.pixel.has_value(); }));
        left = saved_session(window);
    }
    DrivenWindow window(folder, {});
    drive("key t");
    ASSERT_TRUE(
        session_becomes(window, [](const Session& session) { return session.workbench.theme == Theme::light; }));
    left.workbench.theme = Theme::light;
    EXPECT_EQ(saved_session(window), left);
}

TEST(Window, EndsWhenItIsClosedInTheMiddleOfABuild) {
    const auto folder = fresh_folder();
    const Xvfb display(screen);
    Session session = small_session();
    session.scene = "atrium";
    session.parameters["voxel_rows"] = {{"resolution", 96.0}, {"samples_per_voxel", 3.0}};
    DrivenWindow window(folder, session);
    drive("key ctrl+q");
    EXPECT_EQ(exit_code(window), 0);
    EXPECT_EQ(saved_session(window).scene, "atrium");
}

TEST(Window, EndsCleanlyWhenItIsToldToStop) {
    const auto folder = fresh_folder();
    const Xvfb display(screen);
    DrivenWindow window(folder, small_session());
    kill(window.process, SIGTERM);
    EXPECT_EQ(exit_code(window), 0);
}

TEST(Window, WritesALineForEachFrame) {
    const auto folder = fresh_folder();
    const Xvfb display(screen);
    DrivenWindow window(folder, small_session(), {"--frame-log", "frames.csv"});
    EXPECT_EQ(difference_from_golden(display, "started"), "");
    drive("mousemove 300 300 sleep 0.2 mousemove 320 300 sleep 0.2 key ctrl+q");
    ASSERT_EQ(exit_code(window), 0);
    std::ifstream log(folder / "frames.csv");
    std::string line;
    std::getline(log, line);
    EXPECT_EQ(line, "frame,start_s,milliseconds,working");
    int frames = 0;
    while (std::getline(log, line)) {
        int number = -1;
        double start_s = -1.0, milliseconds = -1.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%d,%lf,%lf,", &number, &start_s, &milliseconds), 3) << line;
        EXPECT_EQ(number, frames++);
        EXPECT_GT(milliseconds, 0.0);
    }
    EXPECT_GT(frames, 3);
}

TEST(Window, SaysThatThereIsNoDisplayAndEndsWithExitCode4) {
    const auto folder = fresh_folder();
    const DisplayHidden hidden;
    const ProgramRun run = run_program({"--session", "s.json"}, folder);
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_NE(run.errors.find("DISPLAY"), std::string::npos) << run.errors;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
}

}  // namespace
}  // namespace sightlines
