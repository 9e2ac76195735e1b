// A technique's parameters: one table from which come the sliders, `--set`, JSON and the docs.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sightlines {

enum class ParameterKind { integer, real, boolean, choice };

/// What has to be made again when the parameter changes: the structure, or only the picture.
enum class ParameterAffects { structure, picture };

struct Parameter {
    std::string_view name;   ///< as in `--set name=value` and JSON
    std::string_view title;  ///< as on screen
    std::string_view unit;   ///< "" for a pure number
    ParameterKind kind = ParameterKind::real;
    ParameterAffects affects = ParameterAffects::picture;
    double lowest = 0.0, highest = 1.0;  ///< inclusive; a choice counts from 0
    double default_value = 0.0;
    std::optional<double> paper_value;  ///< where the paper names one
    std::string_view help;              ///< one sentence
    std::span<const std::string_view> choices = {};
};

/// The values that differ from the table's defaults (sparse, so that a saved session survives new parameters).
/// Integers, booleans (0, 1) and choices (their index) are held as doubles.
using ParameterValues = std::map<std::string, double>;

/// The value of `name`: from `values`, else the table's default. `name` must be in the table (our own fault otherwise).
double parameter_value(std::span<const Parameter> table, const ParameterValues& values, std::string_view name);

/// Reads `text` ("128", "1.5", "true", a choice's name) as the parameter `name`.
/// InputError: unknown name (offers the nearest), not a number, outside the range (names the range), unknown choice.
double parse_parameter(std::span<const Parameter> table, std::string_view name, std::string_view text);

/// The value as people write it: `128`, `1.5`, `true`, the choice's name.
std::string parameter_text(const Parameter& parameter, double value);

/// InputError where a value is not in the table, not finite, out of range or not whole where it must be.
void check_parameters(std::span<const Parameter> table, const ParameterValues& values);

}  // namespace sightlines
