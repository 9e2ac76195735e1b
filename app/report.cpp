#include "app/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/table.h"
#include "techniques/base/huge_buffer.h"

namespace sightlines {
namespace {

double rays_per_second(const RenderResult& picture) {
    return picture.seconds > 0.0 ? static_cast<double>(picture.rays) / picture.seconds : 0.0;
}

/// Share of the asked rays that are blocked, in percent.
double blocked_percent(const RenderResult& picture) {
    double blocked = 0.0, asked = 0.0;
    for (std::size_t p = 0; p < picture.rays_asked.pixels.size(); ++p) {
        const auto rays = static_cast<double>(picture.rays_asked.pixels[p]);
        asked += rays;
        blocked += rays * static_cast<double>(picture.shadow.pixels[p]);
    }
    return asked > 0.0 ? 100.0 * blocked / asked : 0.0;
}

std::string_view backend_name(Backend backend) { return backend == Backend::vulkan ? "vulkan" : "cpu"; }

/// Every parameter with the value that was used, as people write it.
Json all_parameters(const Session& session) {
    Json all = Json::object();
    const auto table = find_technique(session.technique).parameters;
    for (const Parameter& row : table) {
        const double value = parameter_value(table, technique_parameters(session), row.name);
        const std::string name(row.name);
        switch (row.kind) {
            case ParameterKind::boolean:
                all[name] = value != 0.0;
                break;
            case ParameterKind::choice:
                all[name] = parameter_text(row, value);
                break;
            case ParameterKind::integer:
                all[name] = static_cast<std::int64_t>(value);
                break;
            case ParameterKind::real:
                all[name] = value;
                break;
        }
    }
    return all;
}

template <class Pixel>
Image<Pixel> cropped(const Image<Pixel>& image, PixelRect rect) {
    Image<Pixel> part(ImageSize{rect.width, rect.height});
    for (int y = 0; y < rect.height; ++y) std::copy_n(&image.at(rect.x, rect.y + y), rect.width, &part.at(0, y));
    return part;
}

/// `show` of a part of an image, without a copy where that is all of it.
template <class Pixel, class Show>
ImageRgba8 part_shown(const Image<Pixel>& image, PixelRect rect, const Show& show) {
    const bool whole = rect == PixelRect{0, 0, image.size.width, image.size.height};
    return whole ? show(image) : show(cropped(image, rect));
}

/// Rays by Embree; those of a technique that counts none are all or nothing.
ImageRgba8 traced_shown(const RenderResult& picture, PixelRect rect, std::size_t most) {
    ImageScalar counts(ImageSize{rect.width, rect.height});
    const bool all = picture.rays_traced > 0 && picture.rays_traced == picture.rays;
    if (!picture.traced.pixels.empty() || all) {
        const auto traced = cropped(picture.traced.pixels.empty() ? picture.rays_asked : picture.traced, rect);
        std::ranges::copy(traced.pixels, counts.pixels.begin());
    }
    return colour_mapped(counts, 0.0f, static_cast<float>(most));
}

ImageRgba8 counts_shown(const RenderResult& picture, PixelRect rect, std::size_t lights, bool seen_only) {
    const auto asked = cropped(picture.rays_asked, rect);
    const ImageScalar shadow = cropped(picture.shadow, rect);
    ImageScalar counts(asked.size);
    for (std::size_t p = 0; p < counts.pixels.size(); ++p)
        counts.pixels[p] = static_cast<float>(asked.pixels[p]) * (seen_only ? 1.0f - shadow.pixels[p] : 1.0f);
    return colour_mapped(counts, 0.0f, static_cast<float>(lights));
}

}  // namespace

RenderReport render_session(const Session& session, Results& results, Progress& progress) {
    RenderReport report;
    report.session = session;
    report.backend = results.backend(session);
    const auto model = results.model(session, progress);
    report.scene = results.scene(session, progress);
    report.load_seconds = model->seconds + report.scene->seconds;
    session_camera(session, report.scene->value);  // a wrong camera is refused before the long work
    report.lights = results.lights(session, progress);
    if (lit_by_environment(session)) report.environment = results.environment(session, progress);
    report.picture = results.picture(session, progress);
    report.structure = results.structure(session, progress);
    if (needs_reference(session)) {
        report.reference = results.reference(session, progress);
        report.errors = results.errors(session, progress);
    }
    if (session.channel == Channel::compression) report.compression = results.compression(session, progress);
    return report;
}

Json json_from_report(const RenderReport& report) {
    const RenderResult& picture = report.picture->value;
    const Statistics& statistics = report.structure->value.statistics;
    Json json = {{"technique", report.session.technique},
                 {"scene", report.session.scene},
                 {"time_s", report.session.time_s},
                 {"triangles", report.scene->value.triangles.size()},
                 {"lights", report.lights->value.size()},
                 {"size", {report.session.size.width, report.session.size.height}},
                 {"backend", backend_name(report.backend)},
                 {"device", picture.device},
                 {"seed", report.session.seed},
                 {"parameters", all_parameters(report.session)}};
    if (report.environment) {
        json["samples"] = rays_per_pixel(report.session, report.lights->value);
        json["environment"] = {{"name", report.environment->value.map->name},
                               {"turn_deg", report.environment->value.turn_deg}};
    }
    json["seconds"] = {{"load", report.load_seconds}, {"build", statistics.build_seconds}, {"render", picture.seconds}};
    if (statistics.compress_seconds > 0.0) json["seconds"]["compress"] = statistics.compress_seconds;
    json["rays"] = {{"asked", picture.rays}, {"traced", picture.rays_traced}};
    json["mrays_per_second"] = 1e-6 * rays_per_second(picture);
    json["blocked_percent"] = blocked_percent(picture);
    json["memory_bytes"] = {{"structure", statistics.structure_bytes},
                            {"uncompressed", statistics.uncompressed_bytes},
                            {"peak", peak_memory_bytes()}};
    if (report.errors) {
        const ErrorMetrics& errors = report.errors->value;
        json["seconds"]["reference"] = report.reference->value.seconds;
        json["error"] = {{"visibility_percent", errors.visibility_percent},
                         {"shadow_percent", errors.shadow_percent},
                         {"rmse", errors.rmse},
                         {"max_abs", errors.max_abs}};
    }
    if (report.compression) json["compression_changed_percent"] = report.compression->value.visibility_percent;
    return json;
}

std::string text_from_report(const RenderReport& report) {
    const RenderResult& picture = report.picture->value;
    const Statistics& statistics = report.structure->value.statistics;
    const Session& session = report.session;
    TextTable table;
    const auto line = [&](const std::string& name, const std::string& value) { table.rows.push_back({name, value}); };
    line("technique", std::string(find_technique(session.technique).title));
    line("scene", session.scene + ", " + count_text(report.scene->value.triangles.size()) + " triangles, loaded in " +
                      seconds_text(report.load_seconds));
    line("picture", std::to_string(session.size.width) + " x " + std::to_string(session.size.height) + " pixels, " +
                        count_text(rays_per_pixel(session, report.lights->value)) +
                        (report.environment ? " samples of " + report.environment->value.map->name : " lights"));
    line("device", picture.device);
    line("structure", bytes_text(statistics.structure_bytes) + ", built in " + seconds_text(statistics.build_seconds));
    if (statistics.compress_seconds > 0.0)
        line("compressed",
             "from " + bytes_text(statistics.uncompressed_bytes) + " in " + seconds_text(statistics.compress_seconds));
    line("shadow rays", count_text(picture.rays) + " in " + seconds_text(picture.seconds) + " (" +
                            rate_text(rays_per_second(picture)) + "), " + percent_text(blocked_percent(picture)) +
                            " blocked");
    if (report.environment)
        line("traced", count_text(picture.rays_traced) + " of these (" +
                           percent_text(picture.rays > 0 ? 100.0 * static_cast<double>(picture.rays_traced) /
                                                               static_cast<double>(picture.rays)
                                                         : 0.0) +
                           "); the rest is known from the structure");
    if (report.errors) {
        const ErrorMetrics& errors = report.errors->value;
        const RenderResult& truth = report.reference->value;
        line("Embree", "the same rays in " + seconds_text(truth.seconds) + " (" + rate_text(rays_per_second(truth)) +
                           "), " + percent_text(blocked_percent(truth)) + " blocked");
        line("visibility error", percent_text(errors.visibility_percent) + " of the rays judged wrongly");
        line("shadow error", percent_text(errors.shadow_percent) + " mean difference of a pixel's shadow");
        line("radiance error", "RMSE " + fixed_text(errors.rmse, 4) + ", at most " + fixed_text(errors.max_abs, 4));
    }
    if (report.compression)
        line("compression",
             "changed " + percent_text(report.compression->value.visibility_percent) + " of the rays' answers");
    line("peak memory", bytes_text(peak_memory_bytes()));
    return text_from(table);
}

bool can_show(Channel channel, const ChannelSource& from) {
    if (channel == Channel::compression) return from.compression != nullptr;
    const bool compares = channel == Channel::visibility_error || channel == Channel::shadow_error;
    return compares ? from.errors != nullptr : channel != Channel::reference || from.reference != nullptr;
}

ImageRgba8 shown_channel(Channel channel, const Display& display, const ChannelSource& from, PixelRect rect) {
    const auto mapped = [](float low, float high) {
        return [low, high](const ImageScalar& values) { return colour_mapped(values, low, high); };
    };
    const auto lit = [&](const ImageRgb& radiance) { return shown(radiance, display); };
    if (can_show(channel, from)) switch (channel) {
            case Channel::lit:
                break;
            case Channel::reference:
                return part_shown(from.reference->radiance, rect, lit);
            case Channel::shadow:
                return part_shown(from.picture->shadow, rect, mapped(0.0f, 1.0f));
            case Channel::visibility_error:
                return part_shown(from.errors->visibility_error, rect, mapped(0.0f, visibility_error_shown));
            case Channel::shadow_error:
                return part_shown(from.errors->shadow_error, rect, mapped(-1.0f, 1.0f));
            case Channel::compression:
                return part_shown(from.compression->visibility_error, rect, mapped(0.0f, compression_shown));
            case Channel::rays:
                return counts_shown(*from.picture, rect, from.lights, false);
            case Channel::lights_seen:
                return counts_shown(*from.picture, rect, from.lights, true);
            case Channel::rays_traced:
                return traced_shown(*from.picture, rect, from.lights);
        }
    return part_shown(from.picture->radiance, rect, lit);
}

ImageRgba8 shown_channel(const RenderReport& report) {
    const RenderResult& picture = report.picture->value;
    const ChannelSource from{&picture, report.reference ? &report.reference->value : nullptr,
                             report.errors ? &report.errors->value : nullptr,
                             rays_per_pixel(report.session, report.lights->value),
                             report.compression ? &report.compression->value : nullptr};
    const ImageSize size = picture.radiance.size;
    return shown_channel(report.session.channel, report.session.display, from, {0, 0, size.width, size.height});
}

}  // namespace sightlines
