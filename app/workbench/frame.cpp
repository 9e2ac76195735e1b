#include "app/workbench/frame.h"

#include <algorithm>

#include "app/inside.h"

namespace sightlines {

ViewState inside_state(const Session& session) { return view_state(session, shown_figure(session)); }

void set_inside_state(Session& session, const ViewState& state) {
    if (state == inside_state(session)) return;
    const std::string_view figure = shown_figure(session);
    auto open = std::ranges::find(session.views, figure, &View::figure);
    if (open == session.views.end()) open = session.views.insert(open, View{std::string(figure), {}});
    open->state = state;
}

std::span<const TraceStep> recorded_steps(const Frame& frame) {
    if (!frame.shown.ray || frame.shown.ray_failure) return {};
    return frame.shown.ray->trace.steps;
}

std::size_t current_step(const Frame& frame) {
    const std::size_t count = recorded_steps(frame).size();
    return std::min<std::size_t>(frame.next.selection.step, count == 0 ? 0 : count - 1);
}

void go_to_step(Frame& frame, std::int64_t step) {
    const auto count = static_cast<std::int64_t>(recorded_steps(frame).size());
    if (count == 0) return;
    frame.next.selection.step = static_cast<std::uint32_t>(std::clamp<std::int64_t>(step, 0, count - 1));
}

bool ray_is_current(const Frame& frame) {
    const Selection& selected = frame.session.selection;
    return frame.shown.ray && (!selected.pixel || *selected.pixel == frame.shown.ray->pixel) &&
           (!selected.light || *selected.light == frame.shown.ray->light);
}

std::string ray_failure_text(const Frame& frame) {
    if (!frame.shown.ray_failure) return {};
    // The command line's flags mean nothing here: "--light: 17 stands" becomes "light 17 stands".
    const std::string& message = frame.shown.ray_failure->message;
    const std::size_t colon = message.find(": ");
    if (!message.starts_with("--") || colon == std::string::npos) return message;
    return message.substr(2, colon - 2) + message.substr(colon + 1);
}

void select_pixel(Frame& frame, ivec2 pixel) {
    frame.next.selection = {};
    frame.next.selection.pixel = pixel;
    set_inside_state(frame.next, reframed(inside_state(frame.next)));
}

void select_light(Frame& frame, std::uint32_t light) {
    // The pixel is named too: what was chosen automatically so far stays.
    if (frame.shown.rays) frame.next.selection.pixel = frame.shown.rays->pixel;
    frame.next.selection.light = light;
    frame.next.selection.voxel.reset();
    set_inside_state(frame.next, reframed(inside_state(frame.next)));
}

}  // namespace sightlines
