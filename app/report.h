// What a render says about itself: report.json, and the short table on the terminal.
#pragma once

#include <optional>

#include "app/results.h"
#include "app/session.h"

namespace sightlines {

/// The share of a pixel's rays judged wrongly that the error picture shows brightest.
constexpr float visibility_error_shown = 0.5f;
/// The share of a pixel's rays changed by compression that its heat map shows brightest.
constexpr float compression_shown = 0.1f;

/// Everything that a report is made from, of one session.
struct RenderReport {
    Session session;
    Backend backend = Backend::cpu;
    Shared<Scene> scene;
    Shared<std::vector<Light>> lights;
    Shared<EnvironmentLight> environment;  ///< null where the technique is lit by lights
    Shared<BuiltStructure> structure;
    Shared<RenderResult> picture;
    Shared<RenderResult> reference;    ///< null without
    Shared<ErrorMetrics> errors;       ///< null without
    Shared<ErrorMetrics> compression;  ///< null unless the session's channel shows it
    double load_seconds = 0.0;         ///< file and scene, not the reference's hierarchy
};

/// Makes the picture, and the reference where the session asks for one.
RenderReport render_session(const Session& session, Results& results, Progress& progress);

/// The design's report.json: fields that do not apply are left out.
Json json_from_report(const RenderReport& report);

/// Aligned lines for a newcomer. `title` heads them.
std::string text_from_report(const RenderReport& report);

/// What the channels of a picture are drawn from. What is not known is null.
struct ChannelSource {
    const RenderResult* picture = nullptr;
    const RenderResult* reference = nullptr;
    const ErrorMetrics* errors = nullptr;
    std::size_t lights = 0;                     ///< that a pixel may ask at most (rays_per_pixel)
    const ErrorMetrics* compression = nullptr;  ///< Results::compression
};

/// Whether all is known that the channel is drawn from.
bool can_show(Channel channel, const ChannelSource& from);

/// The part `rect` of a channel as it is shown; the lit picture where the channel cannot be shown.
ImageRgba8 shown_channel(Channel channel, const Display& display, const ChannelSource& from, PixelRect rect);

/// The channel of the session as it is shown.
ImageRgba8 shown_channel(const RenderReport& report);

}  // namespace sightlines
