// The papers' tables: their figures, how they are measured, and the files that they become.
#include "app/bench_tables.h"

#include <algorithm>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "app/bench_chart.h"
#include "app/bench_paper.h"
#include "run_program.h"
#include "techniques/base/error.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;
using Cells = std::vector<std::string>;

/// The cells of one line of CSV without line breaks in cells.
Cells csv_cells(const std::string& line) {
    Cells cells(1);
    bool quoted = false;
    for (const char letter : line) {
        if (letter == '"')
            quoted = !quoted;
        else if (letter == ',' && !quoted)
            cells.emplace_back();
        else
            cells.back() += letter;
    }
    EXPECT_FALSE(quoted) << line;
    return cells;
}

Cells lines_of(const std::string& text) {
    Cells lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// The bars of a line of a Markdown table that part its cells.
int bars(const std::string& line) {
    int count = 0;
    for (std::size_t i = 0; i < line.size(); ++i) count += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    return count;
}

/// What is wrong with the nesting of the elements, or nothing.
std::string wrong_nesting(const std::string& xml) {
    Cells open;
    for (std::size_t at = 0; (at = xml.find('<', at)) != std::string::npos;) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) return "an open tag at the end";
        const std::string tag = xml.substr(at + 1, end - at - 1);
        at = end;
        if (tag.find('<') != std::string::npos) return "a tag in a tag: " + tag;
        if (tag.starts_with('?') || tag.starts_with('!') || tag.ends_with('/')) continue;
        if (!tag.starts_with('/')) {
            open.push_back(tag.substr(0, tag.find_first_of(" \n")));
        } else {
            if (open.empty() || open.back() != tag.substr(1)) return "closes what is not open: " + tag;
            open.pop_back();
        }
    }
    return open.empty() ? "" : "not closed: " + open.back();
}

MeasuredRow figure(const std::string& scene, double at, std::optional<double> ours, std::optional<double> paper) {
    return {.scene = scene,
            .quantity = "error, \"hard\" | <soft> & more",
            .at = at,
            .setting = at > 0.0 ? "1,024 lights" : "",
            .unit = "%",
            .digits = 1,
            .ours = ours,
            .paper = paper};
}

MeasuredTable awkward_table(ChartKind chart, bool log_values) {
    MeasuredTable table;
    table.name = "voxel-rows/table2";
    table.title = "errors & <figures>";
    table.our_hardware = "two cores, \"fast\"";
    table.paper_hardware = "i7, GTX";
    table.chart = chart;
    table.varied = "lights";
    table.log_values = log_values;
    table.rows = {figure("trees", 512, 4.0, 2.0), figure("trees", 1024, 0.0, std::nullopt),
                  figure("garden", 512, std::nullopt, 3.0), figure("garden", 1024, 12345.0, 0.001)};
    table.notes = {"one", "two"};
    return table;
}

std::string svg_text(const MeasuredTable& table) {
    const std::vector<std::uint8_t> bytes = svg_from_measured(table);
    return {bytes.begin(), bytes.end()};
}

TEST(PaperTables, OfVoxelRowsAreElevenAndFigure7AndEachIsFoundByItsName) {
    ASSERT_EQ(tables_of("voxel-rows").size(), 12u);
    for (int number = 1; number <= 11; ++number)
        EXPECT_EQ(find_table("voxel-rows/table" + std::to_string(number)).number, number);
    EXPECT_EQ(find_table("voxel-rows/figure7").number, 0);
    for (const PaperTable& table : tables_of("voxel-rows"))
        EXPECT_FALSE(table.paper->figures(table.number).empty()) << table.name;
}

TEST(PaperTables, OfferTheNearestNameForAMisspeltOne) {
    try {
        find_table("voxel-rows/tabel3");
        FAIL() << "found";
    } catch (const InputError& error) {
        EXPECT_EQ(error.remedy, "did you mean voxel-rows/table3?");
    }
    const ProgramRun run = run_program({"bench", "voxel-rows/figure"}, fresh_folder());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.errors.find("did you mean voxel-rows/figure7?"), std::string::npos) << run.errors;
}

TEST(PaperTables, HoldThePapersFigures) {
    const auto printed = [](int table, std::string_view scene, std::string_view what, double at) {
        return find_figure(wang_2017(table), scene, what, at).value_or(-1.0);
    };
    EXPECT_EQ(printed(1, "cathedral", quantity::imperfect_visibility, 0), 20.1);
    EXPECT_EQ(printed(1, "park", quantity::imperfect_shadow, 0), 12.1);
    EXPECT_EQ(printed(1, "park", quantity::visibility, 0), -1.0);
    EXPECT_EQ(printed(2, "garden", quantity::visibility, 2048), 7.9);
    EXPECT_EQ(printed(3, "cathedral", quantity::shadow, 64), 4.5);
    EXPECT_EQ(printed(4, "garden", quantity::visibility, 6), 10.6);
    EXPECT_EQ(printed(5, "cathedral", quantity::over_shadow_maps, 0), 89);
    EXPECT_EQ(printed(5, "park", quantity::render_time, 0), 441);
    EXPECT_EQ(printed(6, "bear", quantity::render_time, 10000), 630);
    EXPECT_EQ(printed(7, "park", quantity::voxel_marching_time, 0), 22482);
    EXPECT_EQ(printed(7, "garden", quantity::over_row_marching, 0), 31);
    EXPECT_EQ(printed(8, "trees", quantity::compressed, 128), 333);
    EXPECT_EQ(printed(9, "planes", quantity::plain_shadow, 0), 1.6);
    EXPECT_EQ(printed(10, "cathedral", quantity::compression_time, 0), 527);
    EXPECT_EQ(printed(11, "trees", quantity::uncompressed, 0), 28);
    EXPECT_EQ(printed(0, "garden", quantity::imperfect_shadow, 11000), 5.8);
}

TEST(MeasuredFiles, HaveAsManyColumnsInEveryRowOfTheCsv) {
    const Cells lines = lines_of(csv_from_measured(awkward_table(ChartKind::dots, false)));
    ASSERT_EQ(lines.size(), 5u);
    const Cells heading = csv_cells(lines.front());
    for (const std::string& line : lines) EXPECT_EQ(csv_cells(line).size(), heading.size()) << line;
    const Cells first = csv_cells(lines[1]);
    EXPECT_EQ((Cells{first[1], first[3], first[5], first[6], first[7]}),
              (Cells{"trees", "512.0", "4.0", "2.0", "2.0"}));
    EXPECT_EQ(csv_cells(lines[2])[7], "");  // no figure of the paper's, no ratio
}

TEST(MeasuredFiles, HaveAWellFormedMarkdownTableWithBothMachines) {
    const std::string text = markdown_from_measured(awkward_table(ChartKind::dots, false));
    Cells table;
    for (const std::string& line : lines_of(text))
        if (line.starts_with("|")) table.push_back(line);
    ASSERT_EQ(table.size(), 6u) << text;
    for (const std::string& line : table) EXPECT_EQ(bars(line), bars(table.front())) << line;
    EXPECT_NE(table[2].find("| 4.0 | 2.0 | 2.00 |"), std::string::npos) << table[2];
    EXPECT_NE(text.find("i7, GTX"), std::string::npos);
    EXPECT_NE(text.find("two cores"), std::string::npos);
    EXPECT_NE(text.find("(voxel-rows-table2.svg)"), std::string::npos);
}

TEST(MeasuredFiles, HaveAChartThatParsesWhateverTheFigures) {
    for (const ChartKind chart : {ChartKind::dots, ChartKind::curves})
        for (const bool log_values : {false, true}) {
            const std::string svg = svg_text(awkward_table(chart, log_values));
            EXPECT_EQ(wrong_nesting(svg), "");
            EXPECT_EQ(svg.find("nan"), std::string::npos);
            EXPECT_NE(svg.find("garden"), std::string::npos);
            EXPECT_NE(svg.find("paper"), std::string::npos);
        }
    EXPECT_NE(wrong_nesting("<a><b></a>"), "");
}

TEST(Ratios, AreKnownOnlyWhereBothFiguresAre) {
    EXPECT_EQ(ratio_to_paper(figure("trees", 0, 3.0, 2.0)), 1.5);
    EXPECT_FALSE(ratio_to_paper(figure("trees", 0, 3.0, std::nullopt)));
    EXPECT_FALSE(ratio_to_paper(figure("trees", 0, std::nullopt, 2.0)));
    EXPECT_FALSE(ratio_to_paper(figure("trees", 0, 3.0, 0.0)));
}

TEST(MedianSeconds, AsksInTurnAndLeavesTheFirstRoundOut) {
    BenchRun run;
    run.repetitions = 3;
    std::string order;
    double next = 100.0;
    Progress progress;
    const std::vector<double> medians = median_seconds(run,
                                                       {[&] {
                                                            order += 'a';
                                                            return next = next == 100.0 ? 3.0 : next - 1.0;
                                                        },
                                                        [&] {
                                                            order += 'b';
                                                            return 10.0 * next;
                                                        }},
                                                       progress);
    EXPECT_EQ(order, "abababab");
    EXPECT_EQ(medians, (std::vector<double>{1.0, 10.0}));  // of 2, 1, 0
}

TEST(MeanErrors, AreThoseOfSeveralSeedsWhereLightsAreFew) {
    EXPECT_EQ(light_sets(64, 1024), 16u);
    EXPECT_EQ(light_sets(512, 1024), 2u);
    EXPECT_EQ(light_sets(1000, 1024), 2u);
    EXPECT_EQ(light_sets(10000, 1024), 1u);
    EXPECT_EQ(light_sets(0, 1024), 1u);  // the scene's own
    BenchRun run;
    Session session = session_of(run, "trees", rows_for("trees"), 64);
    session.reference = true;
    for (const auto& [visibility, shadow] : {std::pair(3.0, 1.0), std::pair(5.0, 4.0)}) {
        run.known_errors[json_from_session(picture_part(session)).dump()] = {visibility, shadow};
        ++session.seed;
    }
    session.seed -= 2;
    Results results(1, Backend::cpu);
    Progress progress;
    const MeanErrors mean = mean_errors(run, session, 2, results, progress);
    EXPECT_DOUBLE_EQ(mean.visibility, 4.0);
    EXPECT_DOUBLE_EQ(mean.shadow, 2.5);
}

TEST(Sessions, GiveThePapersParametersToVoxelRowsAndTheCpuToTheOthers) {
    BenchRun run;
    run.base.backend = BackendChoice::vulkan;
    run.base.lights.count = 1024;
    run.base.parameters["voxel_rows"] = {{"resolution", 32.0}};
    const Session rows = session_of(run, "trees", rows_for("trees"));
    EXPECT_EQ(technique_parameters(rows), (ParameterValues{{"compression", 1.0}, {"resolution", 32.0}}));
    EXPECT_EQ(rows.backend, BackendChoice::vulkan);
    EXPECT_EQ(technique_parameters(session_of(run, "bear", rows_for("bear"))).at("compression"), 0.0);
    EXPECT_EQ(session_of(run, "trees", {"shadow_maps", {}}).backend, BackendChoice::cpu);
    EXPECT_EQ(session_of(run, "park", rows_for("park")).lights.count, 0u);  // its own
    EXPECT_EQ(session_of(run, "park", rows_for("park"), 512).lights.count, 512u);
}

TEST(Bench, MeasuresAQuickTableIntoThreeFiles) {
    const fs::path folder = fresh_folder();
    const ProgramRun run =
        run_program({"bench", "voxel-rows/table1", "--quick", "--scene", "cornell", "--size", "64x36", "--lights", "8",
                     "--set", "resolution=32", "--backend", "cpu", "--out", "b"},
                    folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(files_in(folder / "b"),
              (Cells{"voxel-rows-table1.csv", "voxel-rows-table1.md", "voxel-rows-table1.svg"}));
    EXPECT_NE(run.errors.find("voxel-rows/table1: cornell"), std::string::npos) << run.errors;
    const Cells lines = lines_of(text_of(folder / "b" / "voxel-rows-table1.csv"));
    ASSERT_EQ(lines.size(), 13u);
    std::map<std::string, double> ours;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const Cells cells = csv_cells(lines[i]);
        const bool counts_points = cells[2] == quantity::equal_time_points;
        const bool counts_texels = cells[2] == quantity::equal_time_texels;
        EXPECT_EQ(cells[1], "cornell");
        EXPECT_GT(std::stod(cells[5]), counts_points ? 99.0 : counts_texels ? 31.0 : 0.0) << lines[i];
        EXPECT_LT(std::stod(cells[5]), counts_points ? 1e6 : counts_texels ? 129.0 : 60.0) << lines[i];
        EXPECT_EQ(cells[6], "");  // the paper has no such scene
        ours[cells[2]] = std::stod(cells[5]);
    }
    for (const std::string_view error : {quantity::visibility, quantity::shadow}) {
        const std::string name(error);
        EXPECT_LT(ours.at(name + quantity::of_all_lights), ours.at(name));  // some lights are behind each surface
    }
}

TEST(Bench, GivesTheRebuildOfADeformingSceneApartFromAskingItsLights) {
    const fs::path folder = fresh_folder();
    const ProgramRun run =
        run_program({"bench", "voxel-rows/table6", "--quick", "--scene", "bear", "--size", "32x18", "--set",
                     "resolution=32", "--set", "angle_step=6", "--backend", "cpu", "--repetitions", "1", "--out", "b"},
                    folder);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    std::map<std::string, std::map<std::string, double>> ours;  // by quantity and lights
    for (const std::string& line : lines_of(text_of(folder / "b" / "voxel-rows-table6.csv"))) {
        const Cells cells = csv_cells(line);
        if (cells[1] == "bear") ours[cells[2]][cells[3]] = std::stod(cells[5]);
    }
    for (const std::string lights : {"128.0", "256.0", "512.0"}) {
        const double rebuild = ours[std::string(quantity::rebuild_time)][lights];
        const double asking = ours[std::string(quantity::asking_time)][lights];
        EXPECT_GT(rebuild, 0.0);
        EXPECT_GT(asking, 0.0);
        EXPECT_NEAR(ours[std::string(quantity::render_time)][lights], rebuild + asking, 1e-9 * (rebuild + asking));
    }
    EXPECT_EQ(ours[std::string(quantity::asking_time_per_light)].size(), 2u);
    const auto& asking = ours[std::string(quantity::asking_time)];
    EXPECT_NEAR(ours[std::string(quantity::asking_time_per_light)]["128.0"],
                4.0 * asking.at("128.0") / asking.at("512.0"), 1e-9);
}

TEST(Bench, RefusesAnotherTechniqueForATableThatNamesItsOwn) {
    const ProgramRun run =
        run_program({"bench", "voxel-rows/table1", "--technique", "shadow_maps", "--quick"}, fresh_folder());
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.errors.find("--technique"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace sightlines
