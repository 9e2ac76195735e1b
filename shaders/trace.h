// What a recorded kernel leaves behind: steps with values and geometry. C++ only; below everything else, because the
// kernels compiled with recording on write it and every part above reads it.
#ifndef SIGHTLINES_TRACE_H
#define SIGHTLINES_TRACE_H

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

namespace sightlines {

/// A value in a step: its name in the kernel, and how to print it.
struct TraceValue {
    std::string name;
    std::variant<std::int64_t, double, glm::vec3, bool, std::string> value;  ///< a string holds bits, "0010 1100 ..."
    std::string unit;
};

enum class TraceShape { point, segment, box };

/// Something to show in the 3D view, world space, m. point: 1 point; segment: 2; box: origin and three edge vectors.
struct TraceGeometry {
    std::string name;  ///< "ray", "row", "extent" ...
    TraceShape shape = TraceShape::point;
    std::vector<glm::vec3> points;

    bool operator==(const TraceGeometry&) const = default;
};

/// One NOTE in a kernel, as it ran.
struct TraceStep {
    std::string file;  ///< "shaders/voxel_rows.h"
    int line = 0;
    std::string paper;  ///< "Algorithm 3, line 1"
    std::string sentence;
    std::vector<TraceValue> values;
    std::vector<TraceGeometry> geometry;
};

}  // namespace sightlines

#endif
