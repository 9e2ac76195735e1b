#include "visualizers/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

constexpr int largest_side = 32767;  // Cairo's limit for pictures

void check(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) throw EnvironmentError("figure", cairo_status_to_string(status));
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
    auto& out = *static_cast<std::vector<std::uint8_t>*>(bytes);
    out.insert(out.end(), data, data + length);
    return CAIRO_STATUS_SUCCESS;
}

/// Cairo's pixels: premultiplied, one 32-bit word each, alpha highest.
std::uint32_t premultiplied(glm::u8vec4 pixel) {
    const auto times_alpha = [&](std::uint32_t channel) { return (channel * pixel.a + 127u) / 255u; };
    return std::uint32_t{pixel.a} << 24 | times_alpha(pixel.r) << 16 | times_alpha(pixel.g) << 8 | times_alpha(pixel.b);
}

glm::u8vec4 straight(std::uint32_t word) {
    const std::uint32_t alpha = word >> 24;
    if (alpha == 0) return glm::u8vec4(0);
    const auto over_alpha = [&](std::uint32_t channel) {
        return static_cast<std::uint8_t>(std::min((channel * 255u + alpha / 2u) / alpha, 255u));
    };
    return {over_alpha(word >> 16 & 255u), over_alpha(word >> 8 & 255u), over_alpha(word & 255u),
            static_cast<std::uint8_t>(alpha)};
}

using Surface = std::unique_ptr<_cairo_surface, CairoDeleter>;

Surface image_surface(ImageSize size) {
    if (size.width < 1 || size.height < 1 || size.width > largest_side || size.height > largest_side)
        throw InputError("figure", "size",
                         std::to_string(size.width) + " x " + std::to_string(size.height) +
                             " pixels is not between 1 and " + std::to_string(largest_side) + " a side",
                         "ask for fewer dots per inch or a smaller page");
    Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, size.width, size.height));
    check(cairo_surface_status(surface.get()));
    return surface;
}

Surface surface_of(const ImageRgba8& picture) {
    Surface surface = image_surface(picture.size);
    cairo_surface_flush(surface.get());
    unsigned char* const data = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
    for (int y = 0; y < picture.size.height; ++y)
        for (int x = 0; x < picture.size.width; ++x) {
            const std::uint32_t word = premultiplied(picture.at(x, y));
            std::memcpy(data + static_cast<std::size_t>(y) * stride + 4 * static_cast<std::size_t>(x), &word, 4);
        }
    cairo_surface_mark_dirty(surface.get());
    return surface;
}

void set_colour(Canvas& canvas, vec3 colour, float alpha) {
    cairo_set_source_rgba(canvas.context.get(), colour.r, colour.g, colour.b, alpha);
}

void stroke_path(Canvas& canvas, const Stroke& stroke) {
    cairo_t* const context = canvas.context.get();
    set_colour(canvas, stroke.colour, stroke.alpha);
    cairo_set_line_width(context, stroke.width);
    cairo_set_line_cap(context, stroke.round_ends ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    const std::array<double, 2> dashes{stroke.dash, stroke.gap};
    cairo_set_dash(context, dashes.data(), stroke.dash > 0.0f ? 2 : 0, 0.0);
    cairo_stroke(context);
}

void trace(Canvas& canvas, std::span<const vec2> points, bool closed) {
    cairo_new_path(canvas.context.get());
    for (const vec2& point : points)
        cairo_line_to(canvas.context.get(), point.x + canvas.offset.x, point.y + canvas.offset.y);
    if (closed) cairo_close_path(canvas.context.get());
}

void set_font(Canvas& canvas, const TextStyle& style) {
    cairo_select_font_face(canvas.context.get(), style.font == Font::sans ? "Inter" : "JetBrains Mono",
                           CAIRO_FONT_SLANT_NORMAL, style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(canvas.context.get(), style.height);
}

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) >= 0x20)
            out += c;
    }
    return out;
}

std::string hex(vec3 colour) {
    const glm::ivec3 c(glm::clamp(colour, 0.0f, 1.0f) * 255.0f + 0.5f);
    std::array<char, 8> out{};
    std::snprintf(out.data(), out.size(), "#%02X%02X%02X", static_cast<unsigned>(c.r) & 255u,
                  static_cast<unsigned>(c.g) & 255u, static_cast<unsigned>(c.b) & 255u);
    return out.data();
}

std::string number(float value) {
    std::array<char, 32> out{};
    std::snprintf(out.data(), out.size(), "%.2f", static_cast<double>(value));
    return out.data();
}

std::string svg_text(vec2 at, std::string_view text, const TextStyle& style) {
    const char* const anchor = style.align == Align::left ? "start" : style.align == Align::centre ? "middle" : "end";
    const char* const family = style.font == Font::sans ? "Inter, 'DejaVu Sans', sans-serif"
                                                        : "'JetBrains Mono', 'DejaVu Sans Mono', monospace";
    std::string out = "<text x=\"" + number(at.x) + "\" y=\"" + number(at.y) + "\" font-family=\"" + family +
                      "\" font-size=\"" + number(style.height) + "\" text-anchor=\"" + anchor + "\" fill=\"" +
                      hex(style.colour) + "\"";
    if (style.bold) out += " font-weight=\"bold\"";
    if (style.halo)
        out += " stroke=\"" + hex(*style.halo) + "\" stroke-width=\"" + number(0.28f * style.height) +
               "\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
    return out + ">" + escaped(text) + "</text>\n";
}

/// Cairo numbers what an SVG defines through the whole process ("image162"); from one in each file, the same figure is
/// the same file. Inside the base64 of a picture there is no quote and no hash, so nothing else is touched.
void renumber_svg(std::vector<std::uint8_t>& bytes) {
    const std::string_view old(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::map<std::string_view, std::size_t> numbers;
    std::string out;
    std::size_t copied = 0;
    for (std::size_t at = old.find_first_of("\"#"); at != std::string_view::npos;
         at = old.find_first_of("\"#", at + 1)) {
        const std::size_t digits = old.find_first_not_of("abcdefghijklmnopqrstuvwxyz", at + 1);
        const std::size_t end = old.find_first_not_of("0123456789", digits);
        if (digits == at + 1 || end == std::string_view::npos || end == digits) continue;
        if (old[end] != '"' && old[end] != ')') continue;
        const std::size_t number =
            numbers.try_emplace(old.substr(at + 1, end - at - 1), numbers.size() + 1).first->second;
        out.append(old.substr(copied, digits - copied)).append(std::to_string(number));
        copied = end;
    }
    out.append(old.substr(copied));
    bytes.assign(out.begin(), out.end());
}

/// Cairo turns text into outlines in SVG; ours goes in as text, on top of everything else.
void add_kept_texts(Canvas& canvas) {
    static constexpr std::string_view end_tag = "</svg>";
    std::vector<std::uint8_t>& bytes = *canvas.bytes;
    const auto end = std::find_end(bytes.begin(), bytes.end(), end_tag.begin(), end_tag.end());
    std::string texts;
    for (const KeptText& text : canvas.texts) texts += text.svg;
    bytes.insert(end, texts.begin(), texts.end());
}

}  // namespace

void CairoDeleter::operator()(_cairo* context) const { cairo_destroy(context); }
void CairoDeleter::operator()(_cairo_surface* surface) const { cairo_surface_destroy(surface); }

Canvas make_page_canvas(CanvasFormat format, vec2 size_points, float dpi) {
    Canvas canvas;
    canvas.format = format;
    canvas.size = size_points;
    canvas.bytes = std::make_unique<std::vector<std::uint8_t>>();
    const auto width = static_cast<double>(size_points.x), height = static_cast<double>(size_points.y);
    if (format == CanvasFormat::svg) {
        canvas.surface.reset(cairo_svg_surface_create_for_stream(append, canvas.bytes.get(), width, height));
    } else if (format == CanvasFormat::pdf) {
        canvas.surface.reset(cairo_pdf_surface_create_for_stream(append, canvas.bytes.get(), width, height));
        // Without the date, so that the same figure is the same file.
        cairo_pdf_surface_set_metadata(canvas.surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    } else {
        const vec2 pixels = glm::min(glm::round(size_points * dpi / 72.0f), vec2(1e6f));
        canvas.surface = image_surface({static_cast<int>(pixels.x), static_cast<int>(pixels.y)});
    }
    check(cairo_surface_status(canvas.surface.get()));
    canvas.context.reset(cairo_create(canvas.surface.get()));
    check(cairo_status(canvas.context.get()));
    if (format == CanvasFormat::png) cairo_scale(canvas.context.get(), dpi / 72.0, dpi / 72.0);
    return canvas;
}

Canvas make_picture_canvas(const ImageRgba8& picture) {
    Canvas canvas;
    canvas.size = vec2(picture.size.width, picture.size.height);
    canvas.surface = surface_of(picture);
    canvas.context.reset(cairo_create(canvas.surface.get()));
    check(cairo_status(canvas.context.get()));
    return canvas;
}

std::vector<std::uint8_t> finished_file(Canvas& canvas) {
    check(cairo_status(canvas.context.get()));
    if (canvas.format == CanvasFormat::png || canvas.format == CanvasFormat::pixels) {
        std::vector<std::uint8_t> bytes;
        check(cairo_surface_write_to_png_stream(canvas.surface.get(), append, &bytes));
        return bytes;
    }
    cairo_show_page(canvas.context.get());
    canvas.context.reset();
    cairo_surface_finish(canvas.surface.get());
    check(cairo_surface_status(canvas.surface.get()));
    if (canvas.format == CanvasFormat::svg) {
        renumber_svg(*canvas.bytes);
        add_kept_texts(canvas);
    }
    return std::move(*canvas.bytes);
}

ImageRgba8 finished_picture(Canvas& canvas) {
    check(cairo_status(canvas.context.get()));
    cairo_surface_flush(canvas.surface.get());
    const unsigned char* const data = cairo_image_surface_get_data(canvas.surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(canvas.surface.get()));
    ImageRgba8 picture(
        {cairo_image_surface_get_width(canvas.surface.get()), cairo_image_surface_get_height(canvas.surface.get())});
    for (int y = 0; y < picture.size.height; ++y)
        for (int x = 0; x < picture.size.width; ++x) {
            std::uint32_t word = 0;
            std::memcpy(&word, data + static_cast<std::size_t>(y) * stride + 4 * static_cast<std::size_t>(x), 4);
            picture.at(x, y) = straight(word);
        }
    return picture;
}

void draw_line(Canvas& canvas, vec2 from, vec2 to, const Stroke& stroke) {
    const std::array<vec2, 2> ends{from, to};
    draw_path(canvas, ends, false, stroke);
}

void draw_path(Canvas& canvas, std::span<const vec2> points, bool closed, const Stroke& stroke) {
    trace(canvas, points, closed);
    stroke_path(canvas, stroke);
}

void fill_path(Canvas& canvas, std::span<const vec2> points, vec3 colour, float alpha) {
    trace(canvas, points, true);
    set_colour(canvas, colour, alpha);
    cairo_fill(canvas.context.get());
}

void fill_rectangle(Canvas& canvas, const Rectangle& rectangle, vec3 colour, float alpha) {
    const vec2 corner = rectangle.corner + canvas.offset;
    cairo_rectangle(canvas.context.get(), corner.x, corner.y, rectangle.size.x, rectangle.size.y);
    set_colour(canvas, colour, alpha);
    cairo_fill(canvas.context.get());
}

void draw_rectangle(Canvas& canvas, const Rectangle& rectangle, const Stroke& stroke) {
    const vec2 corner = rectangle.corner + canvas.offset;
    cairo_rectangle(canvas.context.get(), corner.x, corner.y, rectangle.size.x, rectangle.size.y);
    stroke_path(canvas, stroke);
}

void fill_circle(Canvas& canvas, vec2 centre, float radius, vec3 colour, float alpha) {
    cairo_new_path(canvas.context.get());
    cairo_arc(canvas.context.get(), centre.x + canvas.offset.x, centre.y + canvas.offset.y, radius, 0.0,
              6.283185307179586);
    set_colour(canvas, colour, alpha);
    cairo_fill(canvas.context.get());
}

void draw_circle(Canvas& canvas, vec2 centre, float radius, const Stroke& stroke) {
    cairo_new_path(canvas.context.get());
    cairo_arc(canvas.context.get(), centre.x + canvas.offset.x, centre.y + canvas.offset.y, radius, 0.0,
              6.283185307179586);
    stroke_path(canvas, stroke);
}

void draw_text(Canvas& canvas, vec2 at, std::string_view text, const TextStyle& style) {
    at += canvas.offset;
    if (canvas.format == CanvasFormat::svg) {
        canvas.texts.push_back({svg_text(at, text, style)});
        return;
    }
    cairo_t* const context = canvas.context.get();
    const float width = style.align == Align::left ? 0.0f : text_width(canvas, text, style);
    const std::string terminated(text);
    set_font(canvas, style);
    const double x = at.x - (style.align == Align::centre ? 0.5f : style.align == Align::right ? 1.0f : 0.0f) * width;
    if (style.halo) {
        cairo_move_to(context, x, at.y);
        cairo_text_path(context, terminated.c_str());
        stroke_path(canvas, {.colour = *style.halo, .width = 0.28f * style.height, .round_ends = true});
    }
    cairo_move_to(context, x, at.y);
    set_colour(canvas, style.colour, 1.0f);
    cairo_show_text(context, terminated.c_str());
    cairo_new_path(context);
}

float text_width(Canvas& canvas, std::string_view text, const TextStyle& style) {
    set_font(canvas, style);
    cairo_text_extents_t extents;
    cairo_text_extents(canvas.context.get(), std::string(text).c_str(), &extents);
    return static_cast<float>(extents.x_advance);
}

void draw_picture(Canvas& canvas, const Rectangle& where, const ImageRgba8& picture) {
    const Surface surface = surface_of(picture);
    cairo_t* const context = canvas.context.get();
    cairo_save(context);
    cairo_translate(context, where.corner.x + canvas.offset.x, where.corner.y + canvas.offset.y);
    cairo_rectangle(context, 0.0, 0.0, where.size.x, where.size.y);
    cairo_clip(context);
    cairo_scale(context, where.size.x / static_cast<double>(picture.size.width),
                where.size.y / static_cast<double>(picture.size.height));
    cairo_set_source_surface(context, surface.get(), 0.0, 0.0);
    cairo_paint(context);
    cairo_restore(context);
}

}  // namespace sightlines
