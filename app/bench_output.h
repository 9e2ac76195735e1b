// What a measured table becomes: Markdown, CSV, JSON and a chart, all from one value.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/session.h"

namespace sightlines {

/// One figure of ours beside the paper's.
struct MeasuredRow {
    std::string scene, quantity;
    double at = 0.0;      ///< what the table varies (lights, voxels, ...); 0: nothing
    std::string setting;  ///< the same for people: "1,024 lights"; may be empty
    std::string unit;
    int digits = 1;  ///< after the point
    std::optional<double> ours, paper;
    bool in_chart = true;
};

/// How a table is drawn: a line for each row, ours and the paper's as dots on it; or, for each scene, curves over `at`.
enum class ChartKind { dots, curves };

struct MeasuredTable {
    std::string name;   ///< "voxel-rows/table1"
    std::string title;  ///< of the paper's table
    std::string paper, paper_hardware, our_hardware;
    std::string setup;  ///< what we measured with: picture, lights, parameters
    ChartKind chart = ChartKind::dots;
    std::string varied;  ///< what `at` is, for the axis of curves
    bool log_values = false;
    std::vector<MeasuredRow> rows;
    std::vector<std::string> notes;
};

/// Ours as a multiple of the paper's, where both are known.
std::optional<double> ratio_to_paper(const MeasuredRow& row);

/// A figure for people; "-" where there is none.
std::string figure_text(const std::optional<double>& value, int digits);

/// Aligned, for the terminal.
std::string text_from_measured(const MeasuredTable& table);
/// With both machines, the setup and the notes.
std::string markdown_from_measured(const MeasuredTable& table);
/// One line a figure, with full precision; empty where there is none.
std::string csv_from_measured(const MeasuredTable& table);
Json json_from_measured(const MeasuredTable& table);

/// "voxel-rows-table1", the files' name without the extension.
std::string file_stem(const MeasuredTable& table);

/// Writes NAME.md, NAME.csv and NAME.svg into the folder, which exists. EnvironmentError where that is not possible.
void write_measured(const MeasuredTable& table, const std::filesystem::path& folder);

}  // namespace sightlines
