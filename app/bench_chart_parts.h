// Axes, marks, legends and curves of the charts of measured tables.
#pragma once

#include <string>
#include <vector>

#include "app/bench_output.h"
#include "visualizers/canvas.h"
#include "visualizers/theme.h"

namespace sightlines::chart {

constexpr float page_width = 560.0f, margin = 14.0f, text_height = 8.5f;  // points

/// Values along a line of the page.
struct Axis {
    double low = 0.0, high = 1.0;
    float from = 0.0f, to = 1.0f;  ///< where low and high stand
    bool logarithmic = false;
    std::vector<double> ticks;

    float place(double value) const;
};

/// For all figures of the rows: from 0, or of whole decades where `logarithmic` and all are positive.
Axis axis_of(const std::vector<const MeasuredRow*>& rows, bool logarithmic, float from, float to);

/// 0.5, 20, 1,000
std::string tick_text(double value);

/// Of the n-th quantity of curves; of dots, 0 is ours and 1 the paper's.
vec3 series_colour(std::size_t series);
/// A disc, or a hollow square for the paper's.
void draw_mark(Canvas& canvas, vec2 at, vec3 colour, bool papers);

void draw_heading(Canvas& canvas, const MeasuredTable& table);
float legend_height(const MeasuredTable& table);
void draw_legend(Canvas& canvas, const MeasuredTable& table, float top);

/// A panel for each scene, two side by side; all with the same axes.
float curves_height(const MeasuredTable& table);
void draw_curves(Canvas& canvas, const MeasuredTable& table, float top);

}  // namespace sightlines::chart
