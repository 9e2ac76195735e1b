// A page or a picture to draw on: one set of drawing functions for PNG, SVG, PDF and pixels on screen (Cairo). Knows
// nothing of what is drawn; charts and tables use it too.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "techniques/base/image.h"

struct _cairo;
struct _cairo_surface;

namespace sightlines {

enum class CanvasFormat { pixels, png, svg, pdf };
enum class Font { sans, mono };  ///< Inter, JetBrains Mono; fontconfig's DejaVu where they are missing
enum class Align { left, centre, right };

struct CairoDeleter {
    void operator()(_cairo* context) const;
    void operator()(_cairo_surface* surface) const;
};

/// A text kept for the end of an SVG file, where it is written as text, not as outlines: searchable and editable.
struct KeptText {
    std::string svg;
};

/// Positions are in units from the top left corner: points (1/72 inch) on a page, pixels on a picture.
struct Canvas {
    CanvasFormat format = CanvasFormat::pixels;
    vec2 size{0.0f};                                   ///< units
    vec2 offset{0.0f};                                 ///< added to every position: where the part being drawn begins
    std::unique_ptr<std::vector<std::uint8_t>> bytes;  ///< what SVG and PDF have written so far
    std::unique_ptr<_cairo_surface, CairoDeleter> surface;
    std::unique_ptr<_cairo, CairoDeleter> context;
    std::vector<KeptText> texts;
};

/// An empty (transparent) page. `dpi` is the resolution of a PNG; SVG and PDF have none.
/// Throws InputError where the page is larger than Cairo can hold (32,767 pixels a side).
Canvas make_page_canvas(CanvasFormat format, vec2 size_points, float dpi);
/// The picture itself to draw on, one unit a pixel.
Canvas make_picture_canvas(const ImageRgba8& picture);

/// The whole file: PNG, SVG or PDF. The canvas is used up. EnvironmentError where Cairo ran out of memory.
std::vector<std::uint8_t> finished_file(Canvas& canvas);
/// The pixels (straight alpha) of a PNG page or a picture.
ImageRgba8 finished_picture(Canvas& canvas);

/// Colours are sRGB in [0, 1].
struct Stroke {
    vec3 colour{0.0f};
    float width = 1.0f;
    float alpha = 1.0f;
    float dash = 0.0f, gap = 0.0f;  ///< lengths; 0: solid
    bool round_ends = false;
};
void draw_line(Canvas& canvas, vec2 from, vec2 to, const Stroke& stroke);
void draw_path(Canvas& canvas, std::span<const vec2> points, bool closed, const Stroke& stroke);
void fill_path(Canvas& canvas, std::span<const vec2> points, vec3 colour, float alpha = 1.0f);

struct Rectangle {
    vec2 corner{0.0f}, size{0.0f};  ///< top left, extent

    bool overlaps(const Rectangle& other) const {
        return glm::all(glm::lessThan(corner, other.corner + other.size)) &&
               glm::all(glm::lessThan(other.corner, corner + size));
    }
};
void fill_rectangle(Canvas& canvas, const Rectangle& rectangle, vec3 colour, float alpha = 1.0f);
void draw_rectangle(Canvas& canvas, const Rectangle& rectangle, const Stroke& stroke);
void fill_circle(Canvas& canvas, vec2 centre, float radius, vec3 colour, float alpha = 1.0f);
void draw_circle(Canvas& canvas, vec2 centre, float radius, const Stroke& stroke);

struct TextStyle {
    float height = 9.0f;  ///< of the em, units
    vec3 colour{0.0f};
    Font font = Font::sans;
    bool bold = false;
    Align align = Align::left;
    std::optional<vec3> halo = {};  ///< an outline that keeps text readable on a picture
};
/// `at` is on the baseline.
void draw_text(Canvas& canvas, vec2 at, std::string_view text, const TextStyle& style);
/// Width as drawn, in units.
float text_width(Canvas& canvas, std::string_view text, const TextStyle& style);

/// Stretches the picture (straight alpha) over the rectangle.
void draw_picture(Canvas& canvas, const Rectangle& where, const ImageRgba8& picture);

}  // namespace sightlines
