// A scene that is played: by a clock of the test's own, so that no test depends on how fast the machine is.
#include "app/desk/playing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "desk_testing.h"
#include "tests/scene/gltf_testing.h"

namespace sightlines {
namespace {

using namespace std::chrono_literals;

const std::chrono::steady_clock::time_point begin{};

Session planes_session() {
    Session session = small_session();
    session.scene = "planes";
    return session;
}

/// What is shown when a picture of `session` has come so far.
Shown shown_picture(const Session& session, PictureState state) {
    Shown shown;
    shown.duration_s = 2.0;
    shown.picture = std::make_shared<const PictureShown>(PictureShown{{}, session, state, 1});
    return shown;
}

TEST(Playing, GoesOnWhenTheTechniquesOwnPictureOfTheMomentIsThere) {
    const Session session = planes_session();
    for (const PictureState state : {PictureState::draft, PictureState::refining, PictureState::complete})
        EXPECT_EQ(played_time_s({begin, 0.25}, session, shown_picture(session, state), begin + 500ms), 0.75);
}

TEST(Playing, WaitsThroughPreviewsAndPicturesOfOtherMomentsAndScenes) {
    Session session = planes_session();
    session.time_s = 0.5;
    EXPECT_EQ(played_time_s({begin, 0.0}, session, Shown{}, begin + 1s), 0.5);
    EXPECT_EQ(played_time_s({begin, 0.0}, session, shown_picture(session, PictureState::preview), begin + 1s), 0.5);
    Session other = session;
    other.time_s = 0.25;
    EXPECT_EQ(played_time_s({begin, 0.0}, session, shown_picture(other, PictureState::complete), begin + 1s), 0.5);
    other = session;
    other.scene = "bear";
    EXPECT_EQ(played_time_s({begin, 0.0}, session, shown_picture(other, PictureState::complete), begin + 1s), 0.5);
}

TEST(Playing, BeginsAgainAtTheEndOfTheScenesTime) {
    const Session session = planes_session();
    const Shown complete = shown_picture(session, PictureState::complete);
    EXPECT_EQ(played_time_s({begin, 1.75}, session, complete, begin + 500ms), 0.25);
    EXPECT_EQ(played_time_s({begin, 0.0}, session, complete, begin + 9s), 1.0);
}

TEST(Playing, GoesOnPastAMomentWhosePictureCannotBeMade) {
    const Session session = planes_session();
    Shown failed = shown_picture(session, PictureState::preview);
    failed.picture_failure = Failure{"no memory", session, true};
    EXPECT_EQ(played_time_s({begin, 0.0}, session, failed, begin + 1500ms), 1.5);
}

/// Plays so many moments as the window does, a twentieth of a second by the test's clock whenever it looks, and checks
/// that the time stands until the technique's own picture of it was shown.
void expect_plays(Session session, int moments) {
    Desk desk;
    std::chrono::steady_clock::time_point now = begin;
    const Playing playing{begin, 0.0};
    std::vector<double> played{session.time_s};
    want(desk.background, session, true);
    ASSERT_TRUE(desk.until([&](const Shown& shown) {
        if (shown.picture_failure) {
            ADD_FAILURE() << shown.picture_failure->message;
            return true;
        }
        now += 50ms;
        const double next_s = played_time_s(playing, session, shown, now);
        if (next_s == session.time_s) return false;
        EXPECT_NE(shown.picture->state, PictureState::preview);
        EXPECT_EQ(shown.picture->session.time_s, session.time_s);
        const auto elapsed_s = std::chrono::duration<double>(now - begin).count();
        EXPECT_NEAR(next_s, std::fmod(elapsed_s, shown.duration_s), 1e-9);
        session.time_s = next_s;
        played.push_back(next_s);
        want(desk.background, session, true);
        return static_cast<int>(played.size()) > moments;
    }));
}

/// A triangle that stands still and one that moves past it within two seconds, as a file.
std::string moving_triangle_file() {
    using namespace testing_gltf;
    Document document = triangle_document();
    document.root["nodes"] = json::array({{{"mesh", 0}, {"translation", {0, 0, 1}}}, {{"mesh", 0}}});
    document.root["scenes"][0]["nodes"] = {0, 1};
    const int times = document.add_floats({0, 2}, "SCALAR"), places = document.add_floats({-1, 0, 1, 1, 0, 1});
    document.root["animations"] = json::array(
        {{{"channels", json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})},
          {"samplers", json::array({{{"input", times}, {"output", places}, {"interpolation", "LINEAR"}}})}}});
    const std::filesystem::path file = test_folder() / "scene.gltf";
    save(file, document.text());
    return file.string();
}

TEST(Playing, ComesThroughMomentsWhoseStructureIsBuiltAnewAndThoseThatShareOne) {
    Session session = small_session();
    session.scene = moving_triangle_file();
    for (const double motion : {0.0, 1.0, 2.0}) {  // changes, whole, objects
        session.parameters["voxel_rows"]["motion"] = motion;
        expect_plays(session, 4);
    }
}

}  // namespace
}  // namespace sightlines
