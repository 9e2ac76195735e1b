// What every part of the window is given to draw itself once, and where its edits go.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <imgui.h>

#include "app/desk/background.h"
#include "app/desk/inside_thread.h"
#include "app/desk/playing.h"
#include "app/session.h"
#include "app/window/style.h"
#include "app/window/texture.h"
#include "app/window/window.h"
#include "app/workbench/layout.h"

namespace sightlines {

/// A line for the user; stays until it is closed or what it tells of is done again.
struct Message {
    std::string text;
    bool is_error = true;
};

/// Which dialog is open, and what was typed into it so far.
enum class Dialog { none, keys, open_scene, open_session, save_session, open_environment };

/// What the window remembers between frames and no session holds: where the mouse is, what is half typed. Losing it
/// loses no work.
struct Ui {
    Dialog dialog = Dialog::none, opened_dialog = Dialog::none;  ///< asked for; the one whose popup is open
    std::string typed_path;
    std::filesystem::path folder;     ///< that the file list shows
    std::vector<std::string> recent;  ///< scene files, newest first
    std::optional<Message> message;
    std::vector<TraceGeometry> pointed;  ///< lit in the view inside because the mouse is on its value
    vec2 press{0.0f};                    ///< where the mouse button went down in the image or the view
    bool moving_light = false;           ///< the drag in the image holds the light's handle
    std::uint32_t scrolled_line = 0;     ///< of the source: the line that was last brought into view
    std::string scrolled_file;
    std::optional<std::uint32_t> scrolled_ray;  ///< the light whose row of the table was last brought into view
    std::optional<Playing> playing;
    bool quitting = false;
};

/// Pictures on the graphics side.
struct PaneTextures {
    WindowTexture image, inside;
    std::uint64_t image_number = 0;                  ///< of the PictureShown that `image` holds
    std::shared_ptr<const InsideShown> inside_held;  ///< that `inside` holds
};

/// One frame. `session` is what is on screen; widgets change `next`, which becomes the session when the frame is done.
struct Frame {
    Window& window;
    Background& background;
    const Shown& shown;
    const std::shared_ptr<const InsideShown>& inside;
    const std::string& inside_failure;
    PaneTextures& textures;
    Ui& ui;
    const Session& session;
    Session next;
    bool in_gesture = false;  ///< a drag is changing `next`: its edits are one step of undo, and drafts will do
    float scale = 1.0f;       ///< pixels for a design pixel
    const Fonts& fonts;
    const Colours& colours;
    bool undo = false, redo = false;  ///< asked for
    bool can_undo = false, can_redo = false;
    bool escape = false;  ///< the key was pressed
};

/// The view inside that the session has open, or the default.
ViewState inside_state(const Session& session);
void set_inside_state(Session& session, const ViewState& state);

/// The recorded steps of the ray that is selected; empty until it has been recorded, and where there is none.
std::span<const TraceStep> recorded_steps(const Frame& frame);
/// The step as it is chosen by now in this frame, kept inside the steps that there are. Meaningless without steps.
std::size_t current_step(const Frame& frame);
void go_to_step(Frame& frame, std::int64_t step);
/// The ray that is shown belongs to the session's selection (and not to the one before it).
bool ray_is_current(const Frame& frame);
/// Why the selected pixel has no ray to show; empty where it has.
std::string ray_failure_text(const Frame& frame);
void select_pixel(Frame& frame, ivec2 pixel);
void select_light(Frame& frame, std::uint32_t light);

}  // namespace sightlines
