// The kernels' scalar vocabulary with recording on: NOTE and SHOW write to the recorder of this thread. Include before
// a kernel header to compile it so.
#ifndef SIGHTLINES_RECORDING_H
#define SIGHTLINES_RECORDING_H

#include "shaders/trace.h"

#define KERNEL_NAMESPACE recording_kernel
#define NOTE(paper, sentence) ::sightlines::recording_kernel::begin_step(__FILE__, __LINE__, paper, sentence)
#define SHOW(value) ::sightlines::recording_kernel::show(#value, value)
#define SHOW_BITS(name, word) ::sightlines::recording_kernel::show_bits(name, word)
#define SHOW_POINT(place) ::sightlines::recording_kernel::show_shape(#place, ::sightlines::TraceShape::point, {place})
#define SHOW_SEGMENT(name, a, b) \
    ::sightlines::recording_kernel::show_shape(name, ::sightlines::TraceShape::segment, {a, b})

namespace sightlines::recording_kernel {

/// Where this thread's kernels write; set by Recording for as long as it lives. Kernels take no context argument,
/// because GLSL could not pass one.
inline thread_local std::vector<TraceStep>* recorded_steps = nullptr;

/// Records what kernels of namespace recording_kernel do on this thread during its lifetime.
struct Recording {
    Recording() { recorded_steps = &steps; }
    ~Recording() { recorded_steps = nullptr; }
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    std::vector<TraceStep> steps;
};

inline void begin_step(const char* file, int line, const char* paper, const char* sentence) {
    if (recorded_steps != nullptr) recorded_steps->push_back({file, line, paper, sentence, {}, {}});
}

inline void show_value(const char* name, decltype(TraceValue::value) value) {
    if (recorded_steps != nullptr && !recorded_steps->empty())
        recorded_steps->back().values.push_back({name, std::move(value), {}});
}
inline void show(const char* name, float value) { show_value(name, static_cast<double>(value)); }
inline void show(const char* name, int value) { show_value(name, std::int64_t{value}); }
inline void show(const char* name, std::uint32_t value) { show_value(name, std::int64_t{value}); }
inline void show(const char* name, bool value) { show_value(name, value); }
inline void show(const char* name, glm::vec3 value) { show_value(name, value); }

/// 32 bits, the first voxel first, in groups of four as in the paper's Figure 4. Words of one name follow each other.
inline void show_bits(const char* name, std::uint32_t word) {
    if (recorded_steps == nullptr || recorded_steps->empty()) return;
    std::string text;
    for (unsigned bit = 0; bit < 32; ++bit) {
        if (bit % 4 == 0 && bit != 0) text += ' ';
        text += (word >> bit) & 1u ? '1' : '0';
    }
    for (TraceValue& value : recorded_steps->back().values) {
        if (value.name != name) continue;
        std::get<std::string>(value.value) += ' ' + text;
        return;
    }
    recorded_steps->back().values.push_back({name, text, {}});
}

inline void show_shape(const char* name, TraceShape shape, std::vector<glm::vec3> points) {
    if (recorded_steps != nullptr && !recorded_steps->empty())
        recorded_steps->back().geometry.push_back({name, shape, std::move(points)});
}

}  // namespace sightlines::recording_kernel

#include "shaders/portability.h"

#endif
