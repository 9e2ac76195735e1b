#include "app/commands/flags.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include <CLI/CLI.hpp>

#include "app/results.h"
#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/technique.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

constexpr int most_threads = 1024;

/// The index of `text` among the names; InputError offers the nearest.
std::size_t choice_of(const std::string& flag, const std::string& text, const std::vector<std::string>& names) {
    const auto found = std::ranges::find(names, text);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    const std::string near = nearest_name(text, names);
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    throw InputError(flag, "", "has no choice " + text,
                     near.empty() ? "there are: " + all : "did you mean " + near + "?");
}

/// Text that is wholly one number of the given kind.
template <class Number>
bool is_number(const std::string& text, Number& number) {
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, number);
    return read.ec == std::errc{} && read.ptr == end;
}

void set_parameter(Session& session, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError("--set", "", "'" + text + "' is not name=value", "for example --set resolution=64");
    const std::string name = text.substr(0, equals);
    const auto table = find_technique(session.technique).parameters;
    const double value = parse_parameter(table, name, text.substr(equals + 1));
    ParameterValues& values = session.parameters[session.technique];
    values.erase(name);
    if (value != parameter_value(table, {}, name)) values[name] = value;
    if (values.empty()) session.parameters.erase(session.technique);
}

/// Whether the text is meant as a pose: it starts as a number does, and has a comma.
bool is_pose(const std::string& text) {
    return std::string_view("-.0123456789").find(text.front()) != std::string_view::npos &&
           text.find(',') != std::string::npos;
}

/// x,y,z:tx,ty,tz[:fov]
Camera pose_camera(const std::string& text) {
    const auto refuse = [&](const std::string& problem) {
        throw InputError("--camera", "", "'" + text + "' " + problem,
                         "for example --camera 8,2.5,0:-2,3,0 or, with its vertical field of view, 8,2.5,0:-2,3,0:60");
    };
    constexpr float farthest_m = 1e9f;
    std::vector<float> numbers;
    std::string separators;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find_first_of(",:", start), text.size());
        float& number = numbers.emplace_back();
        if (!is_number(text.substr(start, end - start), number) || !(std::abs(number) <= farthest_m))
            refuse("has something else than a number (to 1e9) as its part " + std::to_string(numbers.size()));
        if (end < text.size()) separators += text[end];
        start = end + 1;
    }
    if (separators != ",,:,," && separators != ",,:,,:") refuse("is not x,y,z:tx,ty,tz or x,y,z:tx,ty,tz:fov");
    Camera camera;
    camera.name = "free";
    camera.position = {numbers[0], numbers[1], numbers[2]};
    camera.target = {numbers[3], numbers[4], numbers[5]};
    if (numbers.size() > 6) camera.vertical_field_of_view_deg = numbers[6];
    if (!(camera.vertical_field_of_view_deg >= 1.0f && camera.vertical_field_of_view_deg <= 170.0f))
        refuse("has a field of view that is not from 1 to 170 degrees");
    if (!has_picture(camera)) refuse("has no picture: it looks at its own position, or straight up or down");
    return camera;
}

/// ELEVATION,AZIMUTH
void set_sun(EnvironmentChoice& environment, const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos)
        throw InputError("--sun", "", "'" + text + "' is not two angles", "for example --sun 30,-45");
    environment.sun_elevation_deg = static_cast<float>(real_number("--sun", text.substr(0, comma), -90.0, 90.0));
    environment.sun_azimuth_deg = static_cast<float>(real_number("--sun", text.substr(comma + 1), -360.0, 360.0));
}

void set_environment(EnvironmentChoice& environment, const SessionFlags& flags) {
    if (!flags.environment.empty()) environment.file = flags.environment == "sky" ? "" : flags.environment;
    if (!flags.sun.empty()) set_sun(environment, flags.sun);
    if (!flags.sun.empty() && !environment.file.empty())
        throw InputError("--sun", "", "moves the sun of the made-up sky, not of " + environment.file,
                         "leave one of them out, or --turn");
    if (!flags.turn_deg.empty())
        environment.turn_deg = static_cast<float>(real_number("--turn", flags.turn_deg, -360.0, 360.0));
}

CLI::Validator not_empty() {
    return CLI::Validator([](std::string& text) { return text.empty() ? std::string("is empty") : std::string(); }, "");
}

}  // namespace

void add_session_flags(CLI::App& command, SessionFlags& flags) {
    const auto group = std::string("What");
    const auto option = [&](const char* name, std::string& value, const char* help, const char* type) {
        command.add_option(name, value, help)->type_name(type)->check(not_empty())->group(group);
    };
    option("--technique", flags.technique, "The technique: see `sightlines list techniques`", "T");
    option("--scene", flags.scene, "A built-in scene's name, or a .gltf or .glb file", "S");
    option("--camera", flags.camera,
           "One of the scene's cameras by name, or a pose x,y,z:tx,ty,tz[:fov] (metres, degrees)", "C");
    option("--size", flags.size, "The picture's width and height in pixels", "WxH");
    option("--lights", flags.lights, "So many seeded point lights; 0: the scene's own", "N");
    option("--virtual-lights", flags.virtual_lights,
           "Indirect light: at most so many more lights where the light of the others falls", "N");
    option("--placement", flags.placement, "Where they are: volume (spread through the scene) or sphere (around it)",
           "P");
    option("--environment", flags.environment,
           "What surrounds the scene, for techniques that are lit by it: an .hdr picture, or sky", "FILE|sky");
    option("--sun", flags.sun, "Where the sky's sun is: above the horizon, and from -Z towards +X, in degrees",
           "ELEVATION,AZIMUTH");
    option("--turn", flags.turn_deg, "How far the surroundings are turned about +Y, in degrees", "DEG");
    option("--time", flags.time_s, "The moment of the scene's animation, in seconds", "S");
    command.add_option("--set", flags.parameters, "Parameters: see `sightlines list parameters`")
        ->type_name("name=value")
        ->group(group);
    option("--backend", flags.backend, "automatic, cpu or vulkan", "B");
    option("--seed", flags.seed, "Seed of everything random", "N");
    command.add_flag("--reference", flags.reference, "Also ask the same rays by Embree, and report the errors")
        ->group(group);
}

void add_selection_flags(CLI::App& command, SessionFlags& flags) {
    command.add_option("--pixel", flags.pixel, "The pixel that is looked at; 0,0 is the top left corner")
        ->type_name("X,Y")
        ->check(not_empty());
    command
        .add_option("--light", flags.light,
                    "The light that its ray goes to, or its sample of the environment, counted from 0")
        ->type_name("K")
        ->check(not_empty());
}

void add_common_flags(CLI::App& command, CommonFlags& flags) {
    command.add_option("--threads", flags.threads, "At most so many threads; never changes a result")
        ->type_name("N")
        ->check(not_empty());
    command.add_flag("--json", flags.json, "Print JSON");
    command.add_flag("--quiet", flags.quiet, "Print only what was asked for: no bar, no notes, no summary");
}

Session session_with_flags(Session session, const SessionFlags& flags) {
    if (!flags.technique.empty()) session.technique = std::string(find_technique(flags.technique).name);
    find_technique(session.technique);
    if (!flags.scene.empty()) session.scene = flags.scene;
    if (!flags.camera.empty()) {
        const bool pose = is_pose(flags.camera);
        session.camera = pose ? std::string() : flags.camera;
        session.free_camera = pose ? std::optional(pose_camera(flags.camera)) : std::nullopt;
    }
    if (!flags.size.empty()) {
        const ivec2 size = two_numbers("--size", flags.size, 'x', 1, max_side_pixels);
        session.size = {size.x, size.y};
    }
    check_size(session.size, "--size", "");
    if (!flags.lights.empty())
        session.lights.count = static_cast<std::uint32_t>(whole_number("--lights", flags.lights, 0, max_lights));
    if (!flags.virtual_lights.empty())
        session.lights.virtual_lights =
            static_cast<std::uint32_t>(whole_number("--virtual-lights", flags.virtual_lights, 0, max_lights));
    if (!flags.placement.empty())
        session.lights.placement =
            static_cast<LightPlacement>(choice_of("--placement", flags.placement, {"volume", "sphere"}));
    set_environment(session.environment, flags);
    if (!flags.time_s.empty()) session.time_s = real_number("--time", flags.time_s, -1e9, 1e9);
    if (!flags.backend.empty())
        session.backend =
            static_cast<BackendChoice>(choice_of("--backend", flags.backend, {"automatic", "cpu", "vulkan"}));
    if (!flags.seed.empty() && !is_number(flags.seed, session.seed))
        throw InputError("--seed", "", "'" + flags.seed + "' is not a seed", "a whole number from 0 to 2^64 - 1");
    for (const std::string& parameter : flags.parameters) set_parameter(session, parameter);
    session.reference = session.reference || flags.reference;
    if (!flags.pixel.empty())
        session.selection.pixel = two_numbers("--pixel", flags.pixel, ',', 0, max_side_pixels - 1);
    if (!flags.light.empty())
        session.selection.light = static_cast<std::uint32_t>(whole_number("--light", flags.light, 0, max_lights - 1));
    return session;
}

std::int64_t whole_number(const std::string& flag, const std::string& text, std::int64_t lowest, std::int64_t highest) {
    std::int64_t number = 0;
    if (!is_number(text, number) || number < lowest || number > highest)
        throw InputError(flag, "", "'" + text + "' is not a whole number in its range",
                         "give " + std::to_string(lowest) + " to " + std::to_string(highest));
    return number;
}

double real_number(const std::string& flag, const std::string& text, double lowest, double highest) {
    double number = 0.0;
    if (!is_number(text, number) || !std::isfinite(number) || number < lowest || number > highest)
        throw InputError(flag, "", "'" + text + "' is not a number in its range",
                         "give " + Json(lowest).dump() + " to " + Json(highest).dump());
    return number;
}

ivec2 two_numbers(const std::string& flag, const std::string& text, char separator, int lowest, int highest) {
    const std::size_t middle = text.find(separator);
    ivec2 numbers(0);
    const bool read = middle != std::string::npos && is_number(text.substr(0, middle), numbers.x) &&
                      is_number(text.substr(middle + 1), numbers.y);
    if (!read || numbers.x < lowest || numbers.y < lowest || numbers.x > highest || numbers.y > highest)
        throw InputError(
            flag, "",
            "'" + text + "' is not two whole numbers from " + std::to_string(lowest) + " to " + std::to_string(highest),
            std::string("for example ") + (separator == 'x' ? "640x360" : "320,180"));
    return numbers;
}

int thread_flag(const CommonFlags& flags) {
    return flags.threads.empty() ? 0 : static_cast<int>(whole_number("--threads", flags.threads, 1, most_threads));
}

Backend command_backend(const Session& session) {
    return session.backend == BackendChoice::automatic ? automatic_backend() : Backend::cpu;
}

void check_outputs(const std::vector<fs::path>& files) {
    std::set<fs::path> seen;
    for (const fs::path& file : files) {
        if (file.empty()) continue;
        check_writable(file);
        if (!seen.insert(fs::weakly_canonical(fs::absolute(file))).second)
            throw InputError(file.string(), "", "is named for two outputs", "give each a file of its own");
    }
}

void check_folder(const fs::path& folder) {
    std::error_code failure;
    fs::path existing = fs::absolute(folder).lexically_normal();
    while (!fs::exists(existing, failure) && existing.has_relative_path()) existing = existing.parent_path();
    if (!fs::is_directory(existing, failure))
        throw EnvironmentError(folder.string(), existing.string() + " is not a folder", "name another one");
    check_writable(existing / "written");
}

void make_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw EnvironmentError(folder.string(), "cannot be made: " + failure.message());
}

void check_extension(const fs::path& file, const std::vector<std::string>& extensions) {
    const std::string extension = file.extension().string();
    if (std::ranges::find(extensions, extension) != extensions.end()) return;
    std::string all;
    for (const std::string& each : extensions) all += (all.empty() ? "" : " or ") + each;
    throw InputError(file.string(), "", "ends in '" + extension + "'", "give a name that ends in " + all);
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace sightlines
