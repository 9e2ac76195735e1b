#include "techniques/scene/animation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sightlines {
namespace {

/// Two neighbouring keyframes and where between them a time lies.
struct Bracket {
    std::size_t before = 0, after = 0;
    float fraction = 0.0f;  ///< [0, 1)
    float interval_s = 0.0f;
};

Bracket bracket_of(const std::vector<float>& times_s, double time_s) {
    const auto after =
        std::ranges::upper_bound(times_s, time_s, {}, [](float time) { return static_cast<double>(time); });
    if (after == times_s.begin()) return {};
    const auto index = static_cast<std::size_t>(after - times_s.begin());
    if (after == times_s.end()) return {index - 1, index - 1, 0.0f, 0.0f};
    const double first = static_cast<double>(times_s[index - 1]);
    const double interval = static_cast<double>(times_s[index]) - first;  // positive: first <= time < next
    return {index - 1, index, static_cast<float>((time_s - first) / interval), static_cast<float>(interval)};
}

glm::quat quaternion_at(const AnimationCurve& curve, std::size_t key) {
    const float* value = curve.values.data() + 4 * key;
    return glm::quat(value[3], value[0], value[1], value[2]);
}

glm::quat unit(glm::quat rotation) {
    const float length = glm::length(rotation);
    return length > 1e-12f ? rotation / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
}

}  // namespace

void sample_curve(const AnimationCurve& curve, double time_s, std::span<float> result) {
    assert(result.size() == curve.components && !curve.times_s.empty());
    const Bracket at = bracket_of(curve.times_s, time_s);
    const std::size_t n = curve.components;
    const float t = at.fraction;
    if (curve.interpolation != Interpolation::cubic_spline) {
        const float weight = curve.interpolation == Interpolation::linear ? t : 0.0f;
        for (std::size_t i = 0; i < n; ++i)
            result[i] = curve.values[at.before * n + i] * (1.0f - weight) + curve.values[at.after * n + i] * weight;
        return;
    }
    // Hermite basis; the tangents are per second, so they are scaled by the interval.
    const float t2 = t * t, t3 = t2 * t;
    const float from_value = 2.0f * t3 - 3.0f * t2 + 1.0f, to_value = 3.0f * t2 - 2.0f * t3;
    const float from_tangent = at.interval_s * (t3 - 2.0f * t2 + t), to_tangent = at.interval_s * (t3 - t2);
    for (std::size_t i = 0; i < n; ++i) {
        const float* before = curve.values.data() + 3 * n * at.before + i;
        const float* after = curve.values.data() + 3 * n * at.after + i;
        result[i] = from_value * before[n] + from_tangent * before[2 * n] + to_value * after[n] + to_tangent * after[0];
    }
}

vec3 sample_vector(const AnimationCurve& curve, double time_s) {
    float value[3];
    sample_curve(curve, time_s, value);
    return {value[0], value[1], value[2]};
}

glm::quat sample_rotation(const AnimationCurve& curve, double time_s) {
    if (curve.interpolation == Interpolation::linear) {
        const Bracket at = bracket_of(curve.times_s, time_s);
        return unit(
            glm::slerp(unit(quaternion_at(curve, at.before)), unit(quaternion_at(curve, at.after)), at.fraction));
    }
    float value[4];
    sample_curve(curve, time_s, value);
    return unit(glm::quat(value[3], value[0], value[1], value[2]));
}

double looped_time_s(double time_s, double duration_s) {
    if (!(duration_s > 0.0) || !std::isfinite(time_s)) return 0.0;
    const double rest = std::fmod(time_s, duration_s);
    const double wrapped = rest < 0.0 ? rest + duration_s : rest;
    return wrapped < duration_s ? wrapped : 0.0;
}

}  // namespace sightlines
