// The marks that all views in space share: the ray and its ends, labels that keep off each other, orientation, scale,
// verdict. In the units of the canvas, so that they are pixels in a window and vectors on a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "techniques/scene/surface_buffer.h"
#include "visualizers/canvas.h"
#include "visualizers/theme.h"
#include "visualizers/view_camera.h"

namespace sightlines {

/// What marks are drawn on.
struct Sheet {
    Canvas& canvas;
    Palette colours;
    ViewCamera camera;
    float em = 12.0f;                ///< body text height
    std::vector<Rectangle> taken{};  ///< where labels must not go
};

/// printf with one number.
std::string text_of(const char* format, double value);

TextStyle label_style(const Sheet& sheet, vec3 colour, Font font = Font::sans);

/// Puts a label near its anchor where it covers no other: tries the eight directions, then further off, with a leader.
void place_label(Sheet& sheet, vec2 anchor, vec2 preferred, const std::string& text, const TextStyle& style);

/// A line with an outline in the page's colour, so that it stands off from whatever is behind.
void draw_world_line(Sheet& sheet, vec3 from, vec3 to, Stroke stroke);

/// Keeps labels off a line in the world: a chain of boxes.
void take_line(Sheet& sheet, vec3 from, vec3 to, float half_width);

/// The ray from the surface point to the light, and both ends.
void draw_ray(Sheet& sheet, const Segment& ray);
void label_ray(Sheet& sheet, const Segment& ray, const std::string& end_name = "light");

/// One more arrow beside those of the world's axes.
struct NamedAxis {
    vec3 direction{1.0f, 0.0f, 0.0f};  ///< unit
    const char* name = "";
};
void draw_orientation(Sheet& sheet, const std::optional<NamedAxis>& own);

/// A round number of metres at the focal point's distance, with a note below.
void draw_scale_bar(Sheet& sheet, const OrbitCamera& orbit, const std::string& note);

/// What became of a ray: in more words and in fewer.
struct Verdict {
    bool blocked = false;
    std::vector<std::string> sentences;  ///< the longest first
};
/// "BLOCKED" or "OPEN" and the first sentence that `width` has room for, from `at` to the right; gives the width used.
float draw_verdict(Canvas& canvas, const Verdict& verdict, const Palette& colours, vec2 at, float width,
                   float text_height);

}  // namespace sightlines
