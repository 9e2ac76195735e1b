#include "app/bench_tables.h"

#include <algorithm>
#include <array>

#include "app/table.h"
#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/base/parallel.h"
#include "techniques/scene/builtin_scenes.h"
#include "techniques/voxel_rows/memory_need.h"

namespace sightlines {
namespace {

constexpr std::size_t scenes_when_quick = 2;

constexpr std::array<PaperTable, 24> all_tables{{
    {"voxel-rows/table1", "errors of voxel rows and of imperfect shadow maps", 1, ChartKind::dots, "", false,
     tables::errors_by_scene},
    {"voxel-rows/table2", "errors by the number of lights", 2, ChartKind::curves, "lights", false,
     tables::errors_by_lights},
    {"voxel-rows/table3", "errors by the resolution of the voxelizations", 3, ChartKind::curves, "voxels a side", false,
     tables::errors_by_resolution},
    {"voxel-rows/table4", "errors by the angle between voxelizations", 4, ChartKind::curves, "degrees", false,
     tables::errors_by_angle},
    {"voxel-rows/table5", "render times, and speedups over ray tracing and shadow maps", 5, ChartKind::dots, "", true,
     tables::times_by_scene},
    {"voxel-rows/table6", "render times by the number of lights", 6, ChartKind::curves, "lights", true,
     tables::times_by_lights},
    {"voxel-rows/table7", "times of voxel rows and of marching through voxels", 7, ChartKind::dots, "", true,
     tables::times_of_marching},
    {"voxel-rows/table8", "memory with and without compression", 8, ChartKind::curves, "voxels a side", true,
     tables::memory_by_resolution},
    {"voxel-rows/table9", "errors with and without compression", 9, ChartKind::dots, "", false,
     tables::errors_of_compression},
    {"voxel-rows/table10", "times of voxelization and compression", 10, ChartKind::dots, "", true,
     tables::times_of_building},
    {"voxel-rows/table11", "frame rates with and without compression", 11, ChartKind::dots, "", false,
     tables::times_of_compression},
    {"voxel-rows/figure7", "errors of imperfect shadow maps by the number of points", 0, ChartKind::curves,
     "points for each light", false, tables::errors_by_samples},
    {"visibility-field/table1", "speed-up by the samples of a pixel", 1, ChartKind::curves, "samples a pixel", false,
     tables::field_speed_ups, &xu_2022_paper},
    {"visibility-field/figure5", "times and errors with a field and without", 5, ChartKind::dots, "", true,
     tables::field_pictures, &xu_2022_paper},
    {"visibility-field/figure6", "errors by the number of point samples", 6, ChartKind::curves, "point samples", true,
     tables::field_by_points, &xu_2022_paper},
    {"visibility-field/figure7", "errors, times and memory by the size of the cells", 7, ChartKind::dots, "cm", true,
     tables::field_by_cells, &xu_2022_paper},
    {"visibility-field/figure8", "times by the samples of a pixel", 8, ChartKind::curves, "samples a pixel", true,
     tables::field_by_samples, &xu_2022_paper},
    {"visibility-field/figure9", "with the cells' labels and without", 9, ChartKind::dots, "", true,
     tables::field_labels, &xu_2022_paper},
    {"visibility-field/figure10", "times of glossy surfaces with a field and without", 10, ChartKind::dots, "", true,
     tables::field_glossy, &xu_2022_paper},
    {"visibility-field/memory", "memory of the field, packed and as in the paper", 0, ChartKind::dots, "cm", true,
     tables::field_memory, &xu_2022_paper},
    {"visibility-field/indirect", "times with indirect light, with a field and without", -1, ChartKind::dots, "", true,
     tables::field_indirect, &xu_2022_paper},
    {"visibility-field/moving", "baking a moment of scenes that move", -1, ChartKind::dots, "", true,
     tables::field_moments, &xu_2022_paper},
    {"visibility-field/area-lights", "light of shining surfaces, with what cells know of them and without", -2,
     ChartKind::dots, "", true, tables::field_area_lights, &xu_2022_paper},
    {"visibility-field/caching", "few pixels asked, the others interpolated", -1, ChartKind::dots, "pixels", true,
     tables::field_caching, &xu_2022_paper},
}};

std::string setup_text(const BenchRun& run, const PaperTable& table) {
    const Session& base = run.base;
    const bool varies_lights = table.varied == "lights";
    std::string text = std::to_string(base.size.width) + " x " + std::to_string(base.size.height) + " pixels";
    if (!varies_lights)
        text += base.lights.count == 0 ? ", the scenes' own lights" : ", " + count_text(base.lights.count) + " lights";
    if (run.own_lights && !varies_lights) text += " (park: its own)";
    const std::span<const Parameter> known = find_technique("voxel_rows").parameters;
    for (const auto& [name, value] : technique_parameters(session_of(run, "", {"voxel_rows", {}})))
        text += ", " + name + " " + parameter_text(*std::ranges::find(known, name, &Parameter::name), value);
    return text + (run.quick ? "; quick: a small sample, not the paper's setting" : "");
}

}  // namespace

std::span<const PaperTable> paper_tables() { return all_tables; }

std::span<const PaperTable> tables_of(std::string_view technique) {
    const auto is_of = [&](const PaperTable& table) { return table.name.substr(0, table.name.find('/')) == technique; };
    const auto first = std::ranges::find_if(all_tables, is_of);
    return {first, std::find_if_not(first, all_tables.end(), is_of)};
}

const PaperTable& find_table(std::string_view name) {
    const auto found = std::ranges::find(all_tables, name, &PaperTable::name);
    if (found != all_tables.end()) return *found;
    std::vector<std::string_view> names;
    for (const PaperTable& table : all_tables) names.push_back(table.name);
    const std::string near = nearest_name(std::string(name), names);
    throw InputError("table " + std::string(name), "", "is not known",
                     near.empty() ? "see sightlines bench --help" : "did you mean " + near + "?");
}

std::vector<std::string> scenes_for(MeasuredTable& table, const BenchRun& run, std::span<const std::string_view> all) {
    if (!run.scenes.empty()) return run.scenes;
    std::vector<std::string> scenes;
    for (const std::string_view name : all.first(run.quick ? std::min(all.size(), scenes_when_quick) : all.size())) {
        if (std::ranges::find(builtin_scenes(), name, &SceneModel::name) != builtin_scenes().end())
            scenes.emplace_back(name);
        else
            table.notes.push_back("Left out: " + std::string(name) + ", which is not among the built-in scenes.");
    }
    return scenes;
}

std::vector<int> fitting_resolutions(MeasuredTable& table, const BenchRun& run) {
    if (run.quick) return {32, 64};
    const ParameterValues values = technique_parameters(session_of(run, "", rows_with(false)));
    const double step = parameter_value(find_technique("voxel_rows").parameters, values, "angle_step");
    const std::uint64_t available = available_memory_bytes();
    std::vector<int> fitting;
    for (const int resolution : {32, 64, 128, 256}) {
        const std::uint64_t needed = voxel_rows::compression_bytes(resolution, step);
        if (needed <= available)
            fitting.push_back(resolution);
        else
            table.notes.push_back("Left out: " + std::to_string(resolution) + "³ voxels take " + bytes_text(needed) +
                                  " while they are built, and " + bytes_text(available) + " are free here.");
    }
    return fitting;
}

void say(const BenchRun& run, const MeasuredTable& table, const std::string& what) {
    if (run.say) run.say(table.name + ": " + what);
}

MeasuredRow& add_figure(MeasuredTable& table, std::string_view scene, std::string_view quantity, double ours,
                        std::string_view unit, int digits, double at, const std::string& setting) {
    MeasuredRow row;
    row.scene = scene;
    row.quantity = quantity;
    row.at = at;
    row.setting = setting;
    row.unit = unit;
    row.digits = digits;
    row.ours = ours;
    const PaperTable& known = find_table(table.name);
    row.paper = find_figure(known.paper->figures(known.number), scene, quantity, at);
    return table.rows.emplace_back(row);
}

MeasuredTable measure_table(const PaperTable& table, BenchRun& run, Results& results, Progress& progress) {
    MeasuredTable measured;
    measured.name = table.name;
    measured.title = table.title;
    measured.paper = table.paper->citation;
    measured.paper_hardware = table.paper->hardware;
    measured.our_hardware = processor_name() + ", " + std::to_string(thread_count(results.threads())) + " threads";
    measured.chart = table.chart;
    measured.varied = table.varied;
    measured.log_values = table.log_values;
    table.measure(measured, run, results, progress);
    if (measured.setup.empty()) measured.setup = setup_text(run, table);
    const auto without_paper =
        std::ranges::count_if(measured.rows, [](const MeasuredRow& row) { return !row.paper.has_value(); });
    if (without_paper > 0)
        measured.notes.push_back("A dash under paper: the paper's text has no figure for this scene and setting.");
    return measured;
}

}  // namespace sightlines
