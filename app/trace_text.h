// A recorded ray for people and for programs.
#pragma once

#include <string>

#include "app/selection.h"

namespace sightlines {

/// A recorded value for people: a point as (x, y, z), bits in groups of four, the unit after it.
std::string value_text(const TraceValue& value);

/// Everything that was recorded, geometry included. Positions in metres, world space.
Json json_from_trace(const Session& session, const SelectedRay& ray);

/// One block a step: its number, where it stands in the kernel and in the paper, the sentence, the values.
std::string text_from_trace(const Session& session, const SelectedRay& ray);

}  // namespace sightlines
