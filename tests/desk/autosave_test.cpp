#include "app/desk/autosave.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "techniques/base/files.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

fs::path empty_folder(const std::string& name) {
    const fs::path folder = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / "desk" / (name + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

Session with_step(std::uint32_t step) {
    Session session;
    session.selection.step = step;
    return session;
}

/// The state folder is another for as long as this lives.
struct StateHome {
    explicit StateHome(const fs::path& folder) { setenv("XDG_STATE_HOME", folder.c_str(), 1); }
    StateHome(const StateHome&) = delete;
    StateHome& operator=(const StateHome&) = delete;
    ~StateHome() { unsetenv("XDG_STATE_HOME"); }
};

TEST(Autosave, BringsTheSessionBack) {
    const fs::path file = empty_folder("back") / "state" / "session.json";
    {
        Autosave autosave(file);
        save_soon(autosave, with_step(1));
        save_soon(autosave, with_step(2));
    }
    const OwnSession loaded = load_own_session(file);
    EXPECT_EQ(loaded.session, with_step(2));
    EXPECT_EQ(loaded.message, "");
}

TEST(Autosave, WritesByItself) {
    const fs::path file = empty_folder("itself") / "session.json";
    Autosave autosave(file);
    save_soon(autosave, with_step(3));
    // It promises half a second; a machine that is stuck gets more.
    for (int wait = 0; wait < 1000 && !fs::exists(file); ++wait)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(load_own_session(file).session, with_step(3));
}

TEST(Autosave, WritesAtOnceWhenAsked) {
    const fs::path file = empty_folder("now") / "session.json";
    Autosave autosave(file);
    save_soon(autosave, with_step(4));
    save_now(autosave);
    EXPECT_EQ(load_own_session(file).session, with_step(4));
}

TEST(Autosave, KeepsTheScenesPathWhereverItLies) {
    const fs::path file = empty_folder("path") / "session.json";
    Session session;
    session.scene = "/somewhere/else/room.glb";
    save_own_session(file, session);
    EXPECT_EQ(load_own_session(file).session, session);
    session.scene = "room.glb";
    save_own_session(file, session);
    EXPECT_EQ(load_own_session(file).session.scene, fs::absolute("room.glb").string());
}

TEST(Autosave, SaysWhyItCannotSave) {
    const fs::path folder = empty_folder("denied");
    write_file(folder / "state", std::string_view("a file where the folder should be"));
    Autosave autosave(folder / "state" / "session.json");
    save_soon(autosave, with_step(1));
    save_now(autosave);
    EXPECT_NE(save_failure(autosave).find("state"), std::string::npos) << save_failure(autosave);
}

TEST(Autosave, StartsAnewFromABrokenFileAndKeepsIt) {
    const fs::path folder = empty_folder("broken");
    for (const std::string text : {"{ \"scene\": ", "[1, 2]", "{ \"invented_by_a_newer_version\": 1 }", ""}) {
        write_file(folder / "session.json", text);
        const OwnSession loaded = load_own_session(folder / "session.json");
        EXPECT_EQ(loaded.session, Session{}) << text;
        EXPECT_NE(loaded.message.find("session.broken.json"), std::string::npos) << loaded.message;
        EXPECT_FALSE(fs::exists(folder / "session.json"));
        const auto kept = read_file(folder / "session.broken.json", 1000);
        EXPECT_EQ(std::string(kept.begin(), kept.end()), text);
    }
}

TEST(Autosave, StartsAnewWithoutAWordWhereThereIsNoFile) {
    const OwnSession loaded = load_own_session(empty_folder("none") / "session.json");
    EXPECT_EQ(loaded.session, Session{});
    EXPECT_EQ(loaded.message, "");
}

TEST(Autosave, LeavesAWholeSessionWheneverTheProcessIsKilled) {
    const fs::path file = empty_folder("killed") / "session.json";
    save_own_session(file, with_step(0));
    std::uint32_t latest = 0;
    for (int round = 0; round < 12; ++round) {
        int saved[2] = {};
        ASSERT_EQ(pipe(saved), 0);
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            for (std::uint32_t step = latest;; ++step) {
                save_own_session(file, with_step(step));
                if (write(saved[1], "s", 1) != 1) _exit(1);
            }
        }
        char byte = 0;
        for (int heard = 0; heard < round % 4; ++heard) ASSERT_EQ(read(saved[0], &byte, 1), 1);
        std::this_thread::sleep_for(std::chrono::microseconds(137 * round));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        close(saved[0]);
        close(saved[1]);
        const OwnSession loaded = load_own_session(file);
        ASSERT_EQ(loaded.message, "");
        ASSERT_GE(loaded.session.selection.step, latest);
        latest = loaded.session.selection.step;
        ASSERT_EQ(loaded.session, with_step(latest));
    }
    EXPECT_GT(latest, 0u);
    const Autosave autosave(file);
    for (const auto& entry : fs::directory_iterator(file.parent_path()))
        EXPECT_EQ(entry.path().filename(), "session.json") << "left by a process that was killed";
}

TEST(RecentScenes, AreTheNewestFirstAndEachOnce) {
    const StateHome home(empty_folder("recent"));
    EXPECT_TRUE(recent_scenes().empty());
    remember_scene("/a.glb");
    remember_scene("/b.glb");
    remember_scene("/a.glb");
    remember_scene("cornell");
    EXPECT_EQ(recent_scenes(), (std::vector<std::string>{"/a.glb", "/b.glb"}));
    for (int i = 0; i < 20; ++i) remember_scene("/" + std::to_string(i) + ".glb");
    EXPECT_EQ(recent_scenes().size(), 12u);
    EXPECT_EQ(recent_scenes().front(), "/19.glb");
}

TEST(RecentScenes, AreNoneWhereTheListIsBroken) {
    const StateHome home(empty_folder("recent_broken"));
    fs::create_directories(state_folder());
    write_file(state_folder() / "recent.json", std::string_view("{\"scenes\": 7"));
    EXPECT_TRUE(recent_scenes().empty());
    remember_scene("/a.glb");
    EXPECT_EQ(recent_scenes(), std::vector<std::string>{"/a.glb"});
}

}  // namespace
}  // namespace sightlines
