// The bars: what is shown at the top, the steps of the ray and what is going on at the bottom.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "app/table.h"
#include "app/workbench/actions.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"
#include "techniques/scene/builtin_scenes.h"
#include "techniques/technique.h"

namespace sightlines {
namespace {

constexpr ImGuiWindowFlags bar_flags = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

void centre_row(const Area& area) { ImGui::SetCursorPosY(0.5f * (area.size.y - ImGui::GetFrameHeight())); }

std::string scene_title(const std::string& scene) {
    const auto builtin = std::ranges::find(builtin_scenes(), scene, &SceneModel::name);
    return builtin != builtin_scenes().end() ? scene : std::filesystem::path(scene).stem().string();
}

void draw_scene_menu(Frame& frame, float width) {
    if (!menu_button(frame, "scene", scene_title(frame.session.scene), width)) return;
    for (const SceneModel& model : builtin_scenes())
        if (menu_item(frame, model.name, model.about, frame.session.scene == model.name)) open_scene(frame, model.name);
    if (!frame.ui.recent.empty()) ImGui::Separator();
    const std::size_t most = std::min<std::size_t>(frame.ui.recent.size(), 6);
    for (std::size_t i = 0; i < most; ++i) {
        const std::string scene = frame.ui.recent[i];
        if (menu_item(frame, std::filesystem::path(scene).filename().string(), scene, frame.session.scene == scene))
            open_scene(frame, scene);
    }
    ImGui::Separator();
    for (const ActionId id : {ActionId::open_scene, ActionId::open_session, ActionId::save_session}) {
        const Action& action = find_action(id);
        if (menu_item(frame, std::string(action.title), "", false, keys_text(action))) action.run(frame);
    }
    ImGui::EndPopup();
}

void draw_technique_menu(Frame& frame, float width) {
    const Technique& chosen = find_technique(frame.session.technique);
    if (!menu_button(frame, "technique", std::string(chosen.title), width)) return;
    for (const Technique& technique : techniques())
        if (menu_item(frame, std::string(technique.title),
                      std::string(technique.about) + " " + std::string(technique.paper), technique.name == chosen.name))
            frame.next.technique = technique.name;
    ImGui::EndPopup();
}

void draw_backend_menu(Frame& frame, float width) {
    struct Row {
        BackendChoice choice;
        const char *title, *about;
    };
    constexpr std::array<Row, 3> rows{
        {{BackendChoice::automatic, "Automatic", "Vulkan on a real GPU, the CPU where there is none"},
         {BackendChoice::cpu, "CPU", "Wide vectors on all cores"},
         {BackendChoice::vulkan, "Vulkan", "A GPU, or lavapipe in software"}}};
    if (!menu_button(frame, "backend", rows[static_cast<std::size_t>(frame.session.backend)].title, width)) return;
    for (const Row& row : rows)
        if (menu_item(frame, row.title, row.about, frame.session.backend == row.choice))
            frame.next.backend = row.choice;
    ImGui::EndPopup();
}

void run_button(Frame& frame, ActionId id, Icon icon, bool enabled) {
    const Action& action = find_action(id);
    if (icon_button(frame, std::string(action.title).c_str(), icon, enabled)) action.run(frame);
    tooltip(frame, std::string(action.title), keys_text(action));
    ImGui::SameLine();
}

}  // namespace

void draw_top_bar(Frame& frame, const Area& area) {
    begin_area(frame, "top bar", area, frame.colours.header, {12.0f, 0.0f}, Layer::behind, bar_flags);
    centre_row(area);
    const float button = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x;
    const float buttons = 4.0f * button;
    const float room = area.size.x - buttons - 40.0f * frame.scale;
    const float menu = std::min(168.0f * frame.scale, room / 3.0f - ImGui::GetStyle().ItemSpacing.x);
    draw_scene_menu(frame, menu);
    tooltip(frame, "The scene. A .gltf or .glb file can be dropped on the window.");
    ImGui::SameLine();
    draw_technique_menu(frame, menu);
    tooltip(frame, "The technique");
    ImGui::SameLine();
    draw_backend_menu(frame, std::min(menu, 120.0f * frame.scale));
    tooltip(frame, "Where the technique runs");
    ImGui::SameLine(0.0f, 16.0f * frame.scale);
    draw_time(frame, area.size.x - buttons - 20.0f * frame.scale - ImGui::GetCursorPosX());
    ImGui::SameLine();
    ImGui::SetCursorPosX(area.size.x - buttons - 4.0f * frame.scale);
    run_button(frame, ActionId::undo, Icon::undo, frame.can_undo);
    run_button(frame, ActionId::redo, Icon::redo, frame.can_redo);
    run_button(frame, ActionId::keys, Icon::help, true);
    ImGui::End();
}

namespace {

/// The line of steps: one mark each, a handle that is dragged.
void draw_timeline(Frame& frame, float width) {
    const auto steps = recorded_steps(frame);
    const float height = ImGui::GetFrameHeight();
    const vec2 corner = from_imgui(ImGui::GetCursorScreenPos());
    ImGui::InvisibleButton("timeline", {std::max(width, 1.0f), height});
    const float radius = 6.0f * frame.scale, inset = radius + 2.0f;
    const auto count = static_cast<float>(std::max<std::size_t>(steps.size(), 2) - 1);
    const float middle = corner.y + 0.5f * height;
    const auto x_of = [&](std::size_t step) {
        return corner.x + inset + (width - 2.0f * inset) * static_cast<float>(step) / count;
    };
    if (ImGui::IsItemActive() && !steps.empty()) {
        const float at = (ImGui::GetMousePos().x - corner.x - inset) / (width - 2.0f * inset) * count;
        go_to_step(frame, std::lround(at));
        frame.in_gesture = true;
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({corner.x + inset, middle}, {corner.x + width - inset, middle}, frame.colours.hairline,
                 2.0f * frame.scale);
    if (steps.empty()) return;
    const std::size_t now = current_step(frame);
    list.AddLine({x_of(0), middle}, {x_of(now), middle}, frame.colours.accent, 2.0f * frame.scale);
    for (std::size_t i = 0; i < steps.size(); ++i)
        list.AddCircleFilled({x_of(i), middle}, 3.0f * frame.scale,
                             i <= now ? frame.colours.accent : frame.colours.muted);
    list.AddCircleFilled({x_of(now), middle}, radius, frame.colours.accent);
    if (!ImGui::IsItemHovered()) return;
    const auto nearest = static_cast<std::size_t>(
        std::clamp(std::lround((ImGui::GetMousePos().x - corner.x - inset) / (width - 2.0f * inset) * count), 0L,
                   static_cast<long>(steps.size()) - 1));
    tooltip(frame,
            "Step " + std::to_string(nearest + 1) + ", " + steps[nearest].paper + ": " + steps[nearest].sentence);
}

}  // namespace

void draw_step_bar(Frame& frame, const Area& area) {
    begin_area(frame, "step bar", area, frame.colours.header, {12.0f, 0.0f}, Layer::behind, bar_flags);
    centre_row(area);
    const auto steps = recorded_steps(frame);
    const std::size_t now = current_step(frame);
    const bool before = !steps.empty() && now > 0, after = now + 1 < steps.size();
    run_button(frame, ActionId::first_step, Icon::to_start, before);
    run_button(frame, ActionId::step_back, Icon::back, before);
    const std::string number =
        steps.empty() ? "no ray" : "step " + std::to_string(now + 1) + " of " + std::to_string(steps.size());
    ImGui::AlignTextToFramePadding();
    text_in(frame.fonts.text, steps.empty() ? frame.colours.faint : frame.colours.ink, number);
    ImGui::SameLine();
    run_button(frame, ActionId::step_forward, Icon::forward, after);
    run_button(frame, ActionId::last_step, Icon::to_end, after);
    const float left = ImGui::GetCursorPosX();
    const float timeline = std::clamp(0.28f * area.size.x, 96.0f * frame.scale, 480.0f * frame.scale);
    draw_timeline(frame, timeline);
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + timeline + 12.0f * frame.scale);
    ImGui::AlignTextToFramePadding();
    const float room = area.size.x - ImGui::GetCursorPosX() - 12.0f * frame.scale;
    if (steps.empty()) {
        const std::string why = frame.shown.ray_failure
                                    ? ray_failure_text(frame)
                                    : "Click a point of the image to follow a ray through the kernel.";
        elided_text(frame.fonts.text, frame.colours.muted, why, room);
    } else {
        elided_text(frame.fonts.text, ray_is_current(frame) ? frame.colours.ink : frame.colours.faint,
                    steps[now].paper + ": " + steps[now].sentence, room);
    }
    ImGui::End();
}

namespace {

/// What is being made, how far it is, how long it will take, and a way to stop it.
void draw_work(Frame& frame, const Work& work) {
    const float height = ImGui::GetWindowHeight(), unit = frame.scale;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = 96.0f * unit, bar = 4.0f * unit, top = ImGui::GetWindowPos().y + 0.5f * (height - bar);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({corner.x, top}, {corner.x + width, top + bar}, frame.colours.hairline, 0.5f * bar);
    const auto done = static_cast<float>(std::clamp(work.fraction, 0.0, 1.0));
    list.AddRectFilled({corner.x, top}, {corner.x + std::max(width * done, bar), top + bar}, frame.colours.accent,
                       0.5f * bar);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + width + 8.0f * unit);
    std::string text = work.title.empty() ? "starting" : work.title;
    if (work.left_s) text += ", " + seconds_text(*work.left_s) + " left";
    text_in(frame.fonts.small, frame.colours.muted, text);
    ImGui::SameLine();
    const ImVec2 button = ImGui::GetCursorScreenPos();
    const float side = frame.fonts.small->FontSize + 4.0f * unit;
    if (ImGui::InvisibleButton("stop", {side, side})) cancel(frame.background);
    draw_icon(list, Icon::stop, {button.x + 0.5f * side, ImGui::GetWindowPos().y + 0.5f * height}, 9.0f * unit,
              ImGui::IsItemHovered() ? frame.colours.wrong : frame.colours.muted);
    tooltip(frame, "Stop", "Esc");
}

/// The action's first key.
std::string key_text(ActionId id) {
    const std::string all = keys_text(find_action(id));
    return all.substr(0, all.find(" or "));
}

/// What the keyboard does for whoever looks at a ray.
std::string key_hint(const Frame& frame) {
    const std::string keys = key_text(ActionId::keys) + " lists the keys";
    if (recorded_steps(frame).empty()) return keys;
    return key_text(ActionId::step_back) + " and " + key_text(ActionId::step_forward) + " step along the ray, " + keys;
}

/// Build time, frame time, rays a second, error: as far as they are known.
std::string measured_text(const Measured& measured) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "   ·   ") + part; };
    if (measured.build_s) add("built in " + seconds_text(*measured.build_s));
    if (measured.structure_bytes > 0) add(bytes_text(measured.structure_bytes));
    if (measured.render_s) add(seconds_text(*measured.render_s) + " a frame");
    if (measured.rays_per_second) add(rate_text(*measured.rays_per_second));
    if (measured.visibility_percent) add("visibility error " + percent_text(*measured.visibility_percent));
    if (measured.shadow_percent) add("shadow error " + percent_text(*measured.shadow_percent));
    return text;
}

}  // namespace

void draw_status_bar(Frame& frame, const Area& area) {
    begin_area(frame, "status bar", area, frame.colours.header, {12.0f, 0.0f}, Layer::behind, bar_flags);
    ImGui::SetCursorPosY(0.5f * (area.size.y - frame.fonts.small->FontSize));
    float left_end = ImGui::GetCursorPosX();
    if (!frame.shown.work.empty()) {
        draw_work(frame, frame.shown.work.front());
    } else if (frame.shown.cancelled) {
        text_in(frame.fonts.small, frame.colours.muted, "Stopped.");
        ImGui::SameLine();
        if (ImGui::SmallButton("Go on")) resume(frame.background);
    } else {
        text_in(frame.fonts.small, frame.colours.muted, "Ready");
        ImGui::SameLine(0.0f, 16.0f * frame.scale);
        text_in(frame.fonts.small, frame.colours.faint, key_hint(frame));
    }
    ImGui::SameLine();
    left_end = ImGui::GetCursorPosX();
    const float room = area.size.x - left_end - 24.0f * frame.scale;
    const std::string text = elided(frame.fonts.small, measured_text(frame.shown.measured), std::max(room, 0.0f));
    ImGui::SetCursorPosY(0.5f * (area.size.y - frame.fonts.small->FontSize));
    text_right(frame.fonts.small, frame.colours.ink, text, area.size.x - 12.0f * frame.scale);
    tooltip(frame, measured_text(frame.shown.measured) + "\nRendered by " + frame.shown.measured.device +
                       "\nWindow drawn by " + std::string(device_name(frame.window)));
    ImGui::End();
}

}  // namespace sightlines
