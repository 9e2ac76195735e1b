#include "app/bench_output.h"

#include <algorithm>

#include "app/bench_chart.h"
#include "app/table.h"
#include "techniques/base/files.h"

namespace sightlines {
namespace {

Json json_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::string full_precision(const std::optional<double>& value) { return value ? Json(*value).dump() : ""; }

std::string setting_text(const MeasuredRow& row) { return row.setting.empty() ? "-" : row.setting; }

TextTable table_for_people(const MeasuredTable& measured) {
    TextTable table;
    table.heading = {"scene", "quantity", "at", "unit", "ours", "paper", "ours / paper"};
    table.align = {TableAlign::left,  TableAlign::left,  TableAlign::right, TableAlign::left,
                   TableAlign::right, TableAlign::right, TableAlign::right};
    for (const MeasuredRow& row : measured.rows)
        table.rows.push_back({row.scene, row.quantity, setting_text(row), row.unit, figure_text(row.ours, row.digits),
                              figure_text(row.paper, row.digits), figure_text(ratio_to_paper(row), 2)});
    return table;
}

/// A bar would end the cell of a Markdown table, a line break the table.
TextTable without_bars(TextTable table) {
    for (auto& row : table.rows)
        for (std::string& cell : row) {
            std::ranges::replace(cell, '\n', ' ');
            for (std::size_t at = 0; (at = cell.find('|', at)) != std::string::npos; at += 2) cell.insert(at, "\\");
        }
    return table;
}

}  // namespace

std::optional<double> ratio_to_paper(const MeasuredRow& row) {
    if (!row.ours || !row.paper || *row.paper == 0.0) return std::nullopt;
    return *row.ours / *row.paper;
}

std::string figure_text(const std::optional<double>& value, int digits) {
    return value ? fixed_text(*value, digits) : "-";
}

std::string text_from_measured(const MeasuredTable& measured) {
    std::string text = measured.name + ": " + measured.title + "\nOurs: " + measured.our_hardware + "; " +
                       measured.setup + "\nPaper: " + measured.paper_hardware + "\n" +
                       text_from(table_for_people(measured));
    for (const std::string& note : measured.notes) text.append("  * ").append(note).append("\n");
    return text;
}

std::string markdown_from_measured(const MeasuredTable& measured) {
    std::string text = "# " + measured.name + ": " + measured.title + "\n\n" + "- Paper: " + measured.paper +
                       "\n- Paper's hardware: " + measured.paper_hardware +
                       "\n- Our hardware: " + measured.our_hardware + "\n- Our setup: " + measured.setup + "\n\n" +
                       markdown_from(without_bars(table_for_people(measured)));
    if (!measured.notes.empty()) text += "\n";
    for (const std::string& note : measured.notes) text.append("- ").append(note).append("\n");
    return text + "\n![" + measured.title + "](" + file_stem(measured) + ".svg)\n";
}

std::string csv_from_measured(const MeasuredTable& measured) {
    TextTable table;
    table.heading = {"table", "scene", "quantity",      "at",           "unit",
                     "ours",  "paper", "ours_to_paper", "our_hardware", "paper_hardware"};
    for (const MeasuredRow& row : measured.rows)
        table.rows.push_back({measured.name, row.scene, row.quantity, row.at == 0.0 ? "" : full_precision(row.at),
                              row.unit, full_precision(row.ours), full_precision(row.paper),
                              full_precision(ratio_to_paper(row)), measured.our_hardware, measured.paper_hardware});
    return csv_from(table);
}

Json json_from_measured(const MeasuredTable& measured) {
    Json rows = Json::array();
    for (const MeasuredRow& row : measured.rows)
        rows.push_back({{"scene", row.scene},
                        {"quantity", row.quantity},
                        {"at", row.at == 0.0 ? Json() : Json(row.at)},
                        {"unit", row.unit},
                        {"ours", json_or_null(row.ours)},
                        {"paper", json_or_null(row.paper)},
                        {"ours_to_paper", json_or_null(ratio_to_paper(row))}});
    return {{"table", measured.name},
            {"title", measured.title},
            {"setup", measured.setup},
            {"hardware", {{"ours", measured.our_hardware}, {"paper", measured.paper_hardware}}},
            {"rows", rows},
            {"notes", measured.notes}};
}

std::string file_stem(const MeasuredTable& table) {
    std::string stem = table.name;
    std::ranges::replace(stem, '/', '-');
    return stem;
}

void write_measured(const MeasuredTable& table, const std::filesystem::path& folder) {
    const std::string stem = file_stem(table);
    write_file(folder / (stem + ".md"), markdown_from_measured(table));
    write_file(folder / (stem + ".csv"), csv_from_measured(table));
    write_file(folder / (stem + ".svg"), svg_from_measured(table));
}

}  // namespace sightlines
