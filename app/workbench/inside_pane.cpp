// The view inside: VTK's picture from its own thread, turned by the mouse; a click selects the step that touched it.
#include <cmath>

#include "app/inside.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"

namespace sightlines {
namespace {

/// All geometry that the steps of the ray recorded.
std::vector<TraceGeometry> recorded_geometry(std::span<const TraceStep> steps) {
    std::vector<TraceGeometry> all;
    for (const TraceStep& step : steps) all.insert(all.end(), step.geometry.begin(), step.geometry.end());
    return all;
}

/// Goes to the first step that recorded a geometry of that name.
void go_to_geometry(Frame& frame, const std::string& name) {
    const auto steps = recorded_steps(frame);
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (std::ranges::find(steps[i].geometry, name, &TraceGeometry::name) != steps[i].geometry.end())
            return go_to_step(frame, static_cast<std::int64_t>(i));
}

void pick_at(Frame& frame, const InsideShown& held, vec2 pixel) {
    const auto geometry = recorded_geometry(recorded_steps(frame));
    const InsideRequest& drawn = held.request;
    const PickedInside picked = pick(*drawn.picture, drawn.state, geometry, drawn.size, pixel, drawn.text_scale);
    frame.next.selection.voxel = picked.voxel;
    if (!picked.geometry.empty()) go_to_geometry(frame, picked.geometry);
}

void handle_mouse(Frame& frame, const Area& body, const InsideShown& held) {
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetCursorScreenPos(to_imgui(body.corner));
    ImGui::InvisibleButton(
        "view", to_imgui(body.size),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    const vec2 mouse = from_imgui(io.MousePos), delta = from_imgui(io.MouseDelta);
    if (ImGui::IsItemActivated()) frame.ui.press = mouse;
    const float slack = click_slack * frame.scale;
    ViewState state = inside_state(frame.next);
    // The camera as drawn last; while the mouse drags, as asked for last.
    const OrbitCamera camera = state.camera.value_or(held.camera);
    if (ImGui::IsItemActive()) {
        frame.in_gesture = true;
        if (delta != vec2(0.0f) && glm::distance(mouse, frame.ui.press) > slack) {
            const bool pan = io.KeyShift || !ImGui::IsMouseDown(ImGuiMouseButton_Left);
            state = pan ? panned(state, camera, delta, static_cast<int>(body.size.y))
                        : turned(state, camera, delta / body.size.y * 180.0f);
        }
    }
    if (ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
        glm::distance(mouse, frame.ui.press) <= slack)
        pick_at(frame, held, mouse - body.corner);
    if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f) {
        state = zoomed(state, camera, std::pow(wheel_step, io.MouseWheel));
        frame.in_gesture = true;
    }
    set_inside_state(frame.next, state);
}

/// Which view of the technique is shown, where it has several.
void draw_figure_choice(Frame& frame) {
    const std::string_view now = shown_figure(frame.next);
    for (const FigureRow& figure : figures())
        if (can_show(figure, frame.next) && ImGui::RadioButton(std::string(figure.title).c_str(), figure.name == now))
            show_figure(frame.next, figure.name);
    ImGui::Separator();
}

void toggle_cut(Frame& frame, ViewState& state, const char* text) {
    bool cut = state.cut_away == CutAway::to_row;
    if (toggle(frame, text, cut)) state.cut_away = cut ? CutAway::to_row : CutAway::none;
}

void draw_ray_options(Frame& frame, ViewState& state) {
    toggle(frame, "Scene, ghosted", state.scene);
    toggle(frame, "Cells", state.voxels);
    toggle(frame, "Cells that the ray touched", state.row);
    toggle(frame, "Ray", state.ray);
    toggle(frame, "Labels", state.labels);
    toggle_cut(frame, state, "Cells behind the ray only");
}

/// Steps through the merging of the cell's point samples.
void draw_merging_options(Frame& frame, ViewState& state) {
    const auto* const ray = frame.shown.inside ? std::get_if<RayPicture>(frame.shown.inside.get()) : nullptr;
    if (ray == nullptr || !ray->samples || ray->samples->empty()) return;
    const int all = static_cast<int>(ray->samples->size());
    int merged = std::min(state.merged_samples, all);
    ImGui::SetNextItemWidth(200.0f * frame.scale);
    if (ImGui::SliderInt("##merged", &merged, 1, all, "sample %d", ImGuiSliderFlags_AlwaysClamp))
        state.merged_samples = merged;
    tooltip(frame, "How many of the cell's point samples are merged");
    ImGui::SameLine();
    if (ImGui::ArrowButton("##before", ImGuiDir_Left)) state.merged_samples = std::max(merged - 1, 1);
    ImGui::SameLine();
    if (ImGui::ArrowButton("##next", ImGuiDir_Right)) state.merged_samples = std::min(merged + 1, all);
}

void draw_row_options(Frame& frame, ViewState& state) {
    toggle(frame, "Scene, ghosted", state.scene);
    toggle(frame, "Voxels", state.voxels);
    toggle(frame, "Row", state.row);
    toggle(frame, "Extent [s, e]", state.extent);
    toggle(frame, "Ray", state.ray);
    toggle(frame, "Its discretised twin", state.twin);
    toggle(frame, "Labels and legend", state.labels);
    toggle_cut(frame, state, "Cut open along the row");
    const float width = 200.0f * frame.scale;
    ImGui::SetNextItemWidth(width);
    ImGui::SliderInt("##slab", &state.slab_voxels, 1, 128, "%d layers behind the row", ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive()) frame.in_gesture = true;
    int resolution = 128;
    if (const auto* rows = frame.shown.inside ? rows_in_space(*frame.shown.inside) : nullptr)
        resolution = rows->resolution;
    int first = state.slice_first, last = std::min(state.slice_last, resolution - 1);
    ImGui::SetNextItemWidth(width);
    if (ImGui::DragIntRange2("##slice", &first, &last, 0.5f, 0, resolution - 1, "from voxel %d", "to %d",
                             ImGuiSliderFlags_AlwaysClamp)) {
        state.slice_first = first;
        state.slice_last = last;
    }
    tooltip(frame, "Slice along the row: only these voxels are drawn");
}

void draw_options(Frame& frame) {
    const bool has_choice =
        std::ranges::count_if(figures(), [&](const FigureRow& figure) { return can_show(figure, frame.next); }) > 1;
    if (has_choice) draw_figure_choice(frame);
    ViewState state = inside_state(frame.next);
    if (find_figure(shown_figure(frame.next)).technique == "voxel_rows") {
        draw_row_options(frame, state);
    } else {
        draw_ray_options(frame, state);
        draw_merging_options(frame, state);
    }
    if (ImGui::IsAnyItemActive()) frame.in_gesture = true;
    set_inside_state(frame.next, state);
}

}  // namespace

void draw_inside(Frame& frame, const Area& body) {
    if (!frame.inside_failure.empty())
        return empty_pane_text(frame, "The view inside cannot be drawn", frame.inside_failure);
    if (!frame.inside) {
        if (frame.shown.ray_failure) return empty_pane_text(frame, "No ray is selected", ray_failure_text(frame));
        return empty_pane_text(frame, "The inside of the technique appears here",
                               "As soon as its structure is built: the data that serves the selected ray, in space.");
    }
    if (frame.textures.inside_held != frame.inside) {
        upload(frame.window, frame.textures.inside, frame.inside->pixels);
        frame.textures.inside_held = frame.inside;
    }
    const ImageSize drawn = frame.inside->request.size;
    const bool exact = vec2(drawn.width, drawn.height) == body.size;
    draw_texture(frame.window, *ImGui::GetWindowDrawList(), frame.textures.inside, to_imgui(body.corner),
                 to_imgui(body.size), {0.0f, 0.0f}, {1.0f, 1.0f}, exact ? Sampling::nearest : Sampling::linear);
    handle_mouse(frame, body, *frame.inside);
}

void draw_inside_controls(Frame& frame, float right) {
    if (right - ImGui::GetCursorPosX() < 128.0f * frame.scale) return;
    if (menu_button(frame, "show", "Show")) {
        draw_options(frame);
        ImGui::EndPopup();
    }
    tooltip(frame, "What the view shows");
    ImGui::SameLine();
    if (icon_button(frame, "reframe", Icon::frame)) set_inside_state(frame.next, reframed(inside_state(frame.next)));
    tooltip(frame, "Turn the view back to the row", "F");
}

}  // namespace sightlines
