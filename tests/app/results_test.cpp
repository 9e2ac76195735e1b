#include "app/results.h"

#include <algorithm>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

Session small_session() {
    Session session;
    session.scene = "cornell";
    session.size = {32, 18};
    session.lights.count = 4;
    session.backend = BackendChoice::cpu;
    session.parameters["voxel_rows"] = {{"resolution", 32.0}, {"angle_step", 6.0}};
    return session;
}

TEST(Results, RebuildNothingWhenOnlyTheLooksChange) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    const auto picture = results.picture(session, progress);
    session.display.exposure_stops = 2.0f;
    session.selection.pixel = ivec2(1, 2);
    EXPECT_EQ(results.picture(session, progress), picture);
    EXPECT_EQ(results.latest_picture(session), picture);
}

TEST(Results, KeepWhatStandsStillAsTheSkyTurns) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    session.technique = "visibility_field";
    session.parameters["visibility_field"] = {{"points", 2000.0}, {"rays_per_point", 16.0}, {"cell_size", 2.0}};
    session.environment.turn_deg_per_s = 10.0f;
    session.time_s = 1.0;
    const auto picture = results.picture(session, progress);
    Session later = session;
    later.time_s = 2.0;
    EXPECT_EQ(results.scene(later, progress), results.scene(session, progress));
    EXPECT_EQ(results.embree(later, progress), results.embree(session, progress));
    EXPECT_EQ(results.surfaces(later, progress), results.surfaces(session, progress));
    EXPECT_EQ(results.lights(later, progress), results.lights(session, progress));
    EXPECT_EQ(results.structure(later, progress), results.structure(session, progress));
    EXPECT_NE(results.picture(later, progress)->value.radiance.pixels, picture->value.radiance.pixels);
}

TEST(Results, TellWhatCompressionChanged) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    session.channel = Channel::compression;
    EXPECT_EQ(results.compression(session, progress)->value.visibility_percent, 0.0);  // nothing is compressed
    session.parameters["voxel_rows"]["compression"] = 1.0;
    const auto picture = results.picture(session, progress);
    const auto exact = results.compression(session, progress);
    EXPECT_EQ(results.picture(session, progress), picture);
    EXPECT_EQ(results.compression(session, progress), exact);
    session.parameters["voxel_rows"]["dictionary_rows"] = 1024.0;
    session.parameters["voxel_rows"]["dictionary_choice"] = 0.0;
    const auto coarse = results.compression(session, progress);
    EXPECT_GT(coarse->value.visibility_percent, exact->value.visibility_percent);
    EXPECT_LT(coarse->value.visibility_percent, 50.0);
}

TEST(Results, KeepTheStructureWhenALightChanges) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    const auto picture = results.picture(session, progress);
    const auto structure = results.structure(session, progress);
    const auto surfaces = results.surfaces(session, progress);
    session.lights.count = 5;
    EXPECT_EQ(results.latest_picture(session), nullptr);
    EXPECT_NE(results.picture(session, progress), picture);
    EXPECT_EQ(results.structure(session, progress), structure);
    EXPECT_EQ(results.surfaces(session, progress), surfaces);
}

TEST(Results, RebuildTheStructureWhenItsParametersChange) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    const auto scene = results.scene(session, progress);
    const auto structure = results.structure(session, progress);
    session.parameters["voxel_rows"]["resolution"] = 48.0;
    EXPECT_NE(results.structure(session, progress), structure);
    EXPECT_EQ(results.scene(session, progress), scene);
}

TEST(Results, AreOneForManyThreadsThatAskAtOnce) {
    Results results(0, Backend::cpu);
    const Session session = small_session();
    std::vector<Shared<RenderResult>> pictures(4);
    {
        std::vector<std::jthread> askers;
        for (auto& picture : pictures)
            askers.emplace_back([&] {
                Progress progress;
                picture = results.picture(session, progress);
            });
    }
    for (const auto& picture : pictures) EXPECT_EQ(picture, pictures.front());
}

TEST(Results, KeepWhatTheyHadWhenTheWorkIsCancelledOrRefused) {
    Results results(0, Backend::cpu);
    Progress progress;
    const Session session = small_session();
    const auto picture = results.picture(session, progress);
    Progress cancelled;
    cancelled.cancel();
    Session other = session;
    other.lights.count = 7;
    EXPECT_THROW(results.picture(other, cancelled), Cancelled);
    other.camera = "nowhere";
    EXPECT_THROW(results.picture(other, progress), InputError);
    EXPECT_EQ(results.latest_picture(session), picture);
}

TEST(Results, DoNotDependOnTheOrderOfAsking) {
    Progress progress;
    const Session session = small_session();
    Session other = session;
    other.lights.count = 9;
    Results one(1, Backend::cpu), two(0, Backend::cpu);
    two.picture(other, progress);
    EXPECT_EQ(one.picture(session, progress)->value.radiance, two.picture(session, progress)->value.radiance);
}

TEST(Results, ChooseTheCpuForTechniquesThatRunNowhereElse) {
    const Results results(0, Backend::vulkan);
    Session session = small_session();
    session.backend = BackendChoice::automatic;
    EXPECT_EQ(results.backend(session), Backend::vulkan);
    session.technique = "voxel_marching";
    EXPECT_EQ(results.backend(session), Backend::cpu);
    session.backend = BackendChoice::vulkan;
    EXPECT_EQ(results.backend(session), Backend::vulkan) << "an explicit choice is passed on, and refused there";
}

TEST(Results, AddVirtualLightsAfterTheOthersWhereTheSessionAsks) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    const auto direct = results.lights(session, progress);
    session.lights.virtual_lights = 50;
    EXPECT_NE(lights_part(session), lights_part(small_session()));
    EXPECT_EQ(structure_part(session), structure_part(small_session()));
    const auto all = results.lights(session, progress);
    ASSERT_GT(all->value.size(), direct->value.size() + 40u);
    EXPECT_LE(all->value.size(), direct->value.size() + 50u);
    for (std::size_t i = 0; i < all->value.size(); ++i) {
        EXPECT_EQ(all->value[i].kind == LightKind::surface, i >= direct->value.size());
        EXPECT_TRUE(i >= direct->value.size() || all->value[i] == direct->value[i]);
    }
    session.lights.virtual_lights = 65536;
    EXPECT_THROW(results.lights(session, progress), InputError);
}

TEST(Results, RefuseMoreRaysThanCanBeCompared) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    session.reference = true;
    session.size = {4096, 4096};
    session.lights.count = 65536;
    EXPECT_THROW(results.picture(session, progress), InputError);
}

TEST(Results, DoNotRebuildTheStructureAtAnotherTimeWhereNothingMoves) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    session.scene = "garden";  // a sun that moves over a garden that does not
    const auto structure = results.structure(session, progress);
    session.time_s = 3.0;
    EXPECT_EQ(results.structure(session, progress), structure);
    EXPECT_EQ(results.latest_structure(session), structure);
}

TEST(Results, AMovingScenesPictureDoesNotDependOnTheTimesBefore) {
    Progress progress;
    Session session = small_session();
    session.scene = "bear";
    Results straight(0, Backend::cpu), by_detours(0, Backend::cpu);
    for (const double time_s : {0.0, 2.0, 0.5}) {
        session.time_s = time_s;
        by_detours.picture(session, progress);
    }
    const auto expected = straight.picture(session, progress), got = by_detours.picture(session, progress);
    EXPECT_EQ(expected->value.radiance.pixels, got->value.radiance.pixels);
    EXPECT_NE(by_detours.structure(session, progress), straight.structure(session, progress));
}

TEST(Results, KeepWhatMomentsShareWhereOneInBetweenIsCancelled) {
    Results results(0, Backend::cpu);
    Progress progress;
    Session session = small_session();
    session.scene = "bear";
    session.technique = "visibility_field";
    session.parameters["visibility_field"] = {{"points", 2000.0}, {"rays_per_point", 16.0}, {"cell_size", 2.0}};
    const auto shared_seconds = [&] {
        const auto structure = results.structure(session, progress);
        const auto& values = structure->value.statistics.values;
        return std::ranges::find(values, "baking what stands still, once", &Statistic::name)->value;
    };
    const double first = shared_seconds();
    bool cancelled = false;
    for (int k = 1; k < 50 && !cancelled; ++k) {  // the build may be over before it is told to stop
        session.time_s = 0.05 * k;
        results.scene(session, progress);
        Progress stopped;
        std::jthread stopping([&] {
            while (stopped.stage().empty()) std::this_thread::yield();
            stopped.cancel();
        });
        try {
            results.structure(session, stopped);
        } catch (const Cancelled&) {
            cancelled = true;
        }
    }
    ASSERT_TRUE(cancelled);
    session.time_s = 4.0;
    EXPECT_EQ(shared_seconds(), first);  // baked once, or the clock would say otherwise
}

TEST(Results, KeepCompressedStructuresInTheFolderThatIsGiven) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("sightlines-results-" + std::to_string(getpid()));
    fs::remove_all(folder);
    Progress progress;
    Session session = small_session();
    session.parameters["voxel_rows"]["compression"] = 1.0;
    session.parameters["voxel_rows"]["dictionary_rows"] = 1024.0;
    const auto picture = [&] {
        Results results(0, Backend::cpu);
        results.cache_folder = folder;
        return results.picture(session, progress)->value.radiance.pixels;
    };
    const auto made = picture();
    ASSERT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
    const fs::path file = fs::directory_iterator(folder)->path();
    EXPECT_EQ(picture(), made);
    fs::resize_file(file, fs::file_size(file) / 2);
    EXPECT_EQ(picture(), made);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace sightlines
