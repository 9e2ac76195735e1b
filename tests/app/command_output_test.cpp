// What the commands write: complete files with everything that the design names, or none.
#include <chrono>
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>

#include "app/session.h"
#include "run_program.h"
#include "techniques/base/image.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

Arguments with(Arguments first, const Arguments& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
}

const Arguments small{"--scene", "cornell",       "--size",       "64x36",     "--lights", "8",
                      "--set",   "resolution=32", "angle_step=6", "--backend", "cpu"};

Json json_of(const fs::path& file) { return Json::parse(text_of(file)); }

TEST(Render, WritesAPictureAndAReportWithEveryKeyOfTheDesign) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = run_program(
        with({"render", "--reference", "--report", "r.json", "--out", "a.png", "--error-out", "e.png"}, small), folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(files_in(folder), (Arguments{"a.png", "e.png", "r.json"}));
    EXPECT_EQ(read_png(folder / "a.png").size, (ImageSize{64, 36}));
    const Json report = json_of(folder / "r.json");
    for (const char* pointer : {"/technique",
                                "/scene",
                                "/triangles",
                                "/lights",
                                "/size/1",
                                "/backend",
                                "/device",
                                "/seed",
                                "/parameters/resolution",
                                "/seconds/load",
                                "/seconds/build",
                                "/seconds/render",
                                "/seconds/reference",
                                "/rays/asked",
                                "/rays/traced",
                                "/mrays_per_second",
                                "/memory_bytes/structure",
                                "/memory_bytes/uncompressed",
                                "/memory_bytes/peak",
                                "/error/visibility_percent",
                                "/error/shadow_percent",
                                "/error/rmse",
                                "/error/max_abs"})
        EXPECT_TRUE(report.contains(Json::json_pointer(pointer))) << pointer;
    EXPECT_EQ(report["lights"], 8);
    EXPECT_EQ(report["parameters"]["resolution"], 32);
    EXPECT_GT(report["rays"]["asked"], 1000);
    EXPECT_LE(report["rays"]["asked"], 64 * 36 * 8);
    EXPECT_GT(report["error"]["visibility_percent"], 0.0);
    EXPECT_LT(report["error"]["visibility_percent"], 60.0);
    EXPECT_NE(run.output.find("visibility error"), std::string::npos) << run.output;
}

TEST(Render, LeavesTheErrorsOutWithoutAReference) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = run_program(with({"render", "--json", "--out", "a.png"}, small), folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_FALSE(Json::parse(run.output).contains("error"));
}

TEST(Render, SaysNothingWhenQuiet) {
    const ProgramRun run = run_program(with({"render", "--quiet", "--out", "a.png"}, small), fresh_folder());
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.output + run.errors, "");
}

TEST(Render, MakesTheSamePixelsFromTheSameSessionWhateverTheThreads) {
    const fs::path folder = fresh_folder();
    ASSERT_EQ(run_program(with({"render", "--threads", "1", "--out", "a.png"}, small), folder).exit_code, 0);
    ASSERT_EQ(run_program(with({"render", "--threads", "3", "--out", "b.png"}, small), folder).exit_code, 0);
    ASSERT_EQ(run_program(with({"render", "--seed", "2", "--out", "c.png"}, small), folder).exit_code, 0);
    EXPECT_EQ(text_of(folder / "a.png"), text_of(folder / "b.png"));
    EXPECT_NE(text_of(folder / "a.png"), text_of(folder / "c.png"));
}

TEST(Render, WritesLinearRadianceAsHdr) {
    const fs::path folder = fresh_folder();
    ASSERT_EQ(run_program(with({"render", "--out", "a.hdr"}, small), folder).exit_code, 0);
    EXPECT_EQ(text_of(folder / "a.hdr").substr(0, 10), "#?RADIANCE");
}

TEST(Render, LeavesWhatWasThereWhenItIsInterrupted) {
    const fs::path folder = fresh_folder();
    std::ofstream(folder / "a.png") << "what was there";
    const ProgramRun run = run_program({"render", "--scene", "atrium", "--size", "1280x720", "--lights", "4096",
                                        "--backend", "cpu", "--reference", "--report", "r.json", "--out", "a.png"},
                                       folder, SendSignal{SIGINT, 0.4});
    EXPECT_EQ(run.exit_code, 130) << run.errors;
    EXPECT_EQ(files_in(folder), Arguments{"a.png"});
    EXPECT_EQ(text_of(folder / "a.png"), "what was there");
}

TEST(KeptArrays, AreWholeOrAbsentWhereverTheProgramIsKilled) {
    const fs::path folder = fresh_folder();
    const VariableSet keeping("SIGHTLINES_CACHE", "on");
    const auto trace = [&](const std::string& cache, std::optional<SendSignal> send) {
        const VariableSet where("XDG_CACHE_HOME", (folder / cache).string());
        return run_program({"trace",
                            "--scene",
                            "cornell",
                            "--lights",
                            "8",
                            "--size",
                            "64x36",
                            "--pixel",
                            "32,30",
                            "--ray",
                            "0",
                            "--set",
                            "compression=1",
                            "resolution=64",
                            "angle_step=6",
                            "dictionary_rows=20000",
                            "--backend",
                            "cpu",
                            "--out",
                            "t.json"},
                           folder, send);
    };
    const auto kept = [&](const std::string& cache) {
        std::vector<std::pair<std::string, std::uintmax_t>> files;
        const fs::path arrays = folder / cache / "sightlines" / "arrays";
        if (fs::exists(arrays))
            for (const auto& entry : fs::directory_iterator(arrays))
                if (entry.path().extension() == ".rows")
                    files.emplace_back(entry.path().filename().string(), entry.file_size());
        return files;
    };
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(trace("whole", {}).exit_code, 0);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::string expected = text_of(folder / "t.json");
    const auto expected_files = kept("whole");
    ASSERT_EQ(expected_files.size(), 1u);

    constexpr int kills = 12;
    int killed = 0;
    for (int k = 0; k < kills; ++k) {
        const std::string cache = "killed" + std::to_string(k);
        killed += trace(cache, SendSignal{SIGKILL, seconds * (k + 1) / kills}).exit_code == -SIGKILL;
        const auto left = kept(cache);
        ASSERT_TRUE(left.empty() || left == expected_files) << k;
        fs::remove(folder / "t.json");
        ASSERT_EQ(trace(cache, {}).exit_code, 0) << k;
        ASSERT_EQ(text_of(folder / "t.json"), expected) << k;
        ASSERT_EQ(kept(cache), expected_files) << k;
    }
    EXPECT_GT(killed, 0);  // the first after a twelfth of the time that it takes
}

TEST(Workspace, RendersTheSavedSessionToTheSamePixels) {
    const fs::path folder = fresh_folder();
    ASSERT_EQ(run_program(with({"render", "--out", "a.png", "--save-session", "s.json"}, small), folder).exit_code, 0);
    const ProgramRun run = run_program({"workspace", "s.json", "--render", "b.png"}, folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(text_of(folder / "a.png"), text_of(folder / "b.png"));
}

TEST(Workspace, AppliesFurtherFilesAsPatchesAndFlagsLast) {
    const fs::path folder = fresh_folder();
    ASSERT_EQ(run_program(with({"render", "--out", "a.png", "--save-session", "s.json"}, small), folder).exit_code, 0);
    std::ofstream(folder / "step.json") << R"({"lights": {"count": 5}, "seed": 9})";
    const ProgramRun run =
        run_program({"workspace", "s.json", "step.json", "--seed", "3", "--json", "--render", "b.png"}, folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json report = Json::parse(run.output);
    EXPECT_EQ(report["lights"], 5);
    EXPECT_EQ(report["seed"], 3);
    EXPECT_EQ(report["parameters"]["resolution"], 32);
}

TEST(Workspace, IsRefusedWithFileAndPointer) {
    const fs::path folder = fresh_folder();
    std::ofstream(folder / "s.json") << R"({"lights": {"cuont": 5}})";
    const ProgramRun run = run_program({"workspace", "s.json", "--render", "b.png"}, folder);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_EQ(run.errors, "sightlines: s.json: /lights/cuont: is not known (did you mean count?)\n");
}

TEST(Workspace, LooksForItsSceneBesideItself) {
    const fs::path folder = fresh_folder();
    std::ofstream(folder / "s.json") << R"({"scene": "house.glb"})";
    const ProgramRun run = run_program({"workspace", "s.json", "--render", "b.png"}, folder);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.errors.find("house.glb: no such file"), std::string::npos) << run.errors;
}

TEST(Workspace, SaysThatThereIsNoDisplayForTheWindow) {
    const fs::path folder = fresh_folder();
    std::ofstream(folder / "s.json") << "{}";
    const DisplayHidden hidden;
    const ProgramRun run = run_program({"workspace", "s.json"}, folder);
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_NE(run.errors.find("DISPLAY"), std::string::npos) << run.errors;
}

TEST(TraceCommand, RecordsEveryStepWithItsPlaceAndGeometry) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = run_program(with({"trace", "--pixel", "32,30", "--out", "t.json"}, small), folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json trace = json_of(folder / "t.json");
    ASSERT_GE(trace["steps"].size(), 4u);
    std::size_t shapes = 0;
    for (const Json& step : trace["steps"]) {
        EXPECT_TRUE(fs::is_regular_file(fs::path(SIGHTLINES_SOURCE_FOLDER) / step["file"].get<std::string>())) << step;
        EXPECT_GT(step["line"], 0);
        EXPECT_FALSE(step["sentence"].get<std::string>().empty());
        shapes += step["geometry"].size();
    }
    EXPECT_GT(shapes, 0u);
    EXPECT_TRUE(trace["blocked"].is_boolean());
    EXPECT_TRUE(trace["embree_blocked"].is_boolean());
    EXPECT_EQ(trace["pixel"], (Json{32, 30}));
    EXPECT_NE(run.output.find("Embree"), std::string::npos) << run.output;
}

TEST(TraceCommand, CountsRaysOnlyOfLightsInFront) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = run_program(with({"trace", "--pixel", "32,30", "--ray", "1", "--json"}, small), folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const int light = Json::parse(run.output)["light"];
    const ProgramRun same =
        run_program(with({"trace", "--pixel", "32,30", "--light", std::to_string(light), "--json"}, small), folder);
    EXPECT_EQ(run.output, same.output);
    EXPECT_GE(light, 1);
}

TEST(FigureCommand, WritesEveryFormatIntoANewFolder) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = run_program(
        with({"figure", "voxel-row", "--format", "png", "svg", "--dpi", "72", "--json", "--out", "f"}, small), folder);
    if (run.exit_code == 4) GTEST_SKIP() << run.errors;
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(files_in(folder / "f"), (Arguments{"voxel-row.png", "voxel-row.svg"}));
    EXPECT_EQ(Json::parse(run.output)["files"].size(), 2u);
}

TEST(FigureCommand, ShowsTheDictionaryOfACompressedArrayOnly) {
    const fs::path folder = fresh_folder();
    const ProgramRun refused = run_program(with({"figure", "dictionary", "--out", "f"}, small), folder);
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.errors.find("compression=on"), std::string::npos) << refused.errors;
    const ProgramRun run = run_program(
        with({"figure", "dictionary", "--dpi", "72", "--set", "compression=on", "--out", "f"}, small), folder);
    if (run.exit_code == 4) GTEST_SKIP() << run.errors;
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(files_in(folder / "f"), (Arguments{"dictionary.png"}));
}

TEST(Render, DrawsWhatCompressionChanged) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = run_program(with({"render", "--out", "a.png", "--compression-out", "c.png", "--report",
                                             "r.json", "--set", "compression=on"},
                                            small),
                                       folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(files_in(folder), (Arguments{"a.png", "c.png", "r.json"}));
    EXPECT_TRUE(json_of(folder / "r.json").contains("compression_changed_percent"));
}

TEST(BenchCommand, GivesTheErrorsOfFirstHits) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = run_program(with({"bench", "first-hits", "--json", "--out", "b"}, small), folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(files_in(folder / "b"), (Arguments{"first-hits.csv", "first-hits.json", "first-hits.md"}));
    for (const auto& [key, row] : Json::parse(run.output)["rays"].items()) {
        EXPECT_GT(row["agree_percent"], 85.0) << key;  // in a closed box everything is hit
        EXPECT_LT(row["median_voxels"], 1.5) << key;
        EXPECT_GT(row["median_voxels"], 0.0) << key;
    }
}

TEST(BenchCommand, GivesEveryContestantAndTheRatios) {
    const fs::path folder = fresh_folder();
    const ProgramRun run =
        run_program(with({"bench", "shadow-rays", "--repetitions", "1", "--json", "--out", "b"}, small), folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json bench = Json::parse(run.output);
    for (const char* key :
         {"voxel_rows_cpu", "voxel_rows_vulkan", "embree_1", "embree_8", "embree_16", "embree_stream"})
        ASSERT_TRUE(bench["mrays_per_second"].contains(key)) << key;
    EXPECT_GT(bench["ratio"]["cpu"], 0.0);
    const Json& blocked = bench["blocked_percent"];
    EXPECT_NEAR(blocked["embree_1"].get<double>(), blocked["embree_16"].get<double>(), 0.5);
    EXPECT_NEAR(blocked["embree_8"].get<double>(), blocked["embree_stream"].get<double>(), 0.5);
    EXPECT_EQ(files_in(folder / "b"), (Arguments{"shadow-rays.csv", "shadow-rays.json", "shadow-rays.md"}));
    EXPECT_TRUE(bench["compression_cost"]["cpu"].is_null());
}

TEST(BenchCommand, AsksTheUncompressedArrayBesideACompressedOne) {
    const ProgramRun run =
        run_program(with({"bench", "shadow-rays", "--repetitions", "1", "--json", "--out", "b", "--set",
                          "compression=on", "dictionary_rows=1024", "dictionary_choice=frequent"},
                         small),
                    fresh_folder());
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json bench = Json::parse(run.output);
    EXPECT_GT(bench["compression_cost"]["cpu"], 0.0);
    EXPECT_NE(bench["blocked_percent"]["voxel_rows_cpu"], bench["blocked_percent"]["voxel_rows_cpu_uncompressed"]);
}

}  // namespace
}  // namespace sightlines
