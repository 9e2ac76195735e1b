// The text of the kernels, kept inside the program: what the ray debugger shows beside a recorded step.
#ifndef SIGHTLINES_KERNEL_SOURCE_H
#define SIGHTLINES_KERNEL_SOURCE_H

#include <string_view>

namespace sightlines {

/// The whole text of a file of shaders/, named as in TraceStep::file ("shaders/voxel_rows.h"). Empty for other names.
std::string_view kernel_source(std::string_view path);

}  // namespace sightlines

#endif
