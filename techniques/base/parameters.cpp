#include "techniques/base/parameters.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

const Parameter* find(std::span<const Parameter> table, std::string_view name) {
    const auto row = std::ranges::find(table, name, &Parameter::name);
    return row == table.end() ? nullptr : &*row;
}

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}

/// The names as a sentence lists them.
template <class Names>
std::string joined(const Names& names) {
    std::string all;
    for (const auto& name : names) {
        if (!all.empty()) all.append(", ");
        all.append(name);
    }
    return all;
}

const Parameter& known(std::span<const Parameter> table, std::string_view name) {
    if (const Parameter* parameter = find(table, name)) return *parameter;
    std::vector<std::string> names;
    for (const Parameter& row : table) names.emplace_back(row.name);
    const std::string near = nearest_name(std::string(name), names);
    throw InputError("parameter " + std::string(name), "", "is not known",
                     near.empty() ? "there are: " + joined(names) : "did you mean " + near + "?");
}

void check(const Parameter& parameter, double value) {
    const std::string where = "parameter " + std::string(parameter.name);
    std::string range = number_text(parameter.lowest) + " to " + number_text(parameter.highest);
    if (!parameter.unit.empty()) range.append(" ").append(parameter.unit);
    if (!std::isfinite(value) || value < parameter.lowest || value > parameter.highest)
        throw InputError(where, "", number_text(value) + " is outside its range", "give " + range);
    if (parameter.kind != ParameterKind::real && value != std::floor(value))
        throw InputError(where, "", number_text(value) + " is not a whole number", "give " + range);
}

}  // namespace

double parameter_value(std::span<const Parameter> table, const ParameterValues& values, std::string_view name) {
    if (const auto given = values.find(std::string(name)); given != values.end()) return given->second;
    const Parameter* parameter = find(table, name);
    assert(parameter != nullptr);
    return parameter->default_value;
}

double parse_parameter(std::span<const Parameter> table, std::string_view name, std::string_view text) {
    const Parameter& parameter = known(table, name);
    if (parameter.kind == ParameterKind::choice) {
        const auto choice = std::ranges::find(parameter.choices, text);
        if (choice != parameter.choices.end()) return static_cast<double>(choice - parameter.choices.begin());
        const std::string near = nearest_name(std::string(text), parameter.choices);
        throw InputError("parameter " + std::string(name), "", "has no choice " + std::string(text),
                         near.empty() ? "there are: " + joined(parameter.choices) : "did you mean " + near + "?");
    }
    if (parameter.kind == ParameterKind::boolean) {
        if (text == "true" || text == "on" || text == "1") return 1.0;
        if (text == "false" || text == "off" || text == "0") return 0.0;
        throw InputError("parameter " + std::string(name), "", std::string(text) + " is neither true nor false");
    }
    const std::string copy(text);
    char* end = nullptr;
    const double value = std::strtod(copy.c_str(), &end);
    if (copy.empty() || *end != '\0')
        throw InputError("parameter " + std::string(name), "", copy.empty() ? "is empty" : copy + " is not a number");
    check(parameter, value);
    return value;
}

std::string parameter_text(const Parameter& parameter, double value) {
    if (parameter.kind == ParameterKind::boolean) return value != 0.0 ? "true" : "false";
    if (parameter.kind == ParameterKind::choice) return std::string(parameter.choices[static_cast<std::size_t>(value)]);
    return number_text(value);
}

void check_parameters(std::span<const Parameter> table, const ParameterValues& values) {
    for (const auto& [name, value] : values) check(known(table, name), value);
}

}  // namespace sightlines
