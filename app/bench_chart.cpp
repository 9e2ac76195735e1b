#include "app/bench_chart.h"

#include <algorithm>

#include "app/bench_chart_parts.h"

namespace sightlines {
namespace {

using namespace chart;

constexpr float row_height = 14.0f;

/// The rows of a chart that share a unit, and so an axis.
struct UnitRows {
    std::string unit;
    std::vector<const MeasuredRow*> rows;
};

std::vector<UnitRows> by_unit(const MeasuredTable& table) {
    std::vector<UnitRows> units;
    for (const MeasuredRow& row : table.rows) {
        if (!row.in_chart) continue;
        auto found = std::ranges::find(units, row.unit, &UnitRows::unit);
        if (found == units.end()) found = units.insert(units.end(), {row.unit, {}});
        found->rows.push_back(&row);
    }
    return units;
}

float dots_height(const std::vector<UnitRows>& units) {
    float height = 0.0f;
    for (const UnitRows& unit : units) height += 54.0f + row_height * static_cast<float>(unit.rows.size());
    return height;
}

/// A line for each row: what it is, both dots on the axis, both figures.
void draw_dot_row(Canvas& canvas, const MeasuredRow& row, const Axis& axis, float y, bool names_scene) {
    const Palette colours = palette(Theme::print);
    const TextStyle text{.height = text_height, .colour = colours.ink};
    const TextStyle number{.height = text_height, .colour = colours.ink, .align = Align::right};
    const float base = y + 0.35f * text_height;
    TextStyle scene = text;
    scene.bold = true;
    if (names_scene) draw_text(canvas, {margin, base}, row.scene, scene);
    draw_text(canvas, {margin + 58.0f, base}, row.quantity + (row.setting.empty() ? "" : ", " + row.setting), text);
    if (row.ours && row.paper)
        draw_line(canvas, {axis.place(*row.ours), y}, {axis.place(*row.paper), y},
                  {.colour = colours.hairline, .width = 1.5f});
    if (row.paper) draw_mark(canvas, {axis.place(*row.paper), y}, series_colour(1), true);
    if (row.ours) draw_mark(canvas, {axis.place(*row.ours), y}, series_colour(0), false);
    draw_text(canvas, {page_width - margin - 96.0f, base}, figure_text(row.ours, row.digits), number);
    draw_text(canvas, {page_width - margin - 46.0f, base}, figure_text(row.paper, row.digits), number);
    draw_text(canvas, {page_width - margin, base}, figure_text(ratio_to_paper(row), 2), number);
}

/// Gives the height used.
float draw_dots_of(Canvas& canvas, const UnitRows& unit, bool logarithmic, float top) {
    const Palette colours = palette(Theme::print);
    const TextStyle heading{.height = text_height, .colour = colours.muted};
    TextStyle right = heading;
    right.align = Align::right;
    const Axis axis = axis_of(unit.rows, logarithmic, margin + 226.0f, page_width - margin - 140.0f);
    const float first = top + 26.0f, bottom = first + row_height * static_cast<float>(unit.rows.size());
    draw_text(canvas, {margin + 226.0f, top + 12.0f}, unit.unit + (axis.logarithmic ? ", logarithmic" : ""), heading);
    draw_text(canvas, {page_width - margin - 96.0f, top + 12.0f}, "ours", right);
    draw_text(canvas, {page_width - margin - 46.0f, top + 12.0f}, "paper", right);
    draw_text(canvas, {page_width - margin, top + 12.0f}, "ratio", right);
    for (const double tick : axis.ticks) {
        const float x = axis.place(tick);
        draw_line(canvas, {x, first - 6.0f}, {x, bottom}, {.colour = colours.hairline, .width = 0.5f});
        TextStyle centred = heading;
        centred.align = Align::centre;
        draw_text(canvas, {x, bottom + 11.0f}, tick_text(tick), centred);
    }
    float y = first + 0.5f * row_height;
    std::string scene;
    for (const MeasuredRow* row : unit.rows) {
        const bool begins = row->scene != scene;
        if (begins && !scene.empty())
            draw_line(canvas, {margin, y - 0.5f * row_height}, {page_width - margin, y - 0.5f * row_height},
                      {.colour = colours.hairline, .width = 0.5f});
        draw_dot_row(canvas, *row, axis, y, begins);
        scene = row->scene;
        y += row_height;
    }
    return bottom + 28.0f - top;
}

}  // namespace

std::vector<std::uint8_t> svg_from_measured(const MeasuredTable& table) {
    const std::vector<UnitRows> units = by_unit(table);
    const bool curves = table.chart == ChartKind::curves;
    const float body = curves ? curves_height(table) : dots_height(units);
    const float legend = legend_height(table);
    Canvas canvas = make_page_canvas(CanvasFormat::svg, {page_width, 58.0f + legend + body}, 72.0f);
    fill_rectangle(canvas, {{0.0f, 0.0f}, canvas.size}, palette(Theme::print).page);
    draw_heading(canvas, table);
    draw_legend(canvas, table, 58.0f);
    float top = 58.0f + legend;
    if (curves)
        draw_curves(canvas, table, top);
    else
        for (const UnitRows& unit : units) top += draw_dots_of(canvas, unit, table.log_values, top);
    return finished_file(canvas);
}

}  // namespace sightlines
