// Reading a recorded step's values back, to say what they mean in space.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "shaders/trace.h"

namespace sightlines::baselines {

/// The value of that name, where the step has it as a T.
template <class T>
std::optional<T> step_value(const TraceStep& step, std::string_view name) {
    const auto value = std::ranges::find(step.values, name, &TraceValue::name);
    if (value == step.values.end() || !std::holds_alternative<T>(value->value)) return std::nullopt;
    return std::get<T>(value->value);
}

inline std::optional<int> whole_value(const TraceStep& step, std::string_view name) {
    const auto value = step_value<std::int64_t>(step, name);
    return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

}  // namespace sightlines::baselines
