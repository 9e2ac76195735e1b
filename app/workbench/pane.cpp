// A pane's frame: header, menu of contents, maximise; and the splitters between panes.
#include <array>
#include <string>

#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"

namespace sightlines {
namespace {

constexpr float header_height = 32.0f;  // design pixels

struct ContentRow {
    PaneContent content;
    std::string_view title, about;
};
constexpr std::array<ContentRow, pane_count> contents{{
    {PaneContent::image, "Image", "The picture that the technique makes"},
    {PaneContent::inside, "Inside", "The data that serves the selected ray, in space"},
    {PaneContent::rays, "Rays", "Every light ray of the picked pixel"},
    {PaneContent::source, "Kernel", "The source that answered the ray, at the current step"},
    {PaneContent::values, "Step", "The values of the current step"},
    {PaneContent::parameters, "Parameters", "Technique, lights, picture and view"},
}};

const ContentRow& row_of(PaneContent content) { return contents[static_cast<std::size_t>(content)]; }

void content_menu(Frame& frame, PanePlace place, PaneContent content) {
    const FontScope font(frame.fonts.text_bold);
    if (!menu_button(frame, "content", std::string(row_of(content).title))) return;
    for (const ContentRow& row : contents)
        if (menu_item(frame, std::string(row.title), std::string(row.about), row.content == content))
            frame.next.workbench.layout = with_content(frame.next.workbench.layout, place, row.content);
    ImGui::EndPopup();
}

void draw_controls(Frame& frame, PaneContent content, float right) {
    switch (content) {
        case PaneContent::image:
            draw_image_controls(frame, right);
            break;
        case PaneContent::inside:
            draw_inside_controls(frame, right);
            break;
        case PaneContent::rays:
            draw_rays_controls(frame, right);
            break;
        case PaneContent::source:
            draw_source_controls(frame, right);
            break;
        case PaneContent::values:
        case PaneContent::parameters:
            break;
    }
}

void draw_header(Frame& frame, PanePlace place, PaneContent content, const Area& area) {
    std::optional<PanePlace>& maximised = frame.next.workbench.layout.maximised;
    begin_area(frame, ("header " + std::to_string(static_cast<int>(place))).c_str(), area, frame.colours.header,
               {8.0f, 2.0f}, Layer::behind, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::SetCursorPosY(0.5f * (area.size.y - ImGui::GetFrameHeight()));
    const bool over_header = ImGui::IsWindowHovered() && !ImGui::IsAnyItemHovered();
    content_menu(frame, place, content);
    ImGui::SameLine();
    const float button_left = area.size.x - ImGui::GetFrameHeight() - 4.0f * frame.scale;
    draw_controls(frame, content, button_left - 4.0f * frame.scale);
    ImGui::SameLine();
    ImGui::SetCursorPos({button_left, 0.5f * (area.size.y - ImGui::GetFrameHeight())});
    const bool pressed = icon_button(frame, "maximise", maximised ? Icon::restore : Icon::maximise);
    tooltip(frame, maximised ? "Show all panes again" : "Show only this pane", "M, or double click on the title bar");
    if (pressed || (over_header && !ImGui::IsAnyItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)))
        maximised = maximised ? std::nullopt : std::optional(place);
    ImGui::End();
}

/// The ground of a pane's body; none where its picture covers it: a software device pays for each pixel.
ImU32 ground_of(const Frame& frame, PaneContent content) {
    if (content == PaneContent::image)
        return frame.shown.picture && frame.session.workbench.fit_picture ? 0 : frame.colours.page;
    if (content == PaneContent::inside) return frame.inside ? 0 : frame.colours.page;
    return frame.colours.pane;
}

void draw_body(Frame& frame, PanePlace place, PaneContent content, const Area& body) {
    const bool picture = content == PaneContent::image || content == PaneContent::inside;
    const vec2 padding = picture || content == PaneContent::source ? vec2(0.0f) : vec2(12.0f, 8.0f);
    begin_area(frame, ("body " + std::to_string(static_cast<int>(place))).c_str(), body, ground_of(frame, content),
               padding, Layer::behind, picture ? ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse : 0);
    switch (content) {
        case PaneContent::image:
            draw_image(frame, body);
            break;
        case PaneContent::inside:
            draw_inside(frame, body);
            break;
        case PaneContent::rays:
            draw_rays(frame);
            break;
        case PaneContent::source:
            draw_source(frame, body);
            break;
        case PaneContent::values:
            draw_values(frame);
            break;
        case PaneContent::parameters:
            draw_parameters(frame);
            break;
    }
    ImGui::End();
}

}  // namespace

Area pane_body(const Area& pane, float scale) {
    const float height = std::round(header_height * scale);
    return {pane.corner + vec2(0.0f, height), glm::max(pane.size - vec2(0.0f, height), vec2(0.0f))};
}

void draw_pane(Frame& frame, PanePlace place, const Area& area) {
    const PaneContent content = frame.session.workbench.layout.panes[static_cast<std::size_t>(place)];
    const Area body = pane_body(area, frame.scale);
    draw_header(frame, place, content, {area.corner, {area.size.x, body.corner.y - area.corner.y}});
    if (body.size.x >= 1.0f && body.size.y >= 1.0f) draw_body(frame, place, content, body);
}

void draw_splitters(Frame& frame, const Arrangement& areas) {
    for (std::size_t i = 0; i < splitter_count; ++i) {
        const Area& area = areas.splitters[i];
        if (area.size.x <= 0.0f || area.size.y <= 0.0f) continue;
        const auto splitter = static_cast<Splitter>(i);
        const std::string name = "splitter " + std::to_string(i);
        begin_area(frame, name.c_str(), area, 0, {0.0f, 0.0f}, Layer::above, ImGuiWindowFlags_NoScrollbar);
        ImGui::InvisibleButton("grip", to_imgui(area.size));
        const bool held = ImGui::IsItemActive();
        if (held || ImGui::IsItemHovered()) {
            const bool level = splitter == Splitter::upper_height;
            ImGui::SetMouseCursor(level ? ImGuiMouseCursor_ResizeNS : ImGuiMouseCursor_ResizeEW);
            const vec2 middle = area.corner + 0.5f * area.size;
            const vec2 half = level ? vec2(0.5f * area.size.x, frame.scale) : vec2(frame.scale, 0.5f * area.size.y);
            ImGui::GetForegroundDrawList()->AddRectFilled(to_imgui(middle - half), to_imgui(middle + half),
                                                          frame.colours.accent);
        }
        if (held && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0.0f)) {
            frame.next.workbench.layout =
                dragged(frame.next.workbench.layout, splitter, from_imgui(ImGui::GetMousePos()),
                        framebuffer_size(frame.window), frame.scale);
            frame.in_gesture = true;
        }
        ImGui::End();
    }
}

}  // namespace sightlines
