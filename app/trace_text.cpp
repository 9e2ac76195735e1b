#include "app/trace_text.h"

#include <algorithm>
#include <type_traits>

#include "app/table.h"

namespace sightlines {
namespace {

constexpr std::size_t text_width = 96;
constexpr std::size_t value_width = 79;  // sixteen groups of four bits to a line

Json json_from_point(vec3 point) { return {point.x, point.y, point.z}; }

Json json_from_value(const TraceValue& value) {
    return std::visit(
        [](const auto& held) -> Json {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, vec3>)
                return json_from_point(held);
            else
                return held;
        },
        value.value);
}

std::string point_text(vec3 point) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis)
        text.append(axis == 0 ? "(" : ", ").append(fixed_text(static_cast<double>(point[axis]), 3));
    return text.append(")");
}

std::string verdict_text(bool blocked) { return blocked ? "blocked" : "open"; }

std::string judgement(const SelectedRay& ray) {
    if (ray.trace.blocked == ray.truly_blocked) return "they agree";
    return ray.trace.blocked ? "wrong: a false shadow" : "wrong: light leaks through";
}

/// The values of a step, in lines under its sentence; bits go below one another in groups.
std::string values_text(const TraceStep& step) {
    TextTable table;
    for (const TraceValue& value : step.values) {
        const std::vector<std::string> lines = wrapped(value_text(value), value_width);
        for (std::size_t line = 0; line < std::max<std::size_t>(1, lines.size()); ++line)
            table.rows.push_back({line == 0 ? value.name : "", line < lines.size() ? lines[line] : ""});
    }
    return text_from(table, 8);
}

}  // namespace

std::string value_text(const TraceValue& value) {
    const std::string text = std::visit(
        [](const auto& held) -> std::string {
            using Held = std::decay_t<decltype(held)>;
            if constexpr (std::is_same_v<Held, vec3>)
                return point_text(held);
            else if constexpr (std::is_same_v<Held, bool>)
                return held ? "true" : "false";
            else if constexpr (std::is_same_v<Held, std::string>)
                return held;
            else if constexpr (std::is_same_v<Held, double>)
                return fixed_text(held, 4);
            else
                return std::to_string(held);
        },
        value.value);
    return value.unit.empty() ? text : text + " " + value.unit;
}

Json json_from_trace(const Session& session, const SelectedRay& ray) {
    Json steps = Json::array();
    for (const TraceStep& step : ray.trace.steps) {
        Json values = Json::array(), geometry = Json::array();
        for (const TraceValue& value : step.values)
            values.push_back({{"name", value.name}, {"value", json_from_value(value)}, {"unit", value.unit}});
        for (const TraceGeometry& shape : step.geometry) {
            constexpr const char* names[] = {"point", "segment", "box"};
            Json points = Json::array();
            for (const vec3 point : shape.points) points.push_back(json_from_point(point));
            geometry.push_back(
                {{"name", shape.name}, {"shape", names[static_cast<std::size_t>(shape.shape)]}, {"points_m", points}});
        }
        steps.push_back({{"step", steps.size() + 1},
                         {"file", step.file},
                         {"line", step.line},
                         {"paper", step.paper},
                         {"sentence", step.sentence},
                         {"values", values},
                         {"geometry", geometry}});
    }
    return {{"technique", session.technique},
            {"scene", session.scene},
            {"size", {session.size.width, session.size.height}},
            {"pixel", {ray.pixel.x, ray.pixel.y}},
            {"light", ray.light},
            {"ray",
             {{"origin_m", json_from_point(ray.trace.ray.origin)},
              {"target_m", json_from_point(ray.trace.ray.target)},
              {"normal", json_from_point(ray.request.normal)}}},
            {"blocked", ray.trace.blocked},
            {"embree_blocked", ray.truly_blocked},
            {"steps", steps}};
}

std::string text_from_trace(const Session& session, const SelectedRay& ray) {
    const Segment& segment = ray.trace.ray;
    const std::string title(find_technique(session.technique).title);
    TextTable head;
    head.rows = {
        {"ray", "pixel " + std::to_string(ray.pixel.x) + "," + std::to_string(ray.pixel.y) + " of " + session.scene +
                    (lit_by_environment(session) ? ", sample " : " to light ") + std::to_string(ray.light) + ", " +
                    fixed_text(static_cast<double>(glm::length(segment.target - segment.origin)), 3) + " m"},
        {"from", point_text(segment.origin) + " m"},
        {"to", point_text(segment.target) + " m"}};
    std::string text = text_from(head) + "\n";
    TextTable lines;
    lines.align = {TableAlign::right};
    for (std::size_t i = 0; i < ray.trace.steps.size(); ++i) {
        const TraceStep& step = ray.trace.steps[i];
        lines.rows.push_back({std::to_string(i + 1), step.file + ":" + std::to_string(step.line), step.paper});
    }
    const std::string aligned = text_from(lines, 2);
    std::size_t start = 0;
    for (const TraceStep& step : ray.trace.steps) {
        const std::size_t end = aligned.find('\n', start);
        text.append(aligned, start, end - start).append("\n");
        start = end + 1;
        for (const std::string& line : wrapped(step.sentence, text_width - 6))
            text.append(6, ' ').append(line).append("\n");
        text += values_text(step) + "\n";
    }
    TextTable verdict;
    verdict.rows = {{title, verdict_text(ray.trace.blocked)}, {"Embree", verdict_text(ray.truly_blocked)}};
    return text + text_from(verdict) + judgement(ray) + "\n";
}

}  // namespace sightlines
