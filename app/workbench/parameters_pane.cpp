// The panel: the technique's parameters out of its own table, the lights, the camera, the picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "app/table.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"
#include "techniques/technique.h"

namespace sightlines {
namespace {

constexpr float number_width = 76.0f;  ///< of the box beside a slider: eight digits

/// A heading over a group of controls.
void heading(const Frame& frame, const std::string& text) {
    if (ImGui::GetCursorPosY() > 16.0f * frame.scale) ImGui::Dummy({0.0f, 8.0f * frame.scale});
    text_in(frame.fonts.text_bold, frame.colours.ink, text);
}

/// The label's line over a control: the name, and at the right `aside`, or less of it (its first two words), or
/// nothing, so that the name stays whole.
void label_line(const Frame& frame, const std::string& name, const std::string& aside, const std::string& help,
                bool changed) {
    const float room = ImGui::GetContentRegionAvail().x, right = ImGui::GetCursorPosX() + room;
    const float left_over = room - width_of(frame.fonts.text, name) - 12.0f * frame.scale;
    const std::string shorter = aside.substr(0, aside.find(' ', aside.find(' ') + 1));
    const std::string fitting = width_of(frame.fonts.small, aside) <= left_over     ? aside
                                : width_of(frame.fonts.small, shorter) <= left_over ? shorter
                                                                                    : "";
    text_in(frame.fonts.text, changed ? frame.colours.accent : frame.colours.ink, elided(frame.fonts.text, name, room));
    if (!help.empty()) tooltip(frame, name + ". " + help);
    if (fitting.empty()) return;
    ImGui::SameLine();
    text_right(frame.fonts.small, frame.colours.muted, fitting, right);
}

/// True where the last item was double clicked: back to its default.
bool wants_default() { return ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left); }

void note_gesture(Frame& frame) {
    if (ImGui::IsItemActive()) frame.in_gesture = true;
}

std::string number_format(const Parameter& parameter) {
    return parameter.kind == ParameterKind::integer ? "%.0f" : "%.2f";
}

/// "paper 1.5 voxels", else "default 1.75 voxels" once it was changed.
std::string aside_of(const Parameter& parameter, double value) {
    const std::string unit = parameter.unit.empty() ? "" : " " + std::string(parameter.unit);
    if (value != parameter.default_value) return "default " + parameter_text(parameter, parameter.default_value) + unit;
    if (parameter.paper_value) return "paper " + parameter_text(parameter, *parameter.paper_value) + unit;
    return std::string(parameter.unit);
}

std::string help_of(const Parameter& parameter) {
    std::string help(parameter.help);
    const std::string unit = parameter.unit.empty() ? "" : " " + std::string(parameter.unit);
    help += "\nDefault " + parameter_text(parameter, parameter.default_value) + unit;
    if (parameter.paper_value) help += ", the paper " + parameter_text(parameter, *parameter.paper_value) + unit;
    return help + ". Double click for the default.";
}

/// Slider and number field, side by side.
double draw_number(Frame& frame, const Parameter& parameter, double value) {
    const float gap = 8.0f * frame.scale, field = number_width * frame.scale;
    const float width = ImGui::GetContentRegionAvail().x;
    auto shown = static_cast<float>(value);
    const auto low = static_cast<float>(parameter.lowest), high = static_cast<float>(parameter.highest);
    ImGui::SetNextItemWidth(std::max(width - field - gap, 48.0f * frame.scale));
    // From centimetres to a kilometre: equal steps would leave the small ones no room.
    const bool by_ratio = parameter.lowest > 0.0 && parameter.highest / parameter.lowest >= 10000.0;
    const ImGuiSliderFlags scale = by_ratio ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None;
    if (ImGui::SliderFloat("##slider", &shown, low, high, "", ImGuiSliderFlags_AlwaysClamp | scale))
        value = static_cast<double>(shown);
    note_gesture(frame);
    if (wants_default()) value = parameter.default_value;
    tooltip(frame, help_of(parameter));
    ImGui::SameLine(0.0f, gap);
    const FontScope mono(frame.fonts.mono);
    ImGui::SetNextItemWidth(field);
    double typed = value;
    const std::string format = number_format(parameter);
    if (ImGui::InputDouble("##number", &typed, 0.0, 0.0, format.c_str(),
                           ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
        value = typed;
    tooltip(frame, "Type a number, then Enter");
    if (!std::isfinite(value)) value = parameter.default_value;
    value = std::clamp(value, parameter.lowest, parameter.highest);
    // Sliders speak in hundredths: what is shown is what is meant.
    return parameter.kind == ParameterKind::integer ? std::round(value) : std::round(100.0 * value) / 100.0;
}

double draw_choice(Frame& frame, const Parameter& parameter, double value) {
    if (!menu_button(frame, "choice", parameter_text(parameter, value), ImGui::GetContentRegionAvail().x)) return value;
    for (std::size_t i = 0; i < parameter.choices.size(); ++i)
        if (menu_item(frame, std::string(parameter.choices[i]), "", value == static_cast<double>(i)))
            value = static_cast<double>(i);
    ImGui::EndPopup();
    return value;
}

void draw_parameter(Frame& frame, const Technique& technique, const Parameter& parameter) {
    const ParameterValues values = technique_parameters(frame.next);
    const double before = parameter_value(technique.parameters, values, parameter.name);
    double value = before;
    ImGui::PushID(parameter.name.data());
    const std::string name(parameter.title);
    const bool changed = before != parameter.default_value;
    if (parameter.kind == ParameterKind::boolean) {
        bool on = value != 0.0;
        if (toggle(frame, name.c_str(), on)) value = on ? 1.0 : 0.0;
        tooltip(frame, help_of(parameter));
    } else {
        label_line(frame, name, aside_of(parameter, before), help_of(parameter), changed);
        value = parameter.kind == ParameterKind::choice ? draw_choice(frame, parameter, value)
                                                        : draw_number(frame, parameter, value);
    }
    ImGui::PopID();
    if (value == before) return;
    ParameterValues& own = frame.next.parameters[frame.next.technique];
    if (value == parameter.default_value)
        own.erase(std::string(parameter.name));
    else
        own[std::string(parameter.name)] = value;
    if (own.empty()) frame.next.parameters.erase(frame.next.technique);
}

void draw_technique(Frame& frame) {
    const Technique& technique = find_technique(frame.session.technique);
    heading(frame, std::string(technique.title));
    for (const Parameter& parameter : technique.parameters) draw_parameter(frame, technique, parameter);
    if (!frame.next.parameters.contains(frame.next.technique)) return;
    if (ImGui::Button("All to their defaults")) frame.next.parameters.erase(frame.next.technique);
}

void draw_light_count(Frame& frame, LightChoice& lights) {
    label_line(frame, "Number", lights.count == 0 ? "0: the scene's own" : "",
               "Point lights, spread at random; 0 takes those that the scene brings.", false);
    const float gap = 8.0f * frame.scale, field = number_width * frame.scale;
    int count = static_cast<int>(lights.count);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - field - gap);
    // The slider goes by powers of two; any number can be typed.
    int power = lights.count == 0 ? -1 : static_cast<int>(std::lround(std::log2(lights.count)));
    if (ImGui::SliderInt("##power", &power, -1, 13, "", ImGuiSliderFlags_AlwaysClamp))
        count = power < 0 ? 0 : 1 << power;
    note_gesture(frame);
    if (wants_default()) count = 1024;
    ImGui::SameLine(0.0f, gap);
    const FontScope mono(frame.fonts.mono);
    ImGui::SetNextItemWidth(field);
    int typed = count;
    if (ImGui::InputInt("##count", &typed, 0, 0,
                        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
        count = typed;
    lights.count = static_cast<std::uint32_t>(std::clamp(count, 0, static_cast<int>(max_lights)));
}

void draw_lights_section(Frame& frame) {
    heading(frame, "Lights");
    LightChoice& lights = frame.next.lights;
    draw_light_count(frame, lights);
    if (lights.count > 0) {
        bool sphere = lights.placement == LightPlacement::sphere;
        if (toggle(frame, "On a sphere around the scene", sphere))
            lights.placement = sphere ? LightPlacement::sphere : LightPlacement::volume;
        toggle(frame, "Coloured", lights.coloured);
    }
    toggle(frame, "Marked in the image", frame.next.workbench.lights_shown);
    label_line(frame, "Brightness", lights.brightness == 1.0f ? "" : "default 1", "Multiplies all lights.",
               lights.brightness != 1.0f);
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::SliderFloat("##brightness", &lights.brightness, 0.05f, 20.0f, "%.2f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    note_gesture(frame);
    if (wants_default()) lights.brightness = 1.0f;
    if (!lights.moved.empty() && ImGui::Button("Moved lights back")) lights.moved.clear();
}

/// A slider of an angle with its name above.
void draw_angle(Frame& frame, const char* name, const char* help, float& angle_deg, float lowest, float highest,
                float default_deg) {
    ImGui::PushID(name);
    label_line(frame, name, angle_deg == default_deg ? "" : "default " + fixed_text(double{default_deg}, 0), help,
               angle_deg != default_deg);
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::SliderFloat("##angle", &angle_deg, lowest, highest, "%.0f deg", ImGuiSliderFlags_AlwaysClamp);
    note_gesture(frame);
    if (wants_default()) angle_deg = default_deg;
    ImGui::PopID();
}

void draw_environment_section(Frame& frame) {
    heading(frame, "Environment");
    const EnvironmentChoice defaults;
    EnvironmentChoice& choice = frame.next.environment;
    const std::string name =
        choice.file.empty() ? "made-up sky" : std::filesystem::path(choice.file).filename().string();
    if (menu_button(frame, "environment", name, ImGui::GetContentRegionAvail().x)) {
        if (menu_item(frame, "made-up sky", "A clear day, with a sun", choice.file.empty())) choice.file.clear();
        if (menu_item(frame, "open an .hdr picture", "Equirectangular, Radiance format", false))
            frame.ui.dialog = Dialog::open_environment;
        ImGui::EndPopup();
    }
    tooltip(frame, "What surrounds the scene and lights it. An .hdr picture can be dropped on the window.");
    if (choice.file.empty()) {
        draw_angle(frame, "Sun elevation", "Above the horizon.", choice.sun_elevation_deg, -20.0f, 90.0f,
                   defaults.sun_elevation_deg);
        draw_angle(frame, "Sun azimuth", "From -Z towards +X.", choice.sun_azimuth_deg, -180.0f, 180.0f,
                   defaults.sun_azimuth_deg);
    }
    draw_angle(frame, "Turn", "About the vertical.", choice.turn_deg, -180.0f, 180.0f, defaults.turn_deg);
    draw_angle(frame, "Turn per second", "With the session's time, which runs in the bar above.", choice.turn_deg_per_s,
               -90.0f, 90.0f, defaults.turn_deg_per_s);
}

void draw_camera_section(Frame& frame) {
    heading(frame, "Camera");
    if (!frame.shown.scene) return text_in(frame.fonts.small, frame.colours.muted, "once the scene is loaded");
    const auto& cameras = frame.shown.scene->value.cameras;
    const Camera now = shown_camera(frame);
    if (menu_button(frame, "camera", frame.next.free_camera ? "moved by hand" : now.name,
                    ImGui::GetContentRegionAvail().x)) {
        for (const Camera& camera : cameras)
            if (menu_item(frame, camera.name, "", !frame.next.free_camera && camera.name == now.name)) {
                frame.next.camera = camera.name == cameras.front().name ? "" : camera.name;
                frame.next.free_camera.reset();
            }
        ImGui::EndPopup();
    }
    tooltip(frame, "The scene's cameras. R goes back to the chosen one.");
}

/// Time, where the scene moves.
void draw_time(Frame& frame) {
    const double duration_s = frame.shown.duration_s;
    if (duration_s <= 0.0) return;
    label_line(frame, "Time", "of " + seconds_text(duration_s), "The moment at which the scene stands still.", false);
    auto time_s = static_cast<float>(frame.next.time_s);
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::SliderFloat("##time", &time_s, 0.0f, static_cast<float>(duration_s), "%.1f s",
                           ImGuiSliderFlags_AlwaysClamp))
        frame.next.time_s = static_cast<double>(time_s);
    note_gesture(frame);
    if (wants_default()) frame.next.time_s = 0.0;
}

void draw_picture_section(Frame& frame) {
    heading(frame, "Picture");
    const std::string size =
        std::to_string(frame.session.size.width) + " x " + std::to_string(frame.session.size.height);
    label_line(frame, "Size", size, "Pixels that are rendered.", false);
    Workbench& look = frame.next.workbench;
    toggle(frame, "As large as its pane", look.fit_picture);
    if (!look.fit_picture) {
        constexpr std::array<ImageSize, 4> sizes{{{480, 270}, {960, 540}, {1280, 720}, {1920, 1080}}};
        if (menu_button(frame, "size", size, ImGui::GetContentRegionAvail().x)) {
            for (const ImageSize& choice : sizes)
                if (menu_item(frame, std::to_string(choice.width) + " x " + std::to_string(choice.height), "",
                              choice == frame.session.size))
                    frame.next.size = choice;
            ImGui::EndPopup();
        }
    }
    toggle(frame, "Measure the error", frame.next.reference);
    tooltip(frame, "Also asks Embree for every ray and compares. Takes longer.", "C");
    toggle(frame, "Tone curve", frame.next.display.tone_curve);
    draw_time(frame);
}

}  // namespace

void draw_parameters(Frame& frame) {
    draw_technique(frame);
    if (lit_by_environment(frame.session))
        draw_environment_section(frame);
    else
        draw_lights_section(frame);
    draw_camera_section(frame);
    draw_picture_section(frame);
    ImGui::Dummy({0.0f, 8.0f * frame.scale});
}

}  // namespace sightlines
