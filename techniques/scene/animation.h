// Values that change over time: keyframes, and what lies between them (glTF 2.0, appendix C).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "techniques/base/types.h"

namespace sightlines {

enum class Interpolation { step, linear, cubic_spline };

/// K keyframes of `components` numbers each. Before the first and after the last, that keyframe's value holds.
struct AnimationCurve {
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t components = 1;
    std::vector<float> times_s;  ///< [K], K >= 1, not decreasing
    std::vector<float>
        values;  ///< [K * components]; cubic_spline: [K * 3 * components], in-tangent, value, out-tangent
};

/// The curve at `time_s`, number by number. `result` holds `components` numbers.
void sample_curve(const AnimationCurve& curve, double time_s, std::span<float> result);

/// A curve of 3 components.
vec3 sample_vector(const AnimationCurve& curve, double time_s);

/// A curve of 4 components (x, y, z, w) as a unit quaternion: linear means along the shorter great arc at constant
/// speed.
glm::quat sample_rotation(const AnimationCurve& curve, double time_s);

/// `time_s` brought into [0, duration_s) by whole periods; 0 where nothing moves or the time is not finite.
double looped_time_s(double time_s, double duration_s);

}  // namespace sightlines
