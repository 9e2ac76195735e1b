// The panes and bars of the window. Each draws itself once and writes what the user did into frame.next.
#pragma once

#include <string_view>

#include "app/workbench/frame.h"

namespace sightlines {

/// The whole pane: its header with the menu of contents, and the content below. Double click on the header maximises.
void draw_pane(Frame& frame, PanePlace place, const Area& area);
/// What is left below a pane's header, in the window's pixels.
Area pane_body(const Area& pane, float scale);

// The contents. Each is drawn inside an ImGui window that covers `body`; the controls stand in the pane's header.
void draw_image(Frame& frame, const Area& body);
void draw_image_controls(Frame& frame, float right);
void draw_inside(Frame& frame, const Area& body);
void draw_inside_controls(Frame& frame, float right);
void draw_rays(Frame& frame);
void draw_rays_controls(Frame& frame, float right);
/// The light of the row `offset` below the selected one, as the table is sorted; empty at its ends.
std::optional<std::uint32_t> neighbouring_ray(const Frame& frame, int offset);
void draw_source(Frame& frame, const Area& body);
void draw_source_controls(Frame& frame, float right);
void draw_values(Frame& frame);
void draw_parameters(Frame& frame);

void draw_top_bar(Frame& frame, const Area& area);
/// Inside the top bar, at most `width` wide; nothing where nothing moves.
void draw_time(Frame& frame, float width);
void step_time(Frame& frame, int frames);
void toggle_playing(Frame& frame);
/// Moves the time on, while playing.
void go_on_playing(Frame& frame);
void draw_step_bar(Frame& frame, const Area& area);
void draw_status_bar(Frame& frame, const Area& area);
void draw_splitters(Frame& frame, const Arrangement& areas);
/// Dialogs, and the message under the top bar.
void draw_dialogs(Frame& frame);
void draw_message(Frame& frame, const Area& top_bar);

/// "Lit", with a sentence: for the menu of channels.
struct ChannelRow {
    Channel channel;
    std::string_view title, about;
};
std::span<const ChannelRow> channel_rows();

/// The camera that the image shows. `shown.scene` must be there.
Camera shown_camera(const Frame& frame);
/// Ctrl+O and friends, and dropped files: asks for the scene; the session takes it once it could be read.
void open_scene(Frame& frame, const std::string& scene);
/// The session takes the picture as its surroundings where it can be read; else a message says why not.
void open_environment(Frame& frame, const std::filesystem::path& file);

}  // namespace sightlines
