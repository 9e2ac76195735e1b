// The values of the current step. The mouse on one lights what it is in the view inside.
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "app/table.h"
#include "app/trace_text.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"
#include "visualizers/theme.h"

namespace sightlines {
namespace {

/// What a value is in space: the geometry of its name, else all of its step's, else the ray.
std::vector<TraceGeometry> geometry_of(const Frame& frame, const TraceStep& step, const std::string& name) {
    for (const TraceGeometry& geometry : step.geometry)
        if (geometry.name == name) return {geometry};
    if (!step.geometry.empty()) return step.geometry;
    const Segment& ray = frame.shown.ray->trace.ray;
    return {{"ray", TraceShape::segment, {ray.origin, ray.target}}};
}

std::string geometry_text(const TraceGeometry& geometry) {
    const auto length = [](vec3 v) { return fixed_text(static_cast<double>(glm::length(v)), 2); };
    switch (geometry.shape) {
        case TraceShape::point:
            return value_text({"", geometry.points[0], "m"});
        case TraceShape::segment:
            return length(geometry.points[1] - geometry.points[0]) + " m long";
        case TraceShape::box:
            break;
    }
    return length(geometry.points[1]) + " x " + length(geometry.points[2]) + " x " + length(geometry.points[3]) + " m";
}

/// "0010 1100" as cells, 32 to a line, the first bit's number at the left: set ones filled, clear ones framed.
void draw_bits(const Frame& frame, const std::string& bits) {
    constexpr int cells_a_line = 32;
    const float label = width_of(frame.fonts.small, "000") + 6.0f * frame.scale;
    const float room = ImGui::GetContentRegionAvail().x - label;
    const float pitch = std::clamp(std::floor(room / (cells_a_line + 0.5f * 7.0f)), 3.0f, 10.0f * frame.scale);
    const float space = std::floor(0.5f * pitch);
    const Palette view = palette(frame.session.workbench.theme);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float line_height = std::max(pitch + 3.0f * frame.scale, frame.fonts.small->FontSize);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    int index = 0;
    for (const char bit : bits) {
        if (bit != '0' && bit != '1') continue;
        const int column = index % cells_a_line, line = index / cells_a_line;
        const float x = corner.x + label + static_cast<float>(column) * pitch + static_cast<float>(column / 4) * space;
        const float y = corner.y + static_cast<float>(line) * line_height + 0.5f * (line_height - pitch);
        if (column == 0) {
            const std::string number = std::to_string(index);
            list.AddText(frame.fonts.small, frame.fonts.small->FontSize,
                         {corner.x + label - 6.0f * frame.scale - width_of(frame.fonts.small, number),
                          corner.y + static_cast<float>(line) * line_height +
                              0.5f * (line_height - frame.fonts.small->FontSize)},
                         frame.colours.muted, number.c_str());
        }
        const ImVec2 low(x, y), high(x + pitch - 1.0f, y + pitch - 1.0f);
        if (bit == '1')
            list.AddRectFilled(low, high, packed(view.set_bit));
        else
            list.AddRect(low, high, frame.colours.hairline);
        ++index;
    }
    const int lines = (index + cells_a_line - 1) / cells_a_line;
    ImGui::Dummy({room + label, static_cast<float>(lines) * line_height});
}

/// Name at the left, value at the right, over the full width; true while the mouse is on it.
bool draw_value(const Frame& frame, const std::string& name, const std::string& value) {
    const float width = ImGui::GetContentRegionAvail().x, padding = 4.0f * frame.scale;
    const float height = frame.fonts.mono->FontSize + 2.0f * padding;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(name.c_str(), {std::max(width, 1.0f), height});
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (hovered)
        list.AddRectFilled({corner.x - padding, corner.y}, {corner.x + width + padding, corner.y + height},
                           frame.colours.accent_wash, ImGui::GetStyle().FrameRounding);
    ImFont* font = frame.fonts.mono;
    const float value_width = width_of(font, value);
    const std::string shown = elided(font, name, std::max(width - value_width - 2.0f * padding, 0.3f * width));
    list.AddText(font, font->FontSize, {corner.x, corner.y + padding}, frame.colours.muted, shown.c_str());
    list.AddText(font, font->FontSize, {corner.x + width - value_width, corner.y + padding}, frame.colours.ink,
                 value.c_str());
    return hovered;
}

void point_at(Frame& frame, const TraceStep& step, const std::string& name) {
    frame.ui.pointed = geometry_of(frame, step, name);
}

void draw_step_values(Frame& frame, const TraceStep& step) {
    int id = 0;
    for (const TraceValue& value : step.values) {
        ImGui::PushID(id++);
        if (const auto* const bits = std::get_if<std::string>(&value.value)) {
            text_in(frame.fonts.mono, frame.colours.muted, value.name);
            ImGui::BeginGroup();
            draw_bits(frame, *bits);
            ImGui::EndGroup();
            if (ImGui::IsItemHovered()) point_at(frame, step, value.name);
        } else if (draw_value(frame, value.name, value_text(value))) {
            point_at(frame, step, value.name);
        }
        ImGui::PopID();
    }
    for (const TraceGeometry& geometry : step.geometry) {
        ImGui::PushID(id++);
        if (draw_value(frame, geometry.name, geometry_text(geometry))) point_at(frame, step, geometry.name);
        ImGui::PopID();
    }
}

void draw_verdict(const Frame& frame, const SelectedRay& ray) {
    const bool wrong = ray.trace.blocked != ray.truly_blocked;
    const auto word = [](bool blocked) { return blocked ? "blocked" : "open"; };
    const std::string text = std::string("The technique says ") + word(ray.trace.blocked) + ", Embree says " +
                             word(ray.truly_blocked) + ": " +
                             (!wrong              ? "they agree."
                              : ray.trace.blocked ? "a false shadow."
                                                  : "light leaks through.");
    wrapped_text(frame.fonts.small, wrong ? frame.colours.wrong : frame.colours.muted, text);
}

}  // namespace

void draw_values(Frame& frame) {
    const auto steps = recorded_steps(frame);
    if (steps.empty())
        return empty_pane_text(frame, "The values of a step appear here",
                               "Once a ray is selected: what the kernel computed at the current line.");
    const TraceStep& step = steps[current_step(frame)];
    text_in(frame.fonts.text_bold, frame.colours.ink, step.paper);
    wrapped_text(frame.fonts.text, frame.colours.ink, step.sentence);
    ImGui::Dummy({0.0f, 2.0f * frame.scale});
    draw_step_values(frame, step);
    if (current_step(frame) + 1 != steps.size()) return;
    ImGui::Dummy({0.0f, 4.0f * frame.scale});
    draw_verdict(frame, *frame.shown.ray);
}

}  // namespace sightlines
