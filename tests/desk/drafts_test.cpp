#include <set>

#include <gtest/gtest.h>

#include "app/desk/refining.h"
#include "tests/desk/desk_testing.h"

namespace sightlines {
namespace {

Session wide_session() {
    Session session = small_session();
    session.size = {800, 450};
    return session;
}

Session moved(Session session, float by_m, Results& results) {
    Progress progress;
    Camera camera = session_camera(session, results.scene(session, progress)->value);
    camera.position.x += by_m;
    session.free_camera = camera;
    return session;
}

TEST(Drafts, ComeAtAPartOfTheSizeWhileAMouseDragsAndThenTheWholePicture) {
    Desk desk;
    Session session = wide_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const auto structure = shown(desk.background).structure;
    for (int step = 1; step <= 3; ++step) {
        session = moved(session, 0.05f, desk.results);
        want(desk.background, session, true);
        ASSERT_TRUE(desk.until([&](const Shown& now) {
            return now.picture->state == PictureState::draft && now.picture->session == session;
        }));
        EXPECT_EQ(shown(desk.background).picture->pixels.size, (ImageSize{200, 113}));
    }
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    EXPECT_EQ(shown(desk.background).picture->pixels.size, session.size);
    EXPECT_EQ(shown(desk.background).structure, structure);
}

TEST(Drafts, LeaveTheFullPictureWhereItWas) {
    Desk desk;
    const Session session = wide_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown before = shown(desk.background);
    Progress progress;
    const auto surfaces = desk.results.surfaces(session, progress);
    const Session other = moved(session, 0.3f, desk.results);
    want(desk.background, other, true);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.picture->state == PictureState::draft; }));
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    EXPECT_EQ(shown(desk.background).result, before.result);
    EXPECT_EQ(desk.results.surfaces(session, progress), surfaces);
}

TEST(Drafts, AreNeverLargerThanThePicture) {
    Desk desk;
    Session session = small_session();
    want(desk.background, session, true);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.picture && now.picture->state == PictureState::draft; }));
    EXPECT_EQ(shown(desk.background).picture->pixels.size, session.size);
}

TEST(Drafts, AreNotNeededWhereOnlyTheLooksAreDragged) {
    Desk desk;
    Session session = wide_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    session.display.exposure_stops = 0.7f;
    want(desk.background, session, true);
    ASSERT_TRUE(desk.until([&](const Shown& now) {
        EXPECT_NE(now.picture->state, PictureState::draft);
        return now.picture->session == session;
    }));
    EXPECT_EQ(shown(desk.background).picture->pixels.size, session.size);
}

TEST(Drafts, DoNotFollowRaysUntilTheMouseRests) {
    Desk desk;
    Session session = wide_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.inside && now.work.empty(); }));
    const Shown before = shown(desk.background);
    session = moved(session, 0.2f, desk.results);
    want(desk.background, session, true);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.picture->state == PictureState::draft; }));
    EXPECT_EQ(shown(desk.background).rays, before.rays);
    want(desk.background, session, false);
    EXPECT_TRUE(desk.until([&](const Shown& now) { return now.rays != before.rays; }));
}

TEST(Preview, ShowsTheSceneBeforeTheStructureIsThere) {
    Desk desk;
    Session session = long_session();
    session.size = {800, 450};
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.picture != nullptr; }));
    const Shown now = shown(desk.background);
    EXPECT_EQ(now.picture->state, PictureState::preview);
    EXPECT_EQ(now.picture->pixels.size, (ImageSize{200, 113}));
    EXPECT_FALSE(now.structure);
    const std::set<std::uint32_t> colours = [&] {
        std::set<std::uint32_t> found;
        for (const glm::u8vec4 pixel : now.picture->pixels.pixels)
            found.insert(static_cast<std::uint32_t>(pixel.r << 16 | pixel.g << 8 | pixel.b));
        return found;
    }();
    EXPECT_GT(colours.size(), 100u) << "a picture, not an empty page";
}

TEST(Preview, FollowsTheMouseThroughTimeThoughEveryMomentNeedsAStructure) {
    Desk desk;
    Session session = small_session();
    session.scene = "trees";
    session.parameters["voxel_rows"] = {{"resolution", 256.0}, {"angle_step", 3.0}};
    std::set<double> moments;
    ASSERT_TRUE(desk.until([&](const Shown& now) {
        session.time_s += 0.01;
        want(desk.background, session, true);
        if (now.picture) moments.insert(now.picture->session.time_s);
        return moments.size() == 3;
    }));
    EXPECT_GT(shown(desk.background).duration_s, 0.0);
}

TEST(Preview, IsLeftOutWhereOnlyTimeGoesOnAndStructuresAreQuick) {
    const Session before = wide_session();
    Session after = before;
    after.time_s = 0.5;
    Shown shown;
    shown.measured.build_s = 0.1;
    EXPECT_FALSE(follows_quickly(shown, after)) << "nothing is shown";
    shown.picture = std::make_shared<const PictureShown>(PictureShown{{}, before, PictureState::complete, 1});
    EXPECT_TRUE(follows_quickly(shown, after));
    Session other = after;
    other.scene = "bear";
    EXPECT_FALSE(follows_quickly(shown, other));
    other = after;
    other.parameters["voxel_rows"]["resolution"] = 96.0;
    EXPECT_FALSE(follows_quickly(shown, other));
    other = after;
    other.free_camera = Camera{};
    EXPECT_FALSE(follows_quickly(shown, other));
    shown.measured.build_s = 2.0;
    EXPECT_FALSE(follows_quickly(shown, after));
    shown.measured.build_s = 0.1;
    shown.picture = std::make_shared<const PictureShown>(PictureShown{{}, before, PictureState::preview, 1});
    EXPECT_FALSE(follows_quickly(shown, after)) << "the structure of this picture is not there yet";
    shown.measured.build_s.reset();
    EXPECT_FALSE(follows_quickly(shown, after));
}

TEST(Refinement, ShowsThePictureOfTheSameViewBecomingFiner) {
    Desk desk;
    Session session = wide_session();
    session.lights.count = 512;
    std::set<PictureState> states;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([&](const Shown& now) {
        if (!now.picture) return false;
        states.insert(now.picture->state);
        if (now.picture->state == PictureState::refining) {
            EXPECT_EQ(now.picture->pixels.size, session.size);
            for (const glm::u8vec4 pixel : now.picture->pixels.pixels) EXPECT_EQ(pixel.a, 255);
        }
        return now.picture->state == PictureState::complete;
    }));
    EXPECT_TRUE(states.contains(PictureState::refining));
}

}  // namespace
}  // namespace sightlines
