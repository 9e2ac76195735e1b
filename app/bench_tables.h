// The papers' tables that the program measures anew.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/bench_measure.h"
#include "app/bench_output.h"
#include "app/bench_paper.h"

namespace sightlines {

/// What measuring a table fills in; the scene or setting that cannot be measured becomes a note.
using MeasureTable = void (*)(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);

/// One row of the table of tables.
struct PaperTable {
    std::string_view name;   ///< "voxel-rows/table1"
    std::string_view title;  ///< as the paper's, in one line
    int number = 0;          ///< for Paper::figures
    ChartKind chart = ChartKind::dots;
    std::string_view varied;  ///< what a row's `at` is
    bool log_values = false;
    MeasureTable measure = nullptr;
    const Paper* paper = &wang_2017_paper;
};

/// All of them, in the order of the papers.
std::span<const PaperTable> paper_tables();

/// The tables of one technique ("voxel-rows"); empty where there is none.
std::span<const PaperTable> tables_of(std::string_view technique);

/// InputError offers the nearest name.
const PaperTable& find_table(std::string_view name);

/// Measures all of the table in one go.
MeasuredTable measure_table(const PaperTable& table, BenchRun& run, Results& results, Progress& progress);

/// The scenes of the paper (all of them, or only the still ones), or those that the run asks for; few with --quick.
/// Those that the program does not have become notes of the table.
std::vector<std::string> scenes_for(MeasuredTable& table, const BenchRun& run, std::span<const std::string_view> all);

/// The paper's resolutions (few with --quick) for which an array of voxelizations fits into memory; a note says which
/// do not.
std::vector<int> fitting_resolutions(MeasuredTable& table, const BenchRun& run);

/// Tells the run's listener what is being measured.
void say(const BenchRun& run, const MeasuredTable& table, const std::string& what);

/// Adds one figure of ours, with the paper's beside it where there is one.
MeasuredRow& add_figure(MeasuredTable& table, std::string_view scene, std::string_view quantity, double ours,
                        std::string_view unit, int digits, double at = 0.0, const std::string& setting = "");

/// Tables 1 to 4, 9 and Figure 7: errors.
namespace tables {
void errors_by_scene(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void errors_by_lights(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void errors_by_resolution(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void errors_by_angle(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void errors_of_compression(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void errors_by_samples(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
/// Tables 5 to 8, 10 and 11: times and memory.
void times_by_scene(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void times_by_lights(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void times_of_marching(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void memory_by_resolution(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void times_of_building(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void times_of_compression(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
/// Xu 2022.
void field_speed_ups(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_pictures(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_by_points(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_by_cells(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_by_samples(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_labels(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_glossy(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_memory(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_indirect(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_area_lights(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_moments(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
void field_caching(MeasuredTable& table, BenchRun& run, Results& results, Progress& progress);
}  // namespace tables

}  // namespace sightlines
