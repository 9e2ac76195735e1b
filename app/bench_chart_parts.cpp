#include "app/bench_chart_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace sightlines::chart {
namespace {

constexpr float panel_height = 190.0f, panel_gap = 20.0f;
constexpr float legend_line = 14.0f;

std::vector<const MeasuredRow*> charted(const MeasuredTable& table) {
    std::vector<const MeasuredRow*> rows;
    for (const MeasuredRow& row : table.rows)
        if (row.in_chart) rows.push_back(&row);
    return rows;
}

/// The different texts of the charted rows, in their order.
std::vector<std::string> names_of(const MeasuredTable& table, std::string MeasuredRow::*member) {
    std::vector<std::string> names;
    for (const MeasuredRow* row : charted(table))
        if (std::ranges::find(names, row->*member) == names.end()) names.push_back(row->*member);
    return names;
}

/// 1, 2 or 5 times a power of ten: at least `rough`.
double round_step(double rough) {
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= rough * 0.999) return factor * power;
    return 10.0 * power;
}

void set_linear(Axis& axis, double highest) {
    const double step = round_step(std::max(highest, 1e-6) / 5.0);
    axis.low = 0.0;
    axis.high = step * std::ceil(highest / step * 0.999 + 1e-9);
    if (axis.high <= 0.0) axis.high = step;
    for (int i = 0; static_cast<double>(i) * step <= axis.high * 1.001; ++i) axis.ticks.push_back(step * i);
}

/// From the round value (1, 2, 5 times a power of ten) below to that above; few decades have all of them as ticks.
void set_logarithmic(Axis& axis, double lowest, double highest) {
    axis.logarithmic = true;
    std::vector<double> rounds;
    const int first = static_cast<int>(std::floor(std::log10(lowest))), last = first + 30;
    for (int power = first; power <= last && (rounds.empty() || rounds.back() < highest); ++power)
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double value = factor * std::pow(10.0, power);
            if (value <= lowest * 1.0001) rounds.clear();
            if (rounds.empty() || rounds.back() < highest * 0.9999) rounds.push_back(value);
        }
    if (rounds.size() < 2) rounds.push_back(2.0 * rounds.front());
    axis.low = rounds.front();
    axis.high = rounds.back();
    const bool all = rounds.size() <= 8;
    for (const double value : rounds) {
        const double power = std::log10(value);
        if (all || std::abs(power - std::round(power)) < 1e-6) axis.ticks.push_back(value);
    }
}

/// The settings of the curves along `from` to `to`, logarithmic.
Axis setting_axis(const MeasuredTable& table, float from, float to) {
    Axis axis;
    axis.from = from;
    axis.to = to;
    axis.logarithmic = true;
    for (const MeasuredRow* row : charted(table))
        if (std::ranges::find(axis.ticks, row->at) == axis.ticks.end()) axis.ticks.push_back(row->at);
    std::ranges::sort(axis.ticks);
    if (axis.ticks.empty() || axis.ticks.front() <= 0.0) axis.ticks = {1.0};
    const double room = std::pow(axis.ticks.back() / axis.ticks.front(), 0.08) * 1.05;
    axis.low = axis.ticks.front() / room;
    axis.high = axis.ticks.back() * room;
    return axis;
}

void draw_grid(Canvas& canvas, const Axis& x, const Axis& y) {
    const Palette colours = palette(Theme::print);
    const TextStyle right{.height = text_height, .colour = colours.muted, .align = Align::right};
    TextStyle centred = right;
    centred.align = Align::centre;
    for (const double tick : y.ticks) {
        draw_line(canvas, {x.from, y.place(tick)}, {x.to, y.place(tick)}, {.colour = colours.hairline, .width = 0.5f});
        draw_text(canvas, {x.from - 5.0f, y.place(tick) + 0.35f * text_height}, tick_text(tick), right);
    }
    float free_from = 0.0f;
    for (const double tick : x.ticks) {
        const float at = x.place(tick), half = 0.5f * text_width(canvas, tick_text(tick), centred);
        draw_line(canvas, {at, y.from}, {at, y.from + 3.0f}, {.colour = colours.muted, .width = 0.5f});
        if (at - half < free_from) continue;
        draw_text(canvas, {at, y.from + 13.0f}, tick_text(tick), centred);
        free_from = at + half + 4.0f;
    }
}

Stroke curve_stroke(vec3 colour, bool papers) {
    return {.colour = colour, .width = 1.4f, .dash = papers ? 4.0f : 0.0f, .gap = papers ? 3.0f : 0.0f};
}

void draw_curve(Canvas& canvas, const std::vector<vec2>& points, vec3 colour, bool papers) {
    if (points.size() > 1) draw_path(canvas, points, false, curve_stroke(colour, papers));
    for (const vec2 point : points) draw_mark(canvas, point, colour, papers);
}

/// Whether a quantity has any figure of ours, or of the paper's.
bool has_figures(const MeasuredTable& table, const std::string& quantity, bool papers) {
    return std::ranges::any_of(charted(table), [&](const MeasuredRow* row) {
        return row->quantity == quantity && (papers ? row->paper : row->ours).has_value();
    });
}

void draw_panel(Canvas& canvas, const MeasuredTable& table, const std::string& scene, vec2 corner, float width) {
    const Palette colours = palette(Theme::print);
    const float bottom = corner.y + panel_height - 46.0f;
    const Axis x = setting_axis(table, corner.x + 38.0f, corner.x + width);
    const Axis y = axis_of(charted(table), table.log_values, bottom, corner.y + 26.0f);
    const TextStyle muted{.height = text_height, .colour = colours.muted};
    TextStyle title{.height = text_height + 1.0f, .colour = colours.ink, .bold = true};
    const std::string unit = charted(table).front()->unit + (y.logarithmic ? ", logarithmic" : "");
    draw_text(canvas, {x.from, corner.y + 12.0f}, scene, title);
    TextStyle right = muted;
    right.align = Align::right;
    draw_text(canvas, {x.to, corner.y + 12.0f}, unit, right);
    draw_grid(canvas, x, y);
    right.align = Align::centre;
    draw_text(canvas, {0.5f * (x.from + x.to), bottom + 26.0f}, table.varied, right);
    const std::vector<std::string> quantities = names_of(table, &MeasuredRow::quantity);
    for (std::size_t series = 0; series < quantities.size(); ++series)
        for (const bool papers : {true, false}) {
            std::vector<vec2> points;
            for (const MeasuredRow* row : charted(table)) {
                const std::optional<double>& value = papers ? row->paper : row->ours;
                if (row->scene == scene && row->quantity == quantities[series] && value)
                    points.push_back({x.place(row->at), y.place(*value)});
            }
            draw_curve(canvas, points, series_colour(series), papers);
        }
}

}  // namespace

float Axis::place(double value) const {
    const double share =
        logarithmic ? std::log(std::max(value, 1e-12) / low) / std::log(high / low) : (value - low) / (high - low);
    return from + static_cast<float>(share) * (to - from);
}

Axis axis_of(const std::vector<const MeasuredRow*>& rows, bool logarithmic, float from, float to) {
    double lowest = 1e300, highest = 0.0;
    for (const MeasuredRow* row : rows)
        for (const std::optional<double>& value : {row->ours, row->paper}) {
            if (!value) continue;
            lowest = std::min(lowest, *value);
            highest = std::max(highest, *value);
        }
    Axis axis;
    axis.from = from;
    axis.to = to;
    if (logarithmic && lowest > 0.0 && highest > 0.0)
        set_logarithmic(axis, lowest, highest);
    else
        set_linear(axis, highest);
    return axis;
}

std::string tick_text(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), value >= 1.0 && value < 1e9 ? "%.10g" : "%.3g", value);
    std::string digits = text.data();
    if (value < 1e9 && digits.find('.') == std::string::npos)
        for (std::size_t place = 3; place < digits.size(); place += 4) digits.insert(digits.size() - place, 1, ',');
    return digits;
}

vec3 series_colour(std::size_t series) {
    const std::array<vec3, 4> colours{srgb(0x0067B8), srgb(0xE8590C), srgb(0x007A5A), srgb(0xC2187A)};
    return colours[series % colours.size()];
}

void draw_mark(Canvas& canvas, vec2 at, vec3 colour, bool papers) {
    if (!papers) {
        fill_circle(canvas, at, 3.0f, colour);
        return;
    }
    const Rectangle square{at - 3.0f, vec2(6.0f)};
    fill_rectangle(canvas, square, palette(Theme::print).page);
    draw_rectangle(canvas, square, {.colour = colour, .width = 1.3f});
}

void draw_heading(Canvas& canvas, const MeasuredTable& table) {
    const Palette colours = palette(Theme::print);
    TextStyle title{.height = text_height + 3.0f, .colour = colours.ink, .bold = true};
    const TextStyle small{.height = text_height - 1.0f, .colour = colours.muted};
    draw_text(canvas, {margin, 20.0f}, table.name + ": " + table.title, title);
    draw_text(canvas, {margin, 33.0f}, "Ours: " + table.our_hardware, small);
    draw_text(canvas, {margin, 43.0f}, "Setup: " + table.setup, small);
    draw_text(canvas, {margin, 53.0f}, "Paper: " + table.paper_hardware, small);
}

float legend_height(const MeasuredTable& table) {
    const bool curves = table.chart == ChartKind::curves;
    return 8.0f + legend_line * static_cast<float>(curves ? names_of(table, &MeasuredRow::quantity).size() : 1);
}

void draw_legend(Canvas& canvas, const MeasuredTable& table, float top) {
    const bool curves = table.chart == ChartKind::curves;
    const TextStyle text{.height = text_height, .colour = palette(Theme::print).ink};
    const std::vector<std::string> quantities =
        curves ? names_of(table, &MeasuredRow::quantity) : std::vector<std::string>{""};
    const float sample = curves ? 22.0f : 6.0f;
    float x = margin;
    for (const bool papers : {false, true}) {
        float y = top + legend_line, widest = 0.0f;
        for (std::size_t series = 0; series < quantities.size(); ++series, y += legend_line) {
            if (curves && !has_figures(table, quantities[series], papers)) continue;
            const vec3 colour = series_colour(curves ? series : papers ? 1 : 0);
            if (curves) {
                const std::array<vec2, 2> line{vec2(x, y - 3.0f), vec2(x + sample, y - 3.0f)};
                draw_path(canvas, line, false, curve_stroke(colour, papers));
            }
            draw_mark(canvas, {x + 0.5f * sample, y - 3.0f}, colour, papers);
            const std::string label = (curves ? quantities[series] + ", " : "") + (papers ? "the paper's" : "ours");
            draw_text(canvas, {x + sample + 6.0f, y}, label, text);
            widest = std::max(widest, text_width(canvas, label, text));
        }
        x += sample + 6.0f + widest + 24.0f;
    }
}

float curves_height(const MeasuredTable& table) {
    const std::size_t scenes = names_of(table, &MeasuredRow::scene).size();
    return static_cast<float>((scenes + 1) / 2) * panel_height - 4.0f;
}

void draw_curves(Canvas& canvas, const MeasuredTable& table, float top) {
    const std::vector<std::string> scenes = names_of(table, &MeasuredRow::scene);
    const float width = 0.5f * (page_width - 2.0f * margin - panel_gap);
    for (std::size_t i = 0; i < scenes.size(); ++i)
        draw_panel(
            canvas, table, scenes[i],
            {margin + static_cast<float>(i % 2) * (width + panel_gap), top + static_cast<float>(i / 2) * panel_height},
            width);
}

}  // namespace sightlines::chart
