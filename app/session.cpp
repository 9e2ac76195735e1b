#include "app/session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/json_fields.h"
#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/builtin_scenes.h"
#include "techniques/technique.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t session_file_limit_bytes = 4u << 20u;
constexpr int deepest_json_level = 64;
constexpr float farthest_m = 1e9f;

constexpr std::array<std::string_view, 2> placement_names{"volume", "sphere"};
constexpr std::array<std::string_view, 3> backend_names{"automatic", "cpu", "vulkan"};
constexpr std::array<std::string_view, 2> camera_kind_names{"perspective", "orthographic"};
constexpr std::array<std::string_view, 3> theme_names{"light", "dark", "print"};
constexpr std::array<std::string_view, 2> cut_away_names{"none", "to_row"};
constexpr std::array<std::string_view, 9> channel_names{"lit",          "reference", "shadow",      "visibility_error",
                                                        "shadow_error", "rays",      "lights_seen", "compression",
                                                        "rays_traced"};

constexpr std::array<std::string_view, pane_count> content_names{"image",  "inside", "rays",
                                                                 "source", "values", "parameters"};
constexpr std::array<std::string_view, pane_count> place_names{"upper_left",   "upper_right", "lower_left",
                                                               "lower_middle", "lower_right", "side"};
constexpr std::array<std::string_view, 5> column_names{"light", "ours", "truth", "distance", "error"};

constexpr auto describe_size = [](auto& fields, auto& size) {
    fields.number("width", size.width, 1, max_side_pixels);
    fields.number("height", size.height, 1, max_side_pixels);
};

constexpr auto describe_moved_light = [](auto& fields, auto& moved) {
    fields.number("light", moved.light, 0u, max_lights - 1u);
    fields.vector("position_m", moved.position, -farthest_m, farthest_m);
};

constexpr auto describe_lights = [](auto& fields, auto& lights) {
    fields.number("count", lights.count, 0u, max_lights);
    fields.choice("placement", lights.placement, placement_names);
    fields.boolean("moving", lights.moving);
    fields.boolean("coloured", lights.coloured);
    fields.number("brightness", lights.brightness, 0.0f, 1e6f);
    fields.list("moved", lights.moved, max_moved_lights, describe_moved_light);
    fields.number("virtual_lights", lights.virtual_lights, 0u, max_lights);
};

constexpr auto describe_environment = [](auto& fields, auto& environment) {
    fields.text("file", environment.file, max_text_bytes);
    fields.number("sun_elevation_deg", environment.sun_elevation_deg, -90.0f, 90.0f);
    fields.number("sun_azimuth_deg", environment.sun_azimuth_deg, -360.0f, 360.0f);
    fields.number("turn_deg", environment.turn_deg, -360.0f, 360.0f);
    fields.number("turn_deg_per_s", environment.turn_deg_per_s, -3600.0f, 3600.0f);
};

constexpr auto describe_camera = [](auto& fields, auto& camera) {
    fields.text("name", camera.name, max_text_bytes);
    fields.choice("kind", camera.kind, camera_kind_names);
    fields.vector("position_m", camera.position, -farthest_m, farthest_m);
    fields.vector("target_m", camera.target, -farthest_m, farthest_m);
    fields.vector("up", camera.up, -1.0f, 1.0f);
    fields.number("vertical_field_of_view_deg", camera.vertical_field_of_view_deg, 1.0f, 170.0f);
    fields.number("orthographic_height_m", camera.orthographic_height_m, 1e-6f, farthest_m);
};

constexpr auto describe_selection = [](auto& fields, auto& selection) {
    fields.optional_vector("pixel", selection.pixel, 0, max_side_pixels - 1);
    fields.optional_number("light", selection.light, 0u, max_lights - 1u);
    fields.number("step", selection.step, 0u, 1u << 20u);
    fields.optional_vector("voxel", selection.voxel, 0, 1 << 20);
};

constexpr auto describe_orbit = [](auto& fields, auto& camera) {
    fields.vector("focal_point_m", camera.focal_point, -farthest_m, farthest_m);
    fields.number("azimuth_deg", camera.azimuth_deg, -360.0f, 360.0f);
    fields.number("elevation_deg", camera.elevation_deg, -89.0f, 89.0f);
    fields.number("distance_m", camera.distance_m, 1e-6f, farthest_m);
};

constexpr auto describe_view = [](auto& fields, auto& view) {
    fields.text("figure", view.figure, max_text_bytes);
    fields.optional_object("camera", view.state.camera, describe_orbit);
    fields.choice("theme", view.state.theme, theme_names);
    fields.boolean("scene", view.state.scene);
    fields.boolean("voxels", view.state.voxels);
    fields.boolean("row", view.state.row);
    fields.boolean("extent", view.state.extent);
    fields.boolean("ray", view.state.ray);
    fields.boolean("twin", view.state.twin);
    fields.boolean("labels", view.state.labels);
    fields.choice("cut_away", view.state.cut_away, cut_away_names);
    fields.number("slab_voxels", view.state.slab_voxels, 1, 1024);
    fields.number("slice_first", view.state.slice_first, 0, 1023);
    fields.number("slice_last", view.state.slice_last, 0, 1023);
    fields.number("merged_samples", view.state.merged_samples, 1, most_merged_samples);
};

constexpr auto describe_display = [](auto& fields, auto& display) {
    fields.number("exposure_stops", display.exposure_stops, -32.0f, 32.0f);
    fields.boolean("tone_curve", display.tone_curve);
};

constexpr auto describe_layout = [](auto& fields, auto& layout) {
    fields.number("main_width", layout.main_width, 0.05f, 0.95f);
    fields.number("upper_height", layout.upper_height, 0.05f, 0.95f);
    fields.number("upper_left_width", layout.upper_left, 0.05f, 0.95f);
    fields.number("lower_left_width", layout.lower_left, 0.05f, 0.95f);
    fields.number("lower_middle_end", layout.lower_middle, 0.05f, 0.95f);
    for (std::size_t place = 0; place < pane_count; ++place)
        fields.choice(place_names[place], layout.panes[place], content_names);
    fields.optional_choice("maximised", layout.maximised, place_names);
};

constexpr auto describe_workbench = [](auto& fields, auto& workbench) {
    fields.choice("theme", workbench.theme, std::span(theme_names).first(2));
    fields.number("text_scale", workbench.text_scale, 0.5f, 3.0f);
    fields.object("layout", workbench.layout, describe_layout);
    fields.choice("sorted_by", workbench.sorted_by, column_names);
    fields.boolean("descending", workbench.descending);
    fields.boolean("fit_picture", workbench.fit_picture);
    fields.boolean("lights_shown", workbench.lights_shown);
};

/// All fields but the parameters, which the technique's own table describes.
constexpr auto describe_session = [](auto& fields, auto& session) {
    fields.text("scene", session.scene, max_text_bytes);
    fields.number("time_s", session.time_s, -1e9, 1e9);
    fields.text("camera", session.camera, max_text_bytes);
    fields.optional_object("free_camera", session.free_camera, describe_camera);
    fields.object("size", session.size, describe_size);
    fields.object("lights", session.lights, describe_lights);
    fields.object("environment", session.environment, describe_environment);
    fields.text("technique", session.technique, max_text_bytes);
    fields.choice("backend", session.backend, backend_names);
    fields.number("seed", session.seed, std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max());
    fields.boolean("reference", session.reference);
    fields.object("selection", session.selection, describe_selection);
    fields.list("views", session.views, max_views, describe_view);
    fields.object("display", session.display, describe_display);
    fields.choice("channel", session.channel, channel_names);
    fields.object("workbench", session.workbench, describe_workbench);
};

/// `{"voxel_rows": {"resolution": 64, "row_choice": "two_subrays"}}`: values as people write them.
Json json_from_parameters(const Session& session) {
    Json all = Json::object();
    for (const auto& [technique_name, values] : session.parameters) {
        Json own = Json::object();
        for (const auto& [name, value] : values) {
            const auto table = find_technique(technique_name).parameters;
            const auto row = std::ranges::find(table, std::string_view(name), &Parameter::name);
            const bool as_text = row->kind == ParameterKind::choice;
            own[name] = as_text                               ? Json(parameter_text(*row, value))
                        : row->kind == ParameterKind::boolean ? Json(value != 0.0)
                        : row->kind == ParameterKind::integer ? Json(static_cast<std::int64_t>(value))
                                                              : Json(value);
        }
        if (!own.empty()) all[technique_name] = std::move(own);
    }
    return all;
}

ParameterValues parameters_from_json(const Technique& technique, const Json& json, const FieldReader& place) {
    ParameterValues values;
    for (const auto& [name, value] : json.items()) {
        if (value.is_null()) continue;
        if (!value.is_primitive()) place.fail(place.at(name), "is not a number, a text, true or false");
        try {
            const double read = parse_parameter(technique.parameters, name,
                                                value.is_string() ? value.get<std::string>() : value.dump());
            if (read != parameter_value(technique.parameters, {}, name)) values[name] = read;
        } catch (const InputError& error) {
            place.fail(place.at(name), error.problem, error.remedy);
        }
    }
    return values;
}

const Technique& technique_at(const std::string& name, const FieldReader& fields, const std::string& pointer) {
    try {
        return find_technique(name);
    } catch (const InputError& error) {
        fields.fail(pointer, "technique " + name + " " + error.problem, error.remedy);
    }
}

bool is_builtin(const std::string& scene) {
    return std::ranges::any_of(builtin_scenes(), [&](const SceneModel& model) { return model.name == scene; });
}

}  // namespace

bool has_picture(const Camera& camera) {
    const vec3 view = camera.target - camera.position;
    const float sine = glm::length(glm::cross(view, camera.up));
    return sine > 1e-6f * glm::length(view) * glm::length(camera.up);
}

bool needs_reference(const Session& session) {
    return session.reference || session.channel == Channel::reference || session.channel == Channel::visibility_error ||
           session.channel == Channel::shadow_error || session.channel == Channel::compression;
}

bool lit_by_environment(const Session& session) { return find_technique(session.technique).environment != nullptr; }

ParameterValues technique_parameters(const Session& session) {
    const auto found = session.parameters.find(session.technique);
    return found == session.parameters.end() ? ParameterValues{} : found->second;
}

Json json_from_session(const Session& session) {
    FieldWriter fields;
    describe_session(fields, session);
    fields.raw("parameters", json_from_parameters(session));
    return fields.take();
}

Session session_from_json(const Json& given, const std::string& where) {
    Session session;
    Json json = given;
    if (json.is_object() && json.contains("environment") && json["environment"].is_string())
        json["environment"] = {{"file", json["environment"]}};
    FieldReader fields(json, where, "");
    describe_session(fields, session);
    technique_at(session.technique, fields, "/technique");
    if (const Json* parameters = fields.find("parameters")) {
        const FieldReader by_technique(*parameters, where, "/parameters");
        for (const auto& [name, values] : parameters->items()) {
            if (values.is_null()) continue;
            const FieldReader own(values, where, by_technique.at(name));
            const Technique& technique = technique_at(name, fields, by_technique.at(name));
            ParameterValues read = parameters_from_json(technique, values, own);
            if (!read.empty()) session.parameters[name] = std::move(read);
        }
    }
    fields.finish();
    check_size(session.size, where, "/size");
    if (session.free_camera && !has_picture(*session.free_camera))
        fields.fail("/free_camera", "has no picture: it looks at its own position, or along its up direction",
                    "move target_m or turn up");
    return session;
}

Session patched(const Session& session, const Json& patch, const std::string& where) {
    Json json = json_from_session(session);
    json.merge_patch(patch);
    return session_from_json(json, where);
}

Json read_json(const fs::path& file) {
    const std::vector<std::uint8_t> bytes = read_file(file, session_file_limit_bytes);
    const auto refuse_deep = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > deepest_json_level)
            throw InputError(file.string(), "", "is nested too deeply",
                             "at most " + std::to_string(deepest_json_level) + " levels");
        return true;
    };
    try {
        return Json::parse(bytes.begin(), bytes.end(), refuse_deep);
    } catch (const Json::parse_error& error) {
        const auto upto = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), error.byte));
        const auto line = 1 + std::count(bytes.begin(), upto, '\n');
        const auto line_start = std::find(std::make_reverse_iterator(upto), bytes.rend(), '\n').base();
        throw InputError(file.string(),
                         "line " + std::to_string(line) + ", column " + std::to_string(upto - line_start),
                         "is not JSON", "see what stands there");
    }
}

Session load_session(const fs::path& file) {
    return session_from_json(with_paths_in(read_json(file), file.parent_path(), file.string()), file.string());
}

Json with_paths_in(Json json, const fs::path& folder, const std::string& where) {
    if (!json.is_object()) return json;
    const fs::path home = fs::weakly_canonical(fs::absolute(folder.empty() ? fs::path(".") : folder));
    for (const char* field : {"/scene", "/environment", "/environment/file"}) {
        const Json::json_pointer place(field);
        if (!json.contains(place) || !json[place].is_string()) continue;
        const auto path = json[place].get<std::string>();
        if (path.empty() || is_builtin(path)) continue;
        const fs::path relative = fs::weakly_canonical(fs::absolute(folder / path)).lexically_relative(home);
        if (relative.empty() || *relative.begin() == "..")
            throw InputError(where, field, path + " lies outside the session's folder",
                             "move it there, or name it on the command line");
        json[place] = (folder / path).string();
    }
    return json;
}

void save_session(const fs::path& file, Session session) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!is_builtin(session.scene)) session.scene = fs::proximate(session.scene, folder).generic_string();
    std::string& surroundings = session.environment.file;
    if (!surroundings.empty()) surroundings = fs::proximate(surroundings, folder).generic_string();
    write_file(file, json_from_session(session).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void check_size(ImageSize size, const std::string& where, const std::string& place) {
    const std::string text = std::to_string(size.width) + "x" + std::to_string(size.height);
    if (size.width < 1 || size.height < 1 || size.width > max_side_pixels || size.height > max_side_pixels)
        throw InputError(where, place, text + " is not a picture",
                         "width and height from 1 to " + std::to_string(max_side_pixels));
    if (size.pixels() > max_picture_pixels)
        throw InputError(where, place, text + " is too large",
                         "at most " + std::to_string(max_picture_pixels) + " pixels in all");
}

}  // namespace sightlines
