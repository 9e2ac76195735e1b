// The one value that everything on screen, and every file written, is a function of (DESIGN, "The one idea").
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "techniques/base/image.h"
#include "techniques/base/parameters.h"
#include "techniques/scene/lights.h"
#include "techniques/scene/scene.h"
#include "visualizers/view_state.h"

namespace sightlines {

using Json = nlohmann::json;

/// What a session may ask for; files and flags that go beyond are refused, and the message names the limit.
constexpr int max_side_pixels = 16384;
constexpr std::size_t max_picture_pixels = std::size_t{1} << 26u;
constexpr std::uint32_t max_lights = 65536;
constexpr std::size_t max_text_bytes = 4096;
constexpr std::size_t max_views = 16;
constexpr std::size_t max_moved_lights = 256;

/// `automatic`: Vulkan on a real GPU, the CPU where there is none.
enum class BackendChoice { automatic, cpu, vulkan };

/// Which picture is shown: radiance by the technique or by the reference, one of the technique's companions, or what
/// its compression changed.
enum class Channel {
    lit,
    reference,
    shadow,
    visibility_error,
    shadow_error,
    rays,
    lights_seen,
    compression,
    rays_traced
};

/// What the user points at. `light` counts the session's lights, `step` the recorded steps of that ray.
struct Selection {
    std::optional<ivec2> pixel;  ///< (0, 0) is the top left corner
    std::optional<std::uint32_t> light;
    std::uint32_t step = 0;
    std::optional<ivec3> voxel;  ///< (u, v, w) of the voxelization that serves the ray

    bool operator==(const Selection&) const = default;
};

/// A view inside that is open: which figure it shows (`list figures`), and how it is looked at.
struct View {
    std::string figure = "voxel-row";
    ViewState state;

    bool operator==(const View&) const = default;
};

/// What a pane of the window shows.
enum class PaneContent { image, inside, rays, source, values, parameters };

/// Where a pane is: two above, three below, one at the side.
enum class PanePlace { upper_left, upper_right, lower_left, lower_middle, lower_right, side };
constexpr std::size_t pane_count = 6;

/// How the window is divided. Shares are of the length that is divided, from the left or the top.
struct Layout {
    float main_width = 0.81f;    ///< of the window: what is left of the side pane
    float upper_height = 0.66f;  ///< of the height between the bars
    float upper_left = 0.47f;    ///< of the main width
    float lower_left = 0.34f;    ///< of the main width
    float lower_middle = 0.73f;  ///< of the main width: where the middle pane ends
    std::array<PaneContent, pane_count> panes{PaneContent::image,  PaneContent::inside, PaneContent::rays,
                                              PaneContent::source, PaneContent::values, PaneContent::parameters};
    std::optional<PanePlace> maximised;  ///< alone between the bars

    bool operator==(const Layout&) const = default;
};

/// The columns of the table of rays.
enum class RayColumn { light, ours, truth, distance, error };

/// How the window itself looks.
struct Workbench {
    Theme theme = Theme::dark;  ///< light or dark
    float text_scale = 1.0f;    ///< on top of the monitor's
    Layout layout;
    bool fit_picture = false;  ///< the picture's size follows its pane
    RayColumn sorted_by = RayColumn::error;
    bool descending = true;
    bool lights_shown = false;  ///< all lights, as dots on the image

    bool operator==(const Workbench&) const = default;
};

/// What surrounds the scene, for techniques that are lit by that instead of lights.
struct EnvironmentChoice {
    std::string file;                 ///< a picture of the surroundings, .hdr; empty: a made-up sky
    float sun_elevation_deg = 45.0f;  ///< of the sky's sun above the horizon
    float sun_azimuth_deg = 30.0f;    ///< from -Z towards +X
    float turn_deg = 0.0f;            ///< about +Y, from -Z towards +X, file or sky
    float turn_deg_per_s = 0.0f;      ///< and so much more with the session's time

    bool operator==(const EnvironmentChoice&) const = default;
};

struct Session {
    std::string scene = "atrium";  ///< a built-in scene's name, or a .gltf or .glb file
    double time_s = 0.0;
    std::string camera;                 ///< one of the scene's cameras; empty: its first
    std::optional<Camera> free_camera;  ///< wins over `camera`: the user has moved
    ImageSize size;
    LightChoice lights;
    EnvironmentChoice environment;
    std::string technique = "voxel_rows";
    std::map<std::string, ParameterValues> parameters;  ///< by technique; those that differ from its table's defaults
    BackendChoice backend = BackendChoice::automatic;
    std::uint64_t seed = 1;
    bool reference = false;  ///< also ask the same rays by Embree and report the errors
    Selection selection;
    std::vector<View> views;
    Display display;
    Channel channel = Channel::lit;
    Workbench workbench;

    bool operator==(const Session&) const = default;
};

/// Whether every ray's answer is kept and Embree answers the same rays: the session says so, or shows a channel that
/// compares.
bool needs_reference(const Session& session);

/// Whether the session's technique is lit by the environment; otherwise by the lights. The other is left out.
bool lit_by_environment(const Session& session);

/// The parameters of the session's own technique.
ParameterValues technique_parameters(const Session& session);

/// Every field, except optional ones that are not set and parameters at their defaults.
Json json_from_session(const Session& session);

/// A field that is missing or null has its default, so `{}` is `Session{}`. An environment may be its file's name
/// alone. `where` names the source in messages. InputError, with the JSON pointer, for a key that is not known (offers
/// the nearest), a wrong type, a value out of range, an unknown technique or parameter.
Session session_from_json(const Json& json, const std::string& where);

/// `session` changed by a merge patch (RFC 7386), checked afterwards as above: a step of a lesson, or a further file.
Session patched(const Session& session, const Json& patch, const std::string& where);

/// Reads and parses a JSON file of at most 4 MiB and 64 levels. InputError names line and column of a syntax error.
Json read_json(const std::filesystem::path& file);

/// A saved session. A scene file's path is taken from the session file's own folder, which it must not leave.
Session load_session(const std::filesystem::path& file);

/// `json` (a session or a patch, from a file in `folder`) with the scene's and the environment's path put in relation
/// to where the program runs. InputError for a path that leads out of `folder`: a session from others reads nothing
/// else.
Json with_paths_in(Json json, const std::filesystem::path& folder, const std::string& where);

/// Complete or not at all. Paths become relative to the file's folder.
void save_session(const std::filesystem::path& file, Session session);

/// Whether the camera looks anywhere: not at its own position, and not along its up direction.
bool has_picture(const Camera& camera);

/// InputError unless 1 <= width, height <= max_side_pixels and the whole is at most max_picture_pixels.
void check_size(ImageSize size, const std::string& where, const std::string& place);

}  // namespace sightlines
