// A measured table as a picture: ours beside the paper's.
#pragma once

#include <cstdint>
#include <vector>

#include "app/bench_output.h"

namespace sightlines {

/// The file. Ours is filled, the paper's hollow; never told apart by colour alone. EnvironmentError where Cairo ran out
/// of memory.
std::vector<std::uint8_t> svg_from_measured(const MeasuredTable& table);

}  // namespace sightlines
