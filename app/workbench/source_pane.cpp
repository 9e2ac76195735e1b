// The kernel's source: the very text that was compiled, with the line of the current step lit.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"
#include "shaders/kernel_source.h"

namespace sightlines {
namespace {

constexpr std::array<std::string_view, 12> keywords{"if",     "else",   "for",     "while",  "return", "const",
                                                    "struct", "define", "include", "ifndef", "endif",  "ifdef"};
constexpr std::array<std::string_view, 16> types{"Real",  "Int",      "UInt",      "Mask",   "Vec3", "float",
                                                 "int",   "uint",     "bool",      "vec3",   "void", "Rows",
                                                 "Frame", "RowShape", "Direction", "RowSpan"};

bool is_word(char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_'; }

/// The length of the token at the start of `rest`, and its colour.
struct Token {
    std::size_t length;
    ImU32 colour;
};

Token token_at(const Colours& colours, std::string_view rest) {
    const auto run = [&](auto in) {
        std::size_t length = 1;
        while (length < rest.size() && in(rest[length])) ++length;
        return length;
    };
    if (rest.starts_with("//")) return {rest.size(), colours.code_comment};
    if (rest[0] == '"') {
        const std::size_t end = rest.find('"', 1);
        return {end == std::string_view::npos ? rest.size() : end + 1, colours.code_number};
    }
    if (std::isdigit(static_cast<unsigned char>(rest[0])) != 0)
        return {run([](char letter) { return is_word(letter) || letter == '.'; }), colours.code_number};
    if (!is_word(rest[0]))
        return {run([](char letter) { return !is_word(letter) && letter != '"' && letter != '/'; }), colours.code_text};
    const std::size_t length = run(is_word);
    const std::string_view word = rest.substr(0, length);
    if (std::ranges::find(keywords, word) != keywords.end()) return {length, colours.code_keyword};
    if (std::ranges::find(types, word) != types.end()) return {length, colours.code_type};
    const bool capitals = length > 1 && std::ranges::all_of(word, [](char letter) {
                              return std::isupper(static_cast<unsigned char>(letter)) != 0 || letter == '_';
                          });
    return {length, capitals ? colours.code_macro : colours.code_text};
}

void draw_line(const Frame& frame, std::string_view line, vec2 at) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont* font = frame.fonts.mono;
    while (!line.empty()) {
        const Token token = token_at(frame.colours, line);
        const std::string_view text = line.substr(0, token.length);
        list.AddText(font, font->FontSize, to_imgui(at), token.colour, text.data(), text.data() + text.size());
        at.x += width_of(font, text);
        line.remove_prefix(token.length);
    }
}

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

/// Steps of the ray whose line is `line` of `file`, the first of them.
std::optional<std::size_t> step_at(std::span<const TraceStep> steps, std::string_view file, int line) {
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (steps[i].line == line && steps[i].file == file) return i;
    return std::nullopt;
}

/// The last line that belongs to the statement of the step: its NOTE and the SHOWs that follow.
int last_lit_line(std::span<const std::string_view> lines, int line) {
    int last = line;
    for (int next = line + 1; next <= static_cast<int>(lines.size()); ++next) {
        const std::string_view text = lines[static_cast<std::size_t>(next) - 1];
        const std::size_t start = text.find_first_not_of(' ');
        if (start == std::string_view::npos || !text.substr(start).starts_with("SHOW")) break;
        last = next;
    }
    return last;
}

struct SourceRow {
    int line = 0;
    bool lit = false, first_lit = false;
    std::optional<std::size_t> step;
};

/// One line of source: number, mark where a step recorded, text. A click on a marked line goes to its step.
void draw_source_row(Frame& frame, const SourceRow& row, std::string_view text, float gutter, float width) {
    const float height = ImGui::GetTextLineHeightWithSpacing();
    const vec2 corner = from_imgui(ImGui::GetCursorScreenPos());
    ImGui::PushID(row.line);
    if (ImGui::InvisibleButton("##line", {width, height}) && row.step)
        go_to_step(frame, static_cast<std::int64_t>(*row.step));
    ImGui::PopID();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (row.lit) list.AddRectFilled(to_imgui(corner), {corner.x + width, corner.y + height}, frame.colours.accent_wash);
    if (row.first_lit)
        list.AddRectFilled(to_imgui(corner), {corner.x + 3.0f * frame.scale, corner.y + height}, frame.colours.accent);
    const std::string number = std::to_string(row.line);
    ImFont* font = frame.fonts.mono;
    const float text_y = corner.y + 0.5f * (height - font->FontSize);
    list.AddText(font, font->FontSize, {corner.x + gutter - width_of(font, number), text_y},
                 row.lit ? frame.colours.ink : frame.colours.faint, number.c_str());
    if (row.step) {
        const vec2 dot(corner.x + gutter + 9.0f * frame.scale, corner.y + 0.5f * height);
        list.AddCircleFilled(to_imgui(dot), 3.0f * frame.scale,
                             row.first_lit ? frame.colours.accent : frame.colours.muted);
        if (ImGui::IsItemHovered()) {
            ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
            tooltip(frame, "Step " + std::to_string(*row.step + 1) + ": " + recorded_steps(frame)[*row.step].sentence);
        }
    }
    draw_line(frame, text, {corner.x + gutter + 20.0f * frame.scale, text_y});
}

}  // namespace

void draw_source(Frame& frame, const Area& body) {
    const auto steps = recorded_steps(frame);
    if (steps.empty()) {
        ImGui::Dummy({0.0f, 8.0f * frame.scale});
        return empty_pane_text(frame, "The kernel's source appears here",
                               "Once a ray is selected: the code that answered it, with the current line lit.");
    }
    const TraceStep& step = steps[current_step(frame)];
    const auto lines = lines_of(kernel_source(step.file));
    const int last_lit = last_lit_line(lines, step.line);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0f, 0.0f));
    const float gutter = width_of(frame.fonts.mono, "0000") + 8.0f * frame.scale;
    ImGui::PushFont(frame.fonts.mono);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0f, 3.0f * frame.scale));
    const float height = ImGui::GetTextLineHeightWithSpacing();
    ImGui::PopStyleVar();
    std::size_t longest = 0;
    for (const std::string_view line : lines) longest = std::max(longest, line.size());
    const float text_width =
        gutter + 24.0f * frame.scale + static_cast<float>(longest) * width_of(frame.fonts.mono, "0");
    const float width = std::max(text_width, body.size.x);
    ImGui::BeginChild("lines", {0.0f, 0.0f}, false, ImGuiWindowFlags_HorizontalScrollbar);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0f, 3.0f * frame.scale));
    const auto line_number = static_cast<std::uint32_t>(step.line);
    if (frame.ui.scrolled_line != line_number || frame.ui.scrolled_file != step.file) {
        ImGui::SetScrollY(std::max(0.0f, (static_cast<float>(step.line) - 1.0f) * height - 0.4f * body.size.y));
        frame.ui.scrolled_line = line_number;
        frame.ui.scrolled_file = step.file;
    }
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(lines.size()), height);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const int line = i + 1;
            const bool lit = line >= step.line && line <= last_lit;
            ImGui::SetCursorPosY(static_cast<float>(i) * height);
            draw_source_row(frame, {line, lit, line == step.line, step_at(steps, step.file, line)},
                            lines[static_cast<std::size_t>(i)], gutter, width);
        }
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::PopFont();
    ImGui::PopStyleVar();
}

void draw_source_controls(Frame& frame, float right) {
    const auto steps = recorded_steps(frame);
    if (steps.empty()) return;
    const TraceStep& step = steps[current_step(frame)];
    ImGui::AlignTextToFramePadding();
    elided_text(frame.fonts.mono, frame.colours.muted, step.file + ":" + std::to_string(step.line),
                right - ImGui::GetCursorPosX());
}

}  // namespace sightlines
