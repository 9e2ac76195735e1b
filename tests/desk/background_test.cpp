#include "app/desk/background.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "app/inside.h"
#include "app/report.h"
#include "tests/desk/desk_testing.h"

namespace sightlines {
namespace {

TEST(Background, PutsOutThePictureThatResultsMake) {
    Desk desk;
    const Session session = small_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown now = shown(desk.background);
    Results other(1, Backend::cpu);
    Progress progress;
    const auto picture = other.picture(session, progress);
    EXPECT_EQ(now.result->value.radiance, picture->value.radiance);
    EXPECT_EQ(now.picture->pixels, shown(picture->value.radiance, session.display));
    EXPECT_TRUE(now.measured.load_s && now.measured.build_s && now.measured.render_s && now.measured.rays_per_second);
    EXPECT_FALSE(now.measured.device.empty());
    EXPECT_FALSE(now.measured.visibility_percent);
    EXPECT_FALSE(now.picture_failure || now.ray_failure);
}

TEST(Background, ShowsNumbersThatGrow) {
    Desk desk;
    std::uint64_t number = 0, picture = 0;
    want(desk.background, small_session(), false);
    ASSERT_TRUE(desk.until([&](const Shown& now) {
        EXPECT_GE(now.number, number);
        number = now.number;
        if (!now.picture) return false;
        EXPECT_GE(now.picture->number, picture);
        picture = now.picture->number;
        return now.picture->state == PictureState::complete;
    }));
}

TEST(Background, ShadesAnewForTheLooksWithoutRendering) {
    Desk desk;
    Session session = small_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown before = shown(desk.background);
    session.display.exposure_stops = 1.0f;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown brighter = shown(desk.background);
    EXPECT_EQ(brighter.result, before.result);
    EXPECT_EQ(brighter.picture->pixels, shown(before.result->value.radiance, session.display));
    session.channel = Channel::shadow;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    EXPECT_EQ(shown(desk.background).picture->pixels, colour_mapped(before.result->value.shadow, 0.0f, 1.0f));
    EXPECT_EQ(shown(desk.background).result, before.result);
}

TEST(Background, ShadesAnewWhileTheNextStructureIsBuilt) {
    Desk desk;
    Session session = small_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown before = shown(desk.background);
    session.parameters["voxel_rows"] = {{"resolution", 256.0}, {"angle_step", 1.5}, {"build", 1.0}};
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return !now.structure; }));
    session.display.exposure_stops = 1.0f;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([&](const Shown& now) { return now.picture->session.display == session.display; }));
    const Shown now = shown(desk.background);
    EXPECT_FALSE(now.structure);
    EXPECT_EQ(now.result, before.result);
    EXPECT_EQ(now.picture->pixels, shown(before.result->value.radiance, session.display));
}

TEST(Background, ComparesWithTheReferenceWhereTheChannelDoes) {
    Desk desk;
    Session session = small_session();
    session.reference = true;
    session.channel = Channel::visibility_error;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown now = shown(desk.background);
    Results other(0, Backend::cpu);
    Progress progress;
    const auto errors = other.errors(session, progress);
    EXPECT_DOUBLE_EQ(now.measured.visibility_percent.value(), errors->value.visibility_percent);
    EXPECT_DOUBLE_EQ(now.measured.shadow_percent.value(), errors->value.shadow_percent);
    EXPECT_EQ(now.picture->pixels, colour_mapped(errors->value.visibility_error, 0.0f, 0.5f));
    session.channel = Channel::reference;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const auto reference = other.reference(session, progress);
    EXPECT_EQ(shown(desk.background).picture->pixels, shown(reference->value.radiance, session.display));
    EXPECT_EQ(shown(desk.background).result, now.result);
}

TEST(Background, ShowsTheDictionaryAndWhatCompressionChanged) {
    Desk desk;
    Session session = small_session();
    session.parameters["voxel_rows"]["compression"] = 1.0;
    session.parameters["voxel_rows"]["dictionary_rows"] = 1024.0;
    session.channel = Channel::compression;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    Results other(0, Backend::cpu);
    Progress progress;
    EXPECT_EQ(shown(desk.background).picture->pixels,
              colour_mapped(other.compression(session, progress)->value.visibility_error, 0.0f, compression_shown));
    show_figure(session, "dictionary");
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until(
        [](const Shown& now) { return now.inside && std::holds_alternative<DictionaryPicture>(*now.inside); }));
    session.parameters["voxel_rows"]["compression"] = 0.0;  // then there is none to show
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until(
        [](const Shown& now) { return now.inside && std::holds_alternative<VoxelRowPicture>(*now.inside); }));
}

TEST(Background, KeepsTheErrorsWhileOnlyTheSelectionChanges) {
    Desk desk;
    Session session = small_session();
    session.reference = true;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown before = shown(desk.background);
    session.selection.pixel = ivec2(20, 25);
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([&](const Shown& now) {
        EXPECT_EQ(now.errors, before.errors);
        EXPECT_EQ(now.picture, before.picture);
        return now.ray && now.ray->pixel == ivec2(20, 25);
    }));
}

TEST(Background, KeepsThePictureWhereTheNextSceneCannotBeReadAndSaysWhy) {
    Desk desk;
    const Session session = small_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown before = shown(desk.background);
    Session broken = session;
    broken.scene = "nowhere.glb";
    want(desk.background, broken, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.picture_failure.has_value(); }));
    const Shown after = shown(desk.background);
    EXPECT_NE(after.picture_failure->message.find("nowhere.glb"), std::string::npos);
    EXPECT_EQ(after.picture_failure->session, broken);
    EXPECT_FALSE(after.picture_failure->environment);
    EXPECT_EQ(after.picture, before.picture);
    EXPECT_EQ(after.scene, before.scene);
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return !now.picture_failure && now.work.empty(); }));
}

TEST(Background, FollowsTheRaysOfTheMiddleWithoutASelection) {
    Desk desk;
    const Session session = small_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.rays && now.ray && now.inside; }));
    Progress progress;
    const SelectedRay ray = select_ray(session, desk.results, progress);
    const Shown now = shown(desk.background);
    EXPECT_EQ(now.ray->pixel, ray.pixel);
    EXPECT_EQ(now.ray->light, ray.light);
    EXPECT_EQ(now.rays->pixel, ray.pixel);
    EXPECT_EQ(now.ray->trace.steps.size(), ray.trace.steps.size());
}

TEST(Background, RecordsOnlyTheOtherRayWhereAnotherLightIsChosen) {
    Desk desk;
    Session session = small_session();
    session.selection.pixel = ivec2(24, 28);
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.rays && now.ray && now.inside; }));
    const Shown before = shown(desk.background);
    ASSERT_GE(before.rays->rows.size(), 2u);
    const auto other = before.rays->rows[before.rays->rows[0].light == before.ray->light ? 1 : 0].light;
    session.selection.light = other;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.followed(other));
    EXPECT_EQ(shown(desk.background).rays, before.rays);
}

TEST(Background, SaysWhyThereIsNoRayAndKeepsTheLast) {
    Desk desk;
    Session session = small_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.rays && now.ray && now.inside; }));
    const Shown before = shown(desk.background);
    session.selection.light = 99;
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.ray_failure.has_value(); }));
    EXPECT_EQ(shown(desk.background).ray, before.ray);
    EXPECT_NE(shown(desk.background).ray_failure->message.find("99"), std::string::npos);
    session.selection.light = before.ray->light;
    want(desk.background, session, false);
    EXPECT_TRUE(desk.until([](const Shown& now) { return !now.ray_failure; }));
}

TEST(Background, SharesTheVoxelsOfRaysOfOneDirection) {
    Desk desk;
    Session session = small_session();
    session.selection.pixel = ivec2(24, 28);
    session.selection.light = 0;
    Progress progress;
    const auto lights = asked_lights(desk.results.surfaces(session, progress)->value, 28 * 48 + 24,
                                     desk.results.lights(session, progress)->value);
    ASSERT_GE(lights.size(), 2u);
    std::shared_ptr<const std::vector<std::uint8_t>> voxels;
    for (const std::uint32_t light : {lights[0], lights[1], lights[0]}) {
        session.selection.light = light;
        want(desk.background, session, false);
        ASSERT_TRUE(desk.followed(light));
        const auto occupied = std::get<VoxelRowPicture>(*shown(desk.background).inside).occupied;
        if (light != lights[0]) continue;
        EXPECT_TRUE(!voxels || occupied == voxels);
        voxels = occupied;
    }
}

TEST(Background, StopsWhenToldAndGoesOnWhenToldSo) {
    Desk desk;
    const Session session = long_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return !now.work.empty(); }));
    cancel(desk.background);
    ASSERT_TRUE(desk.until([](const Shown& now) { return now.cancelled && now.work.empty(); }));
    EXPECT_FALSE(shown(desk.background).result);
    EXPECT_FALSE(shown(desk.background).picture_failure);
    resume(desk.background);
    EXPECT_FALSE(shown(desk.background).cancelled);
    ASSERT_TRUE(desk.until([](const Shown& now) { return !now.work.empty(); }));
}

TEST(Background, GoesOnWithTheNextChangeAfterACancel) {
    Desk desk;
    want(desk.background, long_session(), false);
    ASSERT_TRUE(desk.until([](const Shown& now) { return !now.work.empty(); }));
    cancel(desk.background);
    want(desk.background, small_session(), false);
    EXPECT_TRUE(desk.complete(small_session()));
    EXPECT_FALSE(shown(desk.background).cancelled);
}

TEST(Background, DropsWhatIsUnderWayForANewerSession) {
    Desk desk;
    Session session = small_session();
    want(desk.background, long_session(), false);
    for (std::uint32_t lights = 1; lights < 20; ++lights) {
        session.lights.count = lights;
        want(desk.background, session, false);
    }
    ASSERT_TRUE(desk.complete(session));
    EXPECT_EQ(shown(desk.background).lights->value.size(), 19u);
}

TEST(Background, EndsInTheMiddleOfABuild) {
    for (int round = 0; round < 4; ++round) {
        Desk desk;
        want(desk.background, long_session(), round % 2 == 1);
        if (round == 0) continue;
        ASSERT_TRUE(
            desk.until([&](const Shown& now) { return !now.work.empty() && now.work[0].fraction >= 0.02 * round; }));
    }
}

TEST(Background, EndsBeforeItHasBegun) { const Desk desk; }

TEST(Background, TriesASceneAndLeavesWhatIsThere) {
    Desk desk;
    const Session session = small_session();
    want(desk.background, session, false);
    ASSERT_TRUE(desk.complete(session));
    const Shown before = shown(desk.background);
    for (const std::string scene : {"trees", "nowhere.glb"}) {
        try_scene(desk.background, scene);
        std::optional<SceneTrial> trial;
        ASSERT_TRUE(desk.watch.until([&] {
            trial = take_trial(desk.background);
            return trial.has_value();
        }));
        EXPECT_EQ(trial->scene, scene);
        EXPECT_EQ(trial->failure.has_value(), scene == "nowhere.glb");
        EXPECT_FALSE(take_trial(desk.background));
    }
    EXPECT_EQ(shown(desk.background).picture, before.picture);
    EXPECT_EQ(shown(desk.background).scene, before.scene);
    EXPECT_FALSE(shown(desk.background).picture_failure);
}

TEST(Background, SaysWhatItDoesAndHowFarItIs) {
    Desk desk;
    want(desk.background, long_session(), false);
    ASSERT_TRUE(desk.until([](const Shown& now) {
        if (now.work.empty()) return false;
        EXPECT_FALSE(now.work[0].title.empty());
        EXPECT_GE(now.work[0].fraction, 0.0);
        EXPECT_LE(now.work[0].fraction, 1.0);
        EXPECT_GE(now.work[0].elapsed_s, 0.0);
        return now.work[0].fraction > 0.0;
    }));
}

/// The nice values of this process's threads, the main thread's first.
std::vector<int> nice_values() {
    std::vector<int> values;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream stat(task.path() / "stat");
        std::string text;
        std::getline(stat, text);
        std::istringstream fields(text.substr(text.rfind(')') + 2));
        std::string field;
        for (int skipped = 3; skipped < 19; ++skipped) fields >> field;  // nice is the 19th field; the 3rd comes first
        int nice = 0;
        fields >> nice;
        const bool is_main = task.path().filename() == std::to_string(getpid());
        values.insert(is_main ? values.begin() : values.end(), nice);
    }
    return values;
}

TEST(Background, LeavesTheProcessorToTheMainThread) {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "the thread sanitizer has a thread of its own";
#endif
    // In a process of its own, from its start: another test's threads would be counted too.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            Desk desk;
            const Session session = small_session();
            want(desk.background, session, false);
            if (!desk.complete(session)) std::exit(1);
            const std::vector<int> values = nice_values();
            if (values.size() < 3) std::exit(2);  // the two lanes at least
            for (std::size_t i = 1; i < values.size(); ++i)
                if (values[i] <= values[0]) std::exit(3);
            std::exit(0);
        },
        testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace sightlines
