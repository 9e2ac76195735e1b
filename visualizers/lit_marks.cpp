#include "visualizers/lit_marks.h"

#include <algorithm>
#include <array>

namespace sightlines {
namespace {

/// How one piece of geometry is drawn.
struct Pen {
    Canvas& canvas;
    const ViewCamera& camera;
    Stroke halo, line;
    float ring_radius = 5.0f;
};

void draw_segment(const Pen& pen, vec3 from, vec3 to) {
    const auto ends = projected_segment(pen.camera, from, to);
    if (!ends) return;
    draw_line(pen.canvas, ends->from, ends->to, pen.halo);
    draw_line(pen.canvas, ends->from, ends->to, pen.line);
}

void draw_point(const Pen& pen, vec3 point) {
    const auto at = projected(pen.camera, point);
    if (!at) return;
    draw_circle(pen.canvas, vec2(*at), pen.ring_radius, pen.halo);
    draw_circle(pen.canvas, vec2(*at), pen.ring_radius, pen.line);
}

bool is_whole(const TraceGeometry& geometry) {
    const std::size_t needed = geometry.shape == TraceShape::point ? 1 : geometry.shape == TraceShape::segment ? 2 : 4;
    return geometry.points.size() >= needed;
}

void draw_geometry(const Pen& pen, const TraceGeometry& geometry) {
    switch (geometry.shape) {
        case TraceShape::point:
            return draw_point(pen, geometry.points[0]);
        case TraceShape::segment:
            return draw_segment(pen, geometry.points[0], geometry.points[1]);
        case TraceShape::box:
            return for_each_edge(geometry.points, [&](vec3 from, vec3 to) { draw_segment(pen, from, to); });
    }
}

vec3 middle_of(const TraceGeometry& geometry) {
    switch (geometry.shape) {
        case TraceShape::point:
            break;
        case TraceShape::segment:
            return 0.5f * (geometry.points[0] + geometry.points[1]);
        case TraceShape::box:
            return geometry.points[0] + 0.5f * (geometry.points[1] + geometry.points[2] + geometry.points[3]);
    }
    return geometry.points[0];
}

/// "span.first" and "light_end" as a label says them.
std::string label_of(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

/// The name beside the middle, on a ground that hides what is behind; inside the picture.
void draw_name(Canvas& canvas, const ViewCamera& camera, const TraceGeometry& geometry, const Palette& colours,
               float em) {
    const auto middle = projected(camera, middle_of(geometry));
    if (!middle) return;
    const TextStyle style{.height = em, .colour = colours.ink, .bold = true};
    const std::string text = label_of(geometry.name);
    const vec2 size{text_width(canvas, text, style) + 0.9f * em, 1.6f * em};
    const vec2 most = vec2(camera.size.width, camera.size.height) - size - 0.3f * em;
    const vec2 corner = glm::clamp(vec2(*middle) + vec2(0.9f * em, -2.3f * em), vec2(0.3f * em), glm::max(most, 0.0f));
    fill_rectangle(canvas, {corner, size}, colours.page, 0.92f);
    draw_rectangle(canvas, {corner, size}, {.colour = colours.pointed, .width = 0.1f * em});
    draw_text(canvas, corner + vec2(0.45f * em, 1.14f * em), text, style);
}

float distance_to_segment(vec2 point, const ProjectedSegment& segment) {
    const vec2 along = segment.to - segment.from;
    const float length_squared = glm::dot(along, along);
    const float at =
        length_squared > 0.0f ? std::clamp(glm::dot(point - segment.from, along) / length_squared, 0.0f, 1.0f) : 0.0f;
    return glm::length(point - (segment.from + at * along));
}

}  // namespace

void draw_lit(Canvas& canvas, const ViewCamera& camera, std::span<const TraceGeometry> geometry, const Palette& colours,
              float text_scale, Emphasis emphasis) {
    const float em = 12.0f * text_scale;
    const bool strong = emphasis == Emphasis::pointed;
    for (const TraceGeometry& piece : geometry) {
        if (!is_whole(piece)) continue;
        // A box has four lines side by side: as thick as single ones they would hide what is in it.
        const float strong_width = piece.shape == TraceShape::box ? 0.17f : 0.3f;
        Pen pen{canvas, camera, {}, {}, strong ? 0.62f * em : 0.5f * em};
        pen.line = {.colour = colours.pointed,
                    .width = (strong ? strong_width : 0.11f) * em,
                    .alpha = strong ? 1.0f : 0.85f,
                    .round_ends = true};
        pen.halo = {.colour = colours.page,
                    .width = pen.line.width + (strong ? 0.8f * strong_width : 0.12f) * em,
                    .alpha = strong ? 0.9f : 0.5f,
                    .round_ends = true};
        draw_geometry(pen, piece);
    }
    if (!strong) return;
    for (const TraceGeometry& piece : geometry)
        if (is_whole(piece)) draw_name(canvas, camera, piece, colours, em);
}

std::optional<float> distance_pixels(const ViewCamera& camera, const TraceGeometry& geometry, vec2 pixel) {
    if (!is_whole(geometry)) return std::nullopt;
    if (geometry.shape == TraceShape::point) {
        const auto at = projected(camera, geometry.points[0]);
        return at ? std::optional(glm::length(vec2(*at) - pixel)) : std::nullopt;
    }
    if (geometry.shape == TraceShape::box) return std::nullopt;
    const auto ends = projected_segment(camera, geometry.points[0], geometry.points[1]);
    return ends ? std::optional(distance_to_segment(pixel, *ends)) : std::nullopt;
}

}  // namespace sightlines
