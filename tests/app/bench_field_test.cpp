// The tables of the visibility field: the paper's figures, and what the program makes of them.
#include "app/bench_field.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "run_program.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const std::string shared_folder = SIGHTLINES_SHARED_FOLDER;

std::optional<double> printed(int table, std::string_view scene, std::string_view what, double at) {
    return find_figure(xu_2022(table), scene, what, at);
}

ProgramRun quick(const std::string& table, const fs::path& folder, const Words& more = {}) {
    Words arguments{"bench", table, "--quick", "--size", "48x27", "--json", "--out", "b"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, folder);
}

/// Ours, of the row for these; -1 where there is none.
double ours(const Json& table, const std::string& scene, const std::string& quantity, double at) {
    for (const Json& row : table["rows"])
        if (row["scene"] == scene && row["quantity"] == quantity && row["at"] == (at > 0.0 ? Json(at) : Json()))
            return row["ours"].is_null() ? -1.0 : row["ours"].get<double>();
    return -1.0;
}

TEST(FieldTables, AreTwelveAndComeAfterThoseOfVoxelRows) {
    Words names;
    for (const PaperTable& table : tables_of("visibility-field")) {
        names.emplace_back(table.name);
        EXPECT_EQ(table.paper, &xu_2022_paper);
    }
    EXPECT_EQ(names, (Words{"visibility-field/table1", "visibility-field/figure5", "visibility-field/figure6",
                            "visibility-field/figure7", "visibility-field/figure8", "visibility-field/figure9",
                            "visibility-field/figure10", "visibility-field/memory", "visibility-field/indirect",
                            "visibility-field/moving", "visibility-field/area-lights", "visibility-field/caching"}));
    EXPECT_EQ(tables_of("voxel-rows").size() + names.size(), paper_tables().size());
    EXPECT_TRUE(tables_of("visibility").empty());
}

TEST(FieldTables, HoldThePapersFigures) {
    EXPECT_EQ(printed(1, "sponza", quantity::time_without_field, 64), 27.28);
    EXPECT_EQ(printed(1, "sponza", quantity::field_speed_up, 16), 3.12);
    EXPECT_EQ(printed(8, "sponza", quantity::time_with_field, 32), 4.02);
    EXPECT_EQ(printed(5, "bistro", quantity::time_with_field, 0), 33.67);
    EXPECT_EQ(printed(6, "sponza", quantity::time_with_field, 10e6), 15.74);
    EXPECT_EQ(printed(7, "sponza", quantity::dense_memory, 50), 49008);
    EXPECT_EQ(printed(0, "bistro", quantity::dense_memory, 100), 173958);
    EXPECT_EQ(printed(10, "bistro", quantity::time_with_field, 0), 27.16);
    EXPECT_TRUE(xu_2022(9).empty());
}

TEST(FieldTables, AreListedInTheHelpWithTheTablesOfEachTechniqueTogether) {
    const ProgramRun run = run_program({"bench", "--help"}, fresh_folder());
    for (const PaperTable& table : paper_tables()) EXPECT_NE(run.output.find(table.name), std::string::npos);
    EXPECT_NE(run.output.find("visibility-field/all "), std::string::npos);
    EXPECT_NE(run.output.find("--environment"), std::string::npos);
    const ProgramRun misspelt = run_program({"bench", "visibility-field/figure4"}, fresh_folder());
    EXPECT_EQ(misspelt.exit_code, 2);
    EXPECT_NE(misspelt.errors.find("did you mean visibility-field/figure"), std::string::npos) << misspelt.errors;
}

TEST(FieldTables, ShowThePapersFiguresUnderItsOwnSceneWhereAnotherIsMeasured) {
    const fs::path folder = fresh_folder();
    const ProgramRun run = quick("visibility-field/table1", folder, {"--scene", "cornell"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(files_in(folder / "b"),
              (Words{"visibility-field-table1.csv", "visibility-field-table1.md", "visibility-field-table1.svg"}));
    const Json table = Json::parse(run.output);
    EXPECT_GT(ours(table, "cornell", "speed-up", 128), 0.0);
    EXPECT_GT(ours(table, "cornell", "speed-up (plain)", 16), 0.0);
    const auto sponza = std::ranges::find_if(
        table["rows"], [](const Json& row) { return row["scene"] == "sponza" && row["quantity"] == "speed-up"; });
    ASSERT_NE(sponza, table["rows"].end());
    EXPECT_TRUE((*sponza)["ours"].is_null());
    EXPECT_EQ((*sponza)["paper"], 3.12);
    const std::string markdown = text_of(folder / "b" / "visibility-field-table1.md");
    EXPECT_NE(markdown.find("Y. Xu"), std::string::npos);
    EXPECT_NE(markdown.find("RTX 3080"), std::string::npos);
    EXPECT_EQ(markdown.find("lights"), std::string::npos);
}

TEST(FieldTables, PutThePapersFiguresBesideOursForAFileCalledSponza) {
    const fs::path file = fs::path(shared_folder) / "scenes" / "sponza_crytek.glb";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
    const ProgramRun run = quick("visibility-field/figure5", fresh_folder(), {"--scene", fs::absolute(file).string()});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json table = Json::parse(run.output);
    EXPECT_GT(table["rows"][1]["ours"], 0.0);
    EXPECT_EQ(table["rows"][1]["scene"], "sponza");
    EXPECT_EQ(table["rows"][1]["paper"], 15.74);
    const auto count = std::ranges::count_if(table["rows"], [](const Json& row) { return row["paper"] == 15.74; });
    EXPECT_EQ(count, 1);
}

TEST(FieldTables, GiveMemoryThatShrinksWithLargerCellsAndWithPacking) {
    const ProgramRun run = quick("visibility-field/memory", fresh_folder(), {"--scene", "atrium"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json table = Json::parse(run.output);
    for (const double cell_cm : {50.0, 100.0, 200.0, 400.0}) {
        const double dense = ours(table, "atrium", "memory, the paper's layout", cell_cm);
        const double packed = ours(table, "atrium", "memory, two bits a texel", cell_cm);
        const double unique = ours(table, "atrium", "memory, alike masks once", cell_cm);
        EXPECT_GT(unique, 0.0);
        EXPECT_LT(unique, packed);
        EXPECT_LT(4.0 * packed, dense);
        if (cell_cm > 50.0) {
            EXPECT_LT(dense, ours(table, "atrium", "memory, the paper's layout", 0.5 * cell_cm));
        }
    }
}

TEST(FieldTables, BakeMomentsFromWhatStandsStill) {
    const ProgramRun run = quick("visibility-field/moving", fresh_folder(), {"--scene", "bear"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json table = Json::parse(run.output);
    for (const char* quantity : {"baking all anew", "baking the moment", "baking what stands still, once"})
        EXPECT_GT(ours(table, "bear", quantity, 0.0), 0.0) << quantity;
    const double cells = ours(table, "bear", "cells baked again", 0.0),
                 rays = ours(table, "bear", "rays cast again", 0.0);
    EXPECT_GT(cells, 0.0);
    EXPECT_LT(cells, 100.0);
    EXPECT_GT(rays, 0.0);
    EXPECT_LT(rays, 30.0);
}

TEST(FieldTables, SayWhatAFieldSavesOfSecondRays) {
    const ProgramRun run = quick("visibility-field/indirect", fresh_folder(), {"--scene", "cornell"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json table = Json::parse(run.output);
    for (const char* quantity : {"time without the field", "time with the field", "speed-up"})
        EXPECT_GT(ours(table, "cornell", quantity, 0.0), 0.0) << quantity;
    const double second = ours(table, "cornell", "second rays traced", 0.0);
    EXPECT_GT(second, 1.0);
    EXPECT_LT(second, 99.0);
    EXPECT_GE(ours(table, "cornell", "RMSE", 0.0), 0.0);
    EXPECT_LT(ours(table, "cornell", "RMSE", 0.0), 10.0);
}

TEST(FieldTables, SayWhatCellsSaveOfSegmentsToAreaLights) {
    const ProgramRun run = quick("visibility-field/area-lights", fresh_folder(), {"--scene", "cornell"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json table = Json::parse(run.output);
    EXPECT_EQ(ours(table, "cornell", "triangles that shine", 0.0), 2.0);
    for (const char* quantity : {"time without the field", "time with the field", "speed-up of area lights"})
        EXPECT_GT(ours(table, "cornell", quantity, 0.0), 0.0) << quantity;
    const double needed = ours(table, "cornell", "segments that need a ray", 0.0),
                 without = ours(table, "cornell", "RMSE without the field", 0.0),
                 with = ours(table, "cornell", "RMSE with the field", 0.0);
    EXPECT_GT(needed, 0.0);
    EXPECT_LT(needed, 60.0);
    EXPECT_GT(without, 0.0);
    EXPECT_LT(without, 30.0);
    EXPECT_NEAR(with, without, 0.3 * without);
    const ProgramRun dark = quick("visibility-field/area-lights", fresh_folder(), {"--scene", "trees"});
    ASSERT_EQ(dark.exit_code, 0) << dark.errors;
    EXPECT_EQ(ours(Json::parse(dark.output), "trees", "time with the field", 0.0), -1.0);
}

TEST(FieldTables, AskFewerPixelsWithACacheTheWiderItIs) {
    const ProgramRun run = quick("visibility-field/caching", fresh_folder(), {"--scene", "cornell"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json table = Json::parse(run.output);
    for (const char* quantity : {"time without field and cache", "time with field", "RMSE with field"})
        EXPECT_GT(ours(table, "cornell", quantity, 0.0), 0.0) << quantity;
    double before = 100.0;
    for (const double spacing : {4.0, 8.0, 16.0}) {
        for (const char* quantity : {"time with cache", "time with field and cache",
                                     "speed-up by the cache", "RMSE with field and cache"})
            EXPECT_GT(ours(table, "cornell", quantity, spacing), 0.0) << quantity;
        const double asked = ours(table, "cornell", "pixels asked", spacing);
        EXPECT_GT(asked, 5.0);
        EXPECT_LE(asked, before);
        before = asked;
    }
    EXPECT_LT(before, 90.0);
}

TEST(FieldTables, TakeTheirLightFromAPictureAndRefuseOneThatIsMissingBeforeMeasuring) {
    const ProgramRun missing = quick("visibility-field/figure8", fresh_folder(), {"--environment", "none.hdr"});
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_NE(missing.errors.find("none.hdr"), std::string::npos) << missing.errors;
    EXPECT_EQ(missing.errors.find("reading and building"), std::string::npos) << missing.errors;
    const fs::path file = fs::path(shared_folder) / "env" / "venice_512.hdr";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
    const Words lit{"--scene", "cornell", "--environment", fs::absolute(file).string()};
    const ProgramRun run = quick("visibility-field/figure5", fresh_folder(), lit);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(Json::parse(run.output)["setup"].get<std::string>().find("venice_512.hdr"), std::string::npos);
}

TEST(FieldTables, VaryWhatTheyNameAndGiveEveryQuantityAFigure) {
    struct Expected {
        std::string table;
        std::size_t figures;
    };
    for (const Expected& expected :
         {Expected{"figure6", 2 * 4 * 4}, Expected{"figure7", 2 * 4 * 4 + 4}, Expected{"figure8", 2 * 4 * 3},
          Expected{"figure9", 2 * 3}, Expected{"figure10", 2 * 5}}) {
        const ProgramRun run = quick("visibility-field/" + expected.table, fresh_folder(), {"--scene", "cornell"});
        ASSERT_EQ(run.exit_code, 0) << run.errors;
        const Json table = Json::parse(run.output);
        std::size_t measured = 0;
        for (const Json& row : table["rows"])
            if (row["scene"] == "cornell") {
                ++measured;
                EXPECT_GE(row["ours"], 0.0) << row;
            }
        EXPECT_EQ(measured, expected.figures) << expected.table;
    }
}

}  // namespace
}  // namespace sightlines
