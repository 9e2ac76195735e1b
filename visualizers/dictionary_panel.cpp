#include "visualizers/dictionary_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "visualizers/theme.h"

namespace sightlines {
namespace {

constexpr float rows_height = 11.2f, charts_height = 13.4f;  // em
constexpr float least_view_share = 0.36f;                    // of the height, that is left to the view in space
constexpr float least_chart_width = 17.0f;                   // em

struct Sheet {
    Canvas& canvas;
    const DictionaryPicture& picture;
    Palette colours;
    float em;
};

/// "1,234,567".
std::string grouped(std::uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
    return text;
}

std::string percent(double share) {
    std::array<char, 32> out{};
    std::snprintf(out.data(), out.size(), share < 0.001 && share > 0.0 ? "%.2g %%" : "%.1f %%", 100.0 * share);
    return out.data();
}

TextStyle text_style(const Sheet& sheet, vec3 colour, float height = 1.0f) {
    return {.height = height * sheet.em, .colour = colour};
}

int step_count(const DictionaryPicture& picture) { return static_cast<int>(picture.summary->rows_mapped.size()); }

/// How the row was mapped: in full, or in few words.
std::string mapping_sentence(const DictionaryPicture& picture, bool brief) {
    const std::string row = "row " + grouped(picture.mapped_index), index = row + (brief ? "" : " of the dictionary");
    const std::string times = grouped(picture.frequency) + " times";
    if (picture.step == 0 && brief) return "Step 0: is " + row + ", held " + times;
    if (picture.step == 0) return "Mapped by step 0: it is " + index + ", which the array holds " + times;
    if (picture.step == step_count(picture))
        return brief ? "Left over: " + row + " stands for it"
                     : "Left over: matches no row at any step; " + index + " stands for it";
    return (brief ? "Step " : "Mapped by step ") + std::to_string(picture.step) + (brief ? ": " : " to ") + index +
           (brief ? ", down-sampled by " : ": the same down-sampled by ") + std::to_string(1 << picture.step);
}

std::string verdict_sentence(const DictionaryPicture& picture) {
    const auto word = [](bool blocked) { return blocked ? std::string("blocked") : std::string("open"); };
    const bool own = picture.row.blocked, mapped = is_mapped_blocked(picture);
    if (own == mapped) return "Both rows answer: " + word(own);
    return "Compression changed the answer: " + word(own) + " became " + word(mapped);
}

/// A row as cells; the ones outside the extent are lower.
void draw_row(const Sheet& sheet, const Rectangle& where, const std::string& name, const auto& is_set_at) {
    const VoxelRowPicture& row = sheet.picture.row;
    const float pitch = where.size.x / static_cast<float>(row.resolution);
    const float gap = std::min(0.12f * pitch, 0.6f);
    for (int u = 0; u < row.resolution; ++u) {
        const bool kept = u >= row.first && u <= row.last;
        const float inset = kept ? 0.0f : 0.22f * where.size.y;
        const Rectangle cell{where.corner + vec2(pitch * static_cast<float>(u) + 0.5f * gap, inset),
                             {pitch - gap, where.size.y - 2.0f * inset}};
        if (is_set_at(u))
            fill_rectangle(sheet.canvas, cell, kept ? sheet.colours.set_bit : sheet.colours.set_bit_clipped);
        else
            fill_rectangle(sheet.canvas, cell, sheet.colours.hairline, kept ? 0.75f : 0.4f);
    }
    TextStyle style = text_style(sheet, sheet.colours.muted, 0.92f);
    style.align = Align::right;
    draw_text(sheet.canvas, where.corner + vec2(-0.7f * sheet.em, 0.5f * where.size.y + 0.33f * sheet.em), name, style);
}

/// Between the rows: a bar at each bit that differs. Below: the groups whose bits were joined to find the match.
void draw_differences(const Sheet& sheet, const Rectangle& between, float groups_y) {
    const DictionaryPicture& picture = sheet.picture;
    const float pitch = between.size.x / static_cast<float>(picture.row.resolution);
    for (int u = 0; u < picture.row.resolution; ++u)
        if (differs(picture, u))
            fill_rectangle(sheet.canvas,
                           {between.corner + vec2(pitch * static_cast<float>(u), 0.0f), {pitch, between.size.y}},
                           sheet.colours.pointed);
    if (picture.step == 0 || picture.step == step_count(picture)) return;
    const int group = 1 << picture.step;
    for (int u = 0; u < picture.row.resolution; u += group) {
        const int end = std::min(u + group, picture.row.resolution);
        const float inset = std::min(0.8f, 0.15f * pitch);
        draw_line(sheet.canvas, {between.corner.x + pitch * static_cast<float>(u) + inset, groups_y},
                  {between.corner.x + pitch * static_cast<float>(end) - inset, groups_y},
                  {.colour = sheet.colours.muted, .width = 0.12f * sheet.em});
    }
}

void draw_rows(const Sheet& sheet, const Rectangle& where) {
    const DictionaryPicture& picture = sheet.picture;
    const float em = sheet.em;
    const bool changed = picture.row.blocked != is_mapped_blocked(picture);
    TextStyle title = text_style(sheet, changed ? sheet.colours.pointed : sheet.colours.ink, 1.05f);
    title.bold = true;
    draw_text(sheet.canvas, where.corner + vec2(0.0f, 1.3f * em), verdict_sentence(picture), title);
    const TextStyle plain = text_style(sheet, sheet.colours.ink);
    const bool brief = text_width(sheet.canvas, mapping_sentence(picture, false), plain) > where.size.x;
    draw_text(sheet.canvas, where.corner + vec2(0.0f, 2.95f * em), mapping_sentence(picture, brief), plain);
    const float label = 6.4f * em, left = where.corner.x + label, width = where.size.x - label;
    const Rectangle own{{left, where.corner.y + 4.0f * em}, {width, 1.6f * em}};
    const Rectangle between{{left, own.corner.y + 1.7f * em}, {width, 0.7f * em}};
    const Rectangle mapped{{left, between.corner.y + 0.8f * em}, {width, 1.6f * em}};
    draw_row(sheet, own, "own row", [&](int u) { return is_set(picture.row, {u, picture.row.v, picture.row.w}); });
    draw_row(sheet, mapped, "dictionary", [&](int u) { return picture.mapped[static_cast<std::size_t>(u)] != 0; });
    draw_differences(sheet, between, mapped.corner.y + 2.0f * em);
    int differing = 0;
    for (int u = 0; u < picture.row.resolution; ++u) differing += differs(picture, u);
    const std::string note = differing == 0
                                 ? "no bit differs"
                                 : std::to_string(differing) + (differing == 1 ? " bit differs" : " bits differ");
    TextStyle style = text_style(sheet, differing == 0 ? sheet.colours.muted : sheet.colours.pointed, 0.92f);
    draw_text(sheet.canvas, {left, mapped.corner.y + 3.2f * em}, note, style);
    if (picture.step > 0 && picture.step < step_count(picture)) {
        style.colour = sheet.colours.muted;
        style.align = Align::right;
        draw_text(sheet.canvas, {left + width, mapped.corner.y + 3.2f * em},
                  "groups of " + std::to_string(1 << picture.step) + ": any bit set", style);
    }
}

/// The chart's title; gives what is left below.
Rectangle titled(const Sheet& sheet, const Rectangle& where, const std::string& title) {
    TextStyle style = text_style(sheet, sheet.colours.ink);
    style.bold = true;
    draw_text(sheet.canvas, where.corner + vec2(0.0f, 1.2f * sheet.em), title, style);
    return {where.corner + vec2(0.0f, 2.0f * sheet.em), where.size - vec2(0.0f, 2.0f * sheet.em)};
}

void draw_steps(const Sheet& sheet, const Rectangle& where) {
    const DictionarySummary& summary = *sheet.picture.summary;
    const Rectangle body = titled(sheet, where, "Rows mapped by step");
    std::vector<std::uint64_t> counts = summary.rows_mapped;
    counts.push_back(summary.rows_left_over);
    std::uint64_t all = 0, most = 1;
    for (const std::uint64_t count : counts) all += count, most = std::max(most, count);
    const float em = sheet.em, label = 5.6f * em, number = 4.6f * em;
    const float pitch = std::min(body.size.y / static_cast<float>(counts.size()), 1.9f * em);
    for (std::size_t step = 0; step < counts.size(); ++step) {
        const bool own = static_cast<int>(step) == sheet.picture.step;
        const float y = body.corner.y + pitch * static_cast<float>(step);
        const std::string name = step == 0 ? "0: equal"
                                 : step + 1 == counts.size()
                                     ? "left over"
                                     : std::to_string(step) + ": by " + std::to_string(1u << step);
        const vec3 colour = own ? sheet.colours.pointed : sheet.colours.ink;
        draw_text(sheet.canvas, {body.corner.x, y + 0.68f * pitch}, name, text_style(sheet, colour, 0.92f));
        const double share = static_cast<double>(counts[step]) / static_cast<double>(std::max<std::uint64_t>(all, 1));
        const float length =
            (body.size.x - label - number) * static_cast<float>(counts[step]) / static_cast<float>(most);
        fill_rectangle(sheet.canvas,
                       {{body.corner.x + label, y + 0.18f * pitch}, {std::max(length, 1.0f), 0.62f * pitch}},
                       own ? sheet.colours.pointed : sheet.colours.section);
        draw_text(sheet.canvas, {body.corner.x + label + length + 0.4f * em, y + 0.68f * pitch}, percent(share),
                  text_style(sheet, sheet.colours.muted, 0.92f));
    }
}

/// 1, 1 k, 1 M at powers of ten.
std::string power_of_ten(int power) {
    constexpr std::array<const char*, 10> names{"1",     "10",  "100",  "1 k",   "10 k",
                                                "100 k", "1 M", "10 M", "100 M", "1 G"};
    return names[static_cast<std::size_t>(std::min(power, 9))];
}

/// Where a rank and a frequency lie, on logarithmic axes.
struct LogAxes {
    Rectangle body;
    float decades_x = 1.0f, decades_y = 1.0f;

    vec2 at(double rank, double frequency) const {
        const float x = static_cast<float>(std::log10(rank + 1.0)) / decades_x;
        const float y = static_cast<float>(std::log10(std::max(frequency, 1.0))) / decades_y;
        return body.corner + body.size * vec2(x, 1.0f - y);
    }
};

void draw_log_axes(const Sheet& sheet, const LogAxes& axes) {
    const float em = sheet.em;
    const Stroke line{.colour = sheet.colours.hairline, .width = 0.07f * em};
    TextStyle style = text_style(sheet, sheet.colours.muted, 0.85f);
    const vec2 low = axes.body.corner, high = low + axes.body.size;
    for (int power = 0; static_cast<float>(power) <= axes.decades_y + 0.01f; power += 2) {
        const float y = axes.at(0.0, std::pow(10.0, power)).y;
        draw_line(sheet.canvas, {low.x, y}, {high.x, y}, line);
        style.align = Align::right;
        draw_text(sheet.canvas, {low.x - 0.4f * em, y + 0.3f * em}, power_of_ten(power), style);
    }
    for (int power = 0; static_cast<float>(power) <= axes.decades_x + 0.01f; power += 2) {
        const float x = axes.at(std::pow(10.0, power) - 1.0, 1.0).x;
        draw_line(sheet.canvas, {x, low.y}, {x, high.y}, line);
        style.align = Align::centre;
        draw_text(sheet.canvas, {x, high.y + 1.15f * em}, power_of_ten(power), style);
    }
    style.align = Align::right;
    draw_text(sheet.canvas, {high.x, high.y + 2.3f * em}, "place in the dictionary", style);
}

void draw_frequencies(const Sheet& sheet, const Rectangle& where) {
    const auto& frequencies = sheet.picture.summary->frequencies;
    Rectangle body = titled(sheet, where, "How often each occurs");
    const float em = sheet.em;
    body.corner.x += 3.6f * em;
    body.size -= vec2(3.6f * em + 1.2f * em, 2.7f * em);
    if (frequencies.empty()) return;
    const LogAxes axes{body, std::max(1.0f, static_cast<float>(std::log10(static_cast<double>(frequencies.size())))),
                       std::max(1.0f, std::ceil(static_cast<float>(std::log10(frequencies.front() + 1.0))))};
    draw_log_axes(sheet, axes);
    std::vector<vec2> curve;
    constexpr int points = 160;
    for (int i = 0; i <= points; ++i) {
        const double rank =
            std::floor(std::pow(static_cast<double>(frequencies.size()), static_cast<double>(i) / points)) - 1.0;
        curve.push_back(axes.at(rank, frequencies[static_cast<std::size_t>(rank)]));
    }
    draw_path(sheet.canvas, curve, false, {.colour = sheet.colours.section, .width = 0.16f * em, .round_ends = true});
    const auto rank =
        std::ranges::lower_bound(frequencies, sheet.picture.frequency, std::greater()) - frequencies.begin();
    fill_circle(sheet.canvas, axes.at(static_cast<double>(rank), sheet.picture.frequency), 0.36f * em,
                sheet.colours.pointed);
}

void draw_most_used(const Sheet& sheet, const Rectangle& where) {
    const DictionarySummary& summary = *sheet.picture.summary;
    const Rectangle body = titled(sheet, where, "The most used rows");
    const float em = sheet.em, number = 6.2f * em;
    const std::size_t shown = std::min(summary.most_used.size(), static_cast<std::size_t>(body.size.y / (0.95f * em)));
    for (std::size_t k = 0; k < shown; ++k) {
        const std::vector<std::uint8_t>& bits = summary.most_used[k];
        const float pitch = (body.size.x - number) / static_cast<float>(bits.size());
        const vec2 corner = body.corner + vec2(0.0f, 0.95f * em * static_cast<float>(k));
        fill_rectangle(sheet.canvas, {corner, {body.size.x - number, 0.72f * em}}, sheet.colours.hairline, 0.75f);
        for (std::size_t u = 0; u < bits.size(); ++u)
            if (bits[u] != 0)
                fill_rectangle(sheet.canvas, {corner + vec2(pitch * static_cast<float>(u), 0.0f), {pitch, 0.72f * em}},
                               sheet.colours.set_bit);
        TextStyle style = text_style(sheet, sheet.colours.muted, 0.82f);
        style.align = Align::right;
        draw_text(sheet.canvas, {body.corner.x + body.size.x, corner.y + 0.66f * em}, grouped(summary.frequencies[k]),
                  style);
    }
}

}  // namespace

float dictionary_panel_height(vec2 size, float em) {
    const float most = (1.0f - least_view_share) * size.y;
    if ((rows_height + charts_height) * em <= most) return (rows_height + charts_height) * em;
    return rows_height * em <= most ? rows_height * em : 0.0f;
}

void draw_dictionary_panel(Canvas& canvas, const DictionaryPicture& picture, const ViewState& state,
                           const Rectangle& where, float em) {
    const Sheet sheet{canvas, picture, palette(state.theme), em};
    const float margin = em;
    const vec2 corner = where.corner + vec2(margin, 0.0f);
    const float width = where.size.x - 2.0f * margin;
    draw_rows(sheet, {corner, {width, rows_height * em}});
    if (where.size.y < (rows_height + charts_height) * em - 0.5f) return;
    using Chart = void (*)(const Sheet&, const Rectangle&);
    constexpr std::array<Chart, 3> charts{draw_steps, draw_frequencies, draw_most_used};
    const auto fitting = static_cast<std::size_t>(std::clamp(width / (least_chart_width * em), 1.0f, 3.0f));
    const float gap = 2.0f * em;
    const float each = (width - gap * static_cast<float>(fitting - 1)) / static_cast<float>(fitting);
    for (std::size_t k = 0; k < fitting; ++k)
        charts[k](sheet, {corner + vec2((each + gap) * static_cast<float>(k), rows_height * em),
                          {each, (charts_height - 0.8f) * em}});
}

}  // namespace sightlines
