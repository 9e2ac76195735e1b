// The picture: what the technique makes, the picked pixel, its light, and the camera under the mouse.
#include <array>
#include <cmath>

#include <GLFW/glfw3.h>

#include "app/report.h"
#include "app/results.h"
#include "app/table.h"
#include "app/workbench/camera_moves.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"
#include "visualizers/theme.h"

namespace sightlines {
namespace {

constexpr float handle_radius = 7.0f;  // of the light's handle
constexpr float fly_share = 0.12f;     // of the scene's diagonal, a second

constexpr std::array<ChannelRow, 9> channels{{
    {Channel::lit, "Lit", "Radiance by the technique"},
    {Channel::reference, "Ray traced", "Radiance by Embree: the same rays, answered exactly"},
    {Channel::shadow, "Shadow", "Share of a pixel's light rays that are blocked"},
    {Channel::lights_seen, "Lights seen", "How many lights each pixel sees"},
    {Channel::rays, "Rays asked", "How many lights stand in front of each surface"},
    {Channel::visibility_error, "Visibility error", "Share of a pixel's rays that are judged wrongly"},
    {Channel::shadow_error, "Shadow error", "Our shadow value less the true one"},
    {Channel::compression, "Compression", "Share of a pixel's rays whose answer compression changed"},
    {Channel::rays_traced, "Rays traced", "How many of each pixel's rays Embree had to answer"},
}};

/// The row as it reads where pixels ask samples of the environment instead of lights.
ChannelRow in_words_for(ChannelRow row, bool samples) {
    if (!samples) return row;
    if (row.channel == Channel::lights_seen)
        return {row.channel, "Samples open", "How many samples see the environment"};
    if (row.channel == Channel::rays) row.about = "How many samples are above each surface";
    return row;
}

/// Where the picture lies in the body, and how positions map.
struct Placed {
    Area area;
    ImageSize picture;  ///< the session's size: pixels that can be picked

    vec2 picture_from_window(vec2 position) const {
        return (position - area.corner) / area.size * vec2(picture.width, picture.height);
    }
    ivec2 pixel_at(vec2 position) const {
        return glm::clamp(ivec2(picture_from_window(position)), ivec2(0), ivec2(picture.width, picture.height) - 1);
    }
    vec2 window_from_picture(vec2 position) const {
        return area.corner + position / vec2(picture.width, picture.height) * area.size;
    }
};

Placed placed(const Area& body, ImageSize picture) {
    const vec2 size(picture.width, picture.height);
    const float zoom = std::min(body.size.x / size.x, body.size.y / size.y);
    const vec2 shown = glm::max(glm::round(size * zoom), vec2(1.0f));
    return {{glm::round(body.corner + 0.5f * (body.size - shown)), shown}, picture};
}

void draw_picture(Frame& frame, const Placed& where) {
    if (!frame.shown.picture) return;
    const PictureShown& picture = *frame.shown.picture;
    if (frame.textures.image_number != picture.number) {
        upload(frame.window, frame.textures.image, picture.pixels);
        frame.textures.image_number = picture.number;
    }
    const float zoom = where.area.size.x / static_cast<float>(picture.pixels.size.width);
    // Pixel for pixel there is nothing to filter, and much enlarged a pixel is to be seen.
    const bool exact = zoom == 1.0f || (zoom > 2.5f && picture.state == PictureState::complete);
    draw_texture(frame.window, *ImGui::GetWindowDrawList(), frame.textures.image, to_imgui(where.area.corner),
                 to_imgui(where.area.size), {0.0f, 0.0f}, {1.0f, 1.0f}, exact ? Sampling::nearest : Sampling::linear);
}

/// Text on a small plate that keeps it readable on any picture. `anchor` 0 to 1: which point of the plate is at `at`.
void draw_plate(const Frame& frame, vec2 at, vec2 anchor, const std::string& text) {
    const vec2 padding = vec2(8.0f, 4.0f) * frame.scale;
    const vec2 size = vec2(width_of(frame.fonts.small, text), frame.fonts.small->FontSize) + 2.0f * padding;
    const vec2 corner = glm::round(at - anchor * size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(to_imgui(corner), to_imgui(corner + size), IM_COL32(16, 18, 22, 200), 4.0f * frame.scale);
    list.AddText(frame.fonts.small, frame.fonts.small->FontSize, to_imgui(corner + padding),
                 IM_COL32(238, 241, 245, 255), text.c_str());
}

void ring(ImDrawList& list, vec2 at, float radius, float width, ImU32 colour) {
    list.AddCircle(to_imgui(at), radius, IM_COL32(0, 0, 0, 200), 0, width + 2.0f);
    list.AddCircle(to_imgui(at), radius, colour, 0, width);
}

/// The picked pixel, the selected light and the ray between them, as they appear in the picture.
void draw_selection(const Frame& frame, const Placed& where, const std::optional<vec2>& light) {
    if (!frame.shown.ray && !frame.session.selection.pixel) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ivec2 pixel = frame.session.selection.pixel ? *frame.session.selection.pixel : frame.shown.ray->pixel;
    const vec2 at = where.window_from_picture(vec2(pixel) + 0.5f);
    const float unit = frame.scale;
    if (light && !frame.shown.ray_failure && ray_is_current(frame)) {
        const Palette view_colours = palette(Theme::dark);
        list.AddLine(to_imgui(at), to_imgui(*light), IM_COL32(0, 0, 0, 160), 4.0f * unit);
        list.AddLine(to_imgui(at), to_imgui(*light), packed(view_colours.ray), 2.0f * unit);
        list.AddCircleFilled(to_imgui(*light), handle_radius * unit, IM_COL32(0, 0, 0, 200));
        list.AddCircleFilled(to_imgui(*light), (handle_radius - 2.0f) * unit, packed(view_colours.light));
    }
    ring(list, at, 6.0f * unit, 2.0f * unit, IM_COL32(255, 255, 255, 255));
}

void draw_lights(const Frame& frame, const Placed& where, const Camera& camera) {
    if (!frame.session.workbench.lights_shown || !frame.shown.lights) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const Light& light : frame.shown.lights->value) {
        if (light.kind == LightKind::directional) continue;
        const auto at = projected(camera, where.picture, light.position);
        if (!at) continue;
        const vec2 position = where.window_from_picture(*at);
        if (!where.area.contains(position)) continue;
        const float strongest = std::max({light.intensity.x, light.intensity.y, light.intensity.z, 1.0e-20f});
        list.AddCircleFilled(to_imgui(position), 2.5f * frame.scale, IM_COL32(0, 0, 0, 160));
        list.AddCircleFilled(to_imgui(position), 1.75f * frame.scale, packed(light.intensity / strongest));
    }
}

/// The colour bar of a channel that is not a picture.
void draw_legend(const Frame& frame, const Placed& where) {
    std::string low = "0", high;
    const std::size_t most = frame.shown.lights ? rays_per_pixel(frame.session, frame.shown.lights->value) : 0;
    switch (frame.session.channel) {
        case Channel::lit:
        case Channel::reference:
            return;
        case Channel::shadow:
            high = "all blocked";
            low = "none";
            break;
        case Channel::lights_seen:
        case Channel::rays:
            high = count_text(most) + (lit_by_environment(frame.session) ? " samples" : " lights");
            break;
        case Channel::rays_traced:
            high = count_text(most) + " rays";
            break;
        case Channel::visibility_error:
            high = percent_text(100.0 * static_cast<double>(visibility_error_shown)) + " or more";
            break;
        case Channel::compression:
            high = percent_text(100.0 * static_cast<double>(compression_shown)) + " or more";
            break;
        case Channel::shadow_error:
            low = "too light";
            high = "too dark";
            break;
    }
    const float unit = frame.scale;
    const vec2 size(120.0f * unit, 8.0f * unit);
    const vec2 corner = where.area.corner + vec2(16.0f * unit, where.area.size.y - 40.0f * unit);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(to_imgui(corner - 8.0f * unit), to_imgui(corner + vec2(size.x + 8.0f * unit, 32.0f * unit)),
                       IM_COL32(16, 18, 22, 200), 4.0f * unit);
    constexpr int bands = 24;
    for (int i = 0; i < bands; ++i) {
        const auto x = [&](int band) { return corner.x + size.x * static_cast<float>(band) / bands; };
        const ImU32 from = packed(viridis(static_cast<float>(i) / bands)),
                    to = packed(viridis(static_cast<float>(i + 1) / bands));
        list.AddRectFilledMultiColor({x(i), corner.y}, {x(i + 1), corner.y + size.y}, from, to, to, from);
    }
    ImFont* font = frame.fonts.small;
    const float text_y = corner.y + size.y + 3.0f * unit;
    list.AddText(font, font->FontSize, {corner.x, text_y}, IM_COL32(238, 241, 245, 255), low.c_str());
    list.AddText(font, font->FontSize, {corner.x + size.x - width_of(font, high), text_y}, IM_COL32(238, 241, 245, 255),
                 high.c_str());
}

std::string pixel_text(const Frame& frame, ivec2 pixel) {
    std::string text = std::to_string(pixel.x) + ", " + std::to_string(pixel.y);
    if (!frame.shown.result || frame.shown.result->value.shadow.size != frame.session.size) return text;
    const RenderResult& result = frame.shown.result->value;
    const std::uint32_t asked = result.rays_asked.at(pixel.x, pixel.y);
    if (asked == 0) return text + "   no ray asked";
    const auto blocked =
        static_cast<std::uint64_t>(std::lround(result.shadow.at(pixel.x, pixel.y) * static_cast<float>(asked)));
    return text + "   " + count_text(blocked) + " of " + count_text(asked) + " rays blocked";
}

void move_camera(Frame& frame, const Placed& where) {
    const ImGuiIO& io = ImGui::GetIO();
    const vec2 drag = from_imgui(io.MouseDelta);
    const vec2 drag_pixels = drag / where.area.size * vec2(where.picture.width, where.picture.height);
    const vec2 drag_deg = drag / where.area.size.y * 180.0f;
    Camera camera = shown_camera(frame);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
        camera = looked(camera, 0.5f * drag_deg);
    else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || io.KeyShift)
        camera = panned(camera, drag_pixels, where.picture);
    else
        camera = orbited(camera, drag_deg);
    frame.next.free_camera = camera;
    frame.in_gesture = true;
}

void move_light(Frame& frame, const Placed& where) {
    const std::uint32_t number = frame.shown.ray->light;
    const vec2 drag =
        from_imgui(ImGui::GetIO().MouseDelta) / where.area.size * vec2(where.picture.width, where.picture.height);
    std::vector<MovedLight>& all = frame.next.lights.moved;
    auto moved = std::ranges::find(all, number, &MovedLight::light);
    if (moved == all.end()) {
        if (all.size() >= max_moved_lights) return;
        moved = all.insert(all.end(), {number, frame.shown.lights->value[number].position});
    }
    moved->position = dragged(shown_camera(frame), where.picture, moved->position, drag);
    frame.next.selection.light = number;
    frame.next.selection.pixel = frame.shown.ray->pixel;
    frame.in_gesture = true;
}

/// W A S D Q E fly while the mouse is over the picture.
void fly(Frame& frame) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || io.KeyCtrl) return;
    const auto held = [&](int plus, int minus) {
        return static_cast<float>(key_held(frame.window, plus)) - static_cast<float>(key_held(frame.window, minus));
    };
    const vec3 way(held(GLFW_KEY_D, GLFW_KEY_A), held(GLFW_KEY_E, GLFW_KEY_Q), held(GLFW_KEY_W, GLFW_KEY_S));
    if (way == vec3(0.0f)) return;
    const float speed_m =
        fly_share * std::max(frame.shown.scene->value.bounds.diagonal(), 1.0e-3f) * (io.KeyShift ? 3.0f : 1.0f);
    frame.next.free_camera = flown(shown_camera(frame), way * speed_m * std::min(io.DeltaTime, 0.1f));
    frame.in_gesture = true;
}

/// Clicks, drags, wheel and keys over the picture.
void handle_mouse(Frame& frame, const Area& body, const Placed& where, const std::optional<vec2>& light) {
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetCursorScreenPos(to_imgui(body.corner));
    ImGui::InvisibleButton(
        "picture", to_imgui(body.size),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    const vec2 mouse = from_imgui(io.MousePos);
    const bool over_light =
        light && ray_is_current(frame) && glm::distance(mouse, *light) < (handle_radius + 3.0f) * frame.scale;
    if (ImGui::IsItemActivated()) {
        frame.ui.press = mouse;
        frame.ui.moving_light = over_light && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    }
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && over_light) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    const bool held = ImGui::IsItemActive();
    const float slack = click_slack * frame.scale;
    if (held && (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f) &&
        (frame.ui.moving_light || glm::distance(mouse, frame.ui.press) > slack)) {
        if (frame.ui.moving_light)
            move_light(frame, where);
        else
            move_camera(frame, where);
    }
    if (held) frame.in_gesture = true;
    if (ImGui::IsItemDeactivated()) {
        const bool click = glm::distance(mouse, frame.ui.press) <= slack &&
                           ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !frame.ui.moving_light;
        if (click && where.area.contains(mouse)) select_pixel(frame, where.pixel_at(mouse));
        frame.ui.moving_light = false;
    }
    if (!hovered && !held) return;
    if (io.MouseWheel != 0.0f) {
        frame.next.free_camera = dollied(shown_camera(frame), std::pow(wheel_step, io.MouseWheel));
        frame.in_gesture = true;
    }
    fly(frame);
    if (where.area.contains(mouse) && !held)
        draw_plate(frame, where.area.end() - 8.0f * frame.scale, {1.0f, 1.0f},
                   pixel_text(frame, where.pixel_at(mouse)));
}

std::string state_text(const PictureShown& picture) {
    switch (picture.state) {
        case PictureState::preview:
            return "preview: ray traced, a few lights";
        case PictureState::draft:
            return "draft";
        case PictureState::refining:
            return "refining";
        case PictureState::complete:
            break;
    }
    return {};
}

}  // namespace

std::span<const ChannelRow> channel_rows() { return channels; }

Camera shown_camera(const Frame& frame) { return session_camera(frame.next, frame.shown.scene->value); }

void draw_image(Frame& frame, const Area& body) {
    if (!frame.shown.picture || !frame.shown.scene) {
        if (frame.shown.picture_failure)
            empty_pane_text(frame, "There is no picture", frame.shown.picture_failure->message);
        else
            empty_pane_text(frame, "The picture appears here", "The scene is being loaded.");
        return;
    }
    const Placed where = placed(body, frame.session.size);
    draw_picture(frame, where);
    const Camera camera = shown_camera(frame);
    std::optional<vec2> light;
    if (!lit_by_environment(frame.session) && frame.shown.ray && frame.shown.lights &&
        frame.shown.ray->light < frame.shown.lights->value.size())
        if (const auto at =
                projected(camera, where.picture, frame.shown.lights->value[frame.shown.ray->light].position))
            light = where.window_from_picture(*at);
    draw_lights(frame, where, camera);
    draw_selection(frame, where, light);
    draw_legend(frame, where);
    const float edge = 8.0f * frame.scale;
    if (const std::string state = state_text(*frame.shown.picture); !state.empty())
        draw_plate(frame, where.area.corner + edge, {0.0f, 0.0f}, state);
    const bool over_picture = where.area.contains(from_imgui(ImGui::GetIO().MousePos));  // the pixel is told there
    if (!frame.session.selection.pixel && !over_picture)
        draw_plate(frame, where.area.corner + vec2(0.5f * where.area.size.x, where.area.size.y - edge), {0.5f, 1.0f},
                   lit_by_environment(frame.session) ? "Click a point to follow its samples"
                                                     : "Click a point to follow its light rays");
    handle_mouse(frame, body, where, light);
}

void draw_image_controls(Frame& frame, float right) {
    const auto* const chosen = std::ranges::find(channels, frame.session.channel, &ChannelRow::channel);
    const float room = right - ImGui::GetCursorPosX();
    const float menu_width = 136.0f * frame.scale;
    if (room < menu_width) return;
    const bool samples = lit_by_environment(frame.session);
    if (menu_button(frame, "channel", std::string(in_words_for(*chosen, samples).title), menu_width)) {
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const ChannelRow row = in_words_for(channels[i], samples);
            if (menu_item(frame, std::string(row.title), std::string(row.about), &channels[i] == chosen,
                          std::to_string(i + 1)))
                frame.next.channel = row.channel;
        }
        ImGui::EndPopup();
    }
    tooltip(frame, "What the picture shows", "1 to 9");
    ImGui::SameLine();
    const float slider_width = 112.0f * frame.scale;
    if (right - ImGui::GetCursorPosX() < slider_width) return;
    ImGui::SetNextItemWidth(slider_width);
    ImGui::DragFloat("##exposure", &frame.next.display.exposure_stops, 0.02f, -16.0f, 16.0f, "exposure %+.1f",
                     ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive()) frame.in_gesture = true;
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
        frame.next.display.exposure_stops = 0.0f;
    tooltip(frame, "Exposure in stops. Drag; double click for 0.", "[ and ]");
}

}  // namespace sightlines
