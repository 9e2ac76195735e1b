#include "visualizers/figure.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "visualizers/bit_strip.h"
#include "visualizers/dictionary_panel.h"
#include "visualizers/lit_marks.h"
#include "visualizers/mask_merging.h"
#include "visualizers/theme.h"
#include "visualizers/voxel_row_marks.h"
#include "visualizers/vtk_export.h"

namespace sightlines {
namespace {

constexpr float points_per_mm = 72.0f / 25.4f;
constexpr float text_height = 7.5f;  // points, as a paper's captions
constexpr float margin = 10.0f;
constexpr float largest_width_pixels = 16000.0f;  // OpenGL's framebuffers end at 16384
constexpr int supersampled_width = 4096;          // above, pixels are finer than any print needs

void check_options(const FigureOptions& options) {
    if (!(options.dpi >= 36.0f && options.dpi <= 1200.0f))
        throw InputError("figure", "dpi", "must be between 36 and 1200", "300 suits print");
    if (!(options.width_mm >= 60.0f && options.width_mm <= 1000.0f))
        throw InputError("figure", "width", "must be between 60 and 1000 mm", "180 is a paper's two columns");
    if (options.width_mm / 25.4f * options.dpi > largest_width_pixels)
        throw InputError("figure", "size", "is more than 16,000 pixels wide", "ask for fewer dots per inch");
}

std::string where_text(const VoxelRowPicture& picture) {
    std::array<char, 128> out{};
    std::snprintf(out.data(), out.size(), "row v %d, w %d at \u03b8 %.4g\u00b0, \u03c6 %.4g\u00b0 of %d\u00b3 voxels",
                  picture.v, picture.w, static_cast<double>(picture.theta_deg), static_cast<double>(picture.phi_deg),
                  picture.resolution);
    return out.data();
}

/// Everything below the picture, `width` wide; gives its height.
float draw_panel(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, float top, float width) {
    const Palette colours = palette(state.theme);
    const float em = text_height, inner = width - 2.0f * margin;
    float y = top + 2.0f * em;
    const float used = draw_verdict(canvas, picture, state, {margin, y}, inner, em);
    const TextStyle where_style{.height = em, .colour = colours.muted, .align = Align::right};
    const std::string where = where_text(picture);
    if (used + text_width(canvas, where, where_style) + 2.0f * em > inner) y += 1.8f * em;
    draw_text(canvas, {width - margin, y}, where, where_style);
    y += 3.2f * em;
    draw_bit_strip(canvas, picture, state, {{margin, y}, {inner, 2.0f * em}}, em);
    y += 4.9f * em;
    const float wedge = state.ray && state.twin ? 17.0f * em : 0.0f;
    if (wedge > 0.0f)
        draw_angle_wedge(canvas, picture, state,
                         {{width - margin - wedge + 2.0f * em, y - 0.5f * em}, {wedge - 2.0f * em, 2.6f * em}}, em);
    const float legend = draw_voxel_row_legend(canvas, picture, state, {margin, y}, inner - wedge, em);
    return y + std::max(legend, wedge > 0.0f ? 3.0f * em : 0.0f) + 0.6f * margin - top;
}

/// A page with the view in space above and a panel below.
struct Page {
    Canvas canvas;
    ImageSize in_space;  ///< points
    ImageSize pixels;    ///< of the view in space, as it is rendered
    Rectangle panel;
};

float page_width(const FigureOptions& options) { return std::round(options.width_mm * points_per_mm); }

Page make_page(CanvasFormat format, const ViewState& state, const FigureOptions& options, float aspect, float panel) {
    const float width = page_width(options), height = std::round(aspect * width), scale = options.dpi / 72.0f;
    Page page{make_page_canvas(format, {width, std::ceil(height + panel)}, options.dpi),
              {static_cast<int>(width), static_cast<int>(height)},
              {static_cast<int>(std::round(width * scale)), static_cast<int>(std::round(height * scale))},
              {{0.0f, height}, {width, panel}}};
    if (state.theme != Theme::print)
        fill_rectangle(page.canvas, {{0.0f, 0.0f}, page.canvas.size}, palette(state.theme).page);
    return page;
}

template <class View, class Picture>
void draw_solid(Page& page, View& view, const Picture& picture, const ViewState& state) {
    draw_picture(page.canvas, {{0.0f, 0.0f}, page.panel.corner + vec2(page.panel.size.x, 0.0f)},
                 render_solid(view, picture, state, page.pixels, page.pixels.width > supersampled_width ? 1 : 2));
}

/// Between the view and the panel.
void draw_rule(Page& page, const ViewState& state) {
    draw_line(page.canvas, page.panel.corner, page.panel.corner + vec2(page.panel.size.x, 0.0f),
              {.colour = palette(state.theme).hairline, .width = 0.5f});
}

}  // namespace

FigureFormat parse_figure_format(const std::string& text) {
    constexpr std::array<std::pair<std::string_view, FigureFormat>, 4> formats{{{"png", FigureFormat::png},
                                                                                {"svg", FigureFormat::svg},
                                                                                {"pdf", FigureFormat::pdf},
                                                                                {"vtk", FigureFormat::vtk}}};
    for (const auto& [name, format] : formats)
        if (text == name) return format;
    throw InputError("--format", text, "is not a format of this figure", "it can be png, svg, pdf or vtk");
}

std::vector<std::uint8_t> voxel_row_figure(VoxelRowView& view, const VoxelRowPicture& picture, const ViewState& state,
                                           CanvasFormat format, const FigureOptions& options) {
    check_options(options);
    const float width = std::round(options.width_mm * points_per_mm);
    const ImageSize view_points{static_cast<int>(width), static_cast<int>(std::round(0.54f * width))};
    const float scale = options.dpi / 72.0f;
    const ImageSize view_pixels{static_cast<int>(std::round(static_cast<float>(view_points.width) * scale)),
                                static_cast<int>(std::round(static_cast<float>(view_points.height) * scale))};
    // The panel's height depends on how its text wraps: measured on a page that is thrown away.
    Canvas trial = make_page_canvas(CanvasFormat::png, {8.0f, 8.0f}, 72.0f);
    const float panel = draw_panel(trial, picture, state, 0.0f, width);

    Canvas canvas =
        make_page_canvas(format, {width, std::ceil(static_cast<float>(view_points.height) + panel)}, options.dpi);
    if (state.theme != Theme::print) fill_rectangle(canvas, {{0.0f, 0.0f}, canvas.size}, palette(state.theme).page);
    const Rectangle view_place{{0.0f, 0.0f}, vec2(view_points.width, view_points.height)};
    draw_picture(canvas, view_place,
                 render_solid(view, picture, state, view_pixels, view_pixels.width > supersampled_width ? 1 : 2));
    draw_voxel_row_marks(canvas, picture, state, view_points, text_height / 12.0f, MarksKey::none);
    draw_line(canvas, {0.0f, view_place.size.y}, {width, view_place.size.y},
              {.colour = palette(state.theme).hairline, .width = 0.5f});
    draw_panel(canvas, picture, state, view_place.size.y, width);
    return finished_file(canvas);
}

std::vector<std::uint8_t> dictionary_figure(VoxelRowView& view, const DictionaryPicture& picture,
                                            const ViewState& state, CanvasFormat format, const FigureOptions& options) {
    check_options(options);
    const float width = page_width(options);
    Page page = make_page(format, state, options, 0.45f, dictionary_panel_height({width, 10.0f * width}, text_height));
    draw_solid(page, view, picture.row, state);
    draw_lit(page.canvas, view_camera(shown_camera(picture.row, state, page.in_space), page.in_space),
             differing_voxels(picture), palette(state.theme), text_height / 12.0f, Emphasis::step);
    draw_voxel_row_marks(page.canvas, picture.row, state, page.in_space, text_height / 12.0f, MarksKey::none);
    draw_rule(page, state);
    draw_dictionary_panel(page.canvas, picture, state, page.panel, text_height);
    return finished_file(page.canvas);
}

std::vector<std::uint8_t> ray_figure(RayView& view, const RayPicture& picture, const ViewState& state,
                                     CanvasFormat format, const FigureOptions& options) {
    check_options(options);
    if (picture.samples) return ray_figure(view, merged_until(picture, state.merged_samples), state, format, options);
    const float width = page_width(options);
    Page page = make_page(format, state, options, 0.54f, map_panel_height(picture, {width, width}, text_height));
    draw_solid(page, view, picture, state);
    draw_ray_marks(page.canvas, picture, state, page.in_space, text_height / 12.0f);
    if (page.panel.size.y > 0.0f) {
        draw_rule(page, state);
        draw_map_panel(page.canvas, picture, state, page.panel, text_height);
    }
    return finished_file(page.canvas);
}

namespace {

template <class View>
View& made(std::optional<View>& view) {
    return view ? *view : view.emplace();
}

std::vector<std::uint8_t> figure_file(InsideView& view, const InsidePicture& picture, const ViewState& state,
                                      CanvasFormat format, const FigureOptions& options) {
    if (const auto* ray = std::get_if<RayPicture>(&picture))
        return ray_figure(made(view.rays), *ray, state, format, options);
    if (const auto* dictionary = std::get_if<DictionaryPicture>(&picture))
        return dictionary_figure(made(view.voxel_rows), *dictionary, state, format, options);
    return voxel_row_figure(made(view.voxel_rows), std::get<VoxelRowPicture>(picture), state, format, options);
}

}  // namespace

std::vector<std::filesystem::path> write_figure(InsideView& view, const InsidePicture& picture, std::string_view name,
                                                const ViewState& state, const FigureOptions& options,
                                                const std::filesystem::path& folder) {
    const auto* rows = std::get_if<VoxelRowPicture>(&picture);
    if (options.format == FigureFormat::vtk && rows == nullptr)
        throw InputError("--format", "vtk", "is not a format of this figure",
                         "it can be png, svg or pdf; the figure voxel-row has VTK data");
    if (options.format == FigureFormat::vtk) return write_voxel_row_vtk(*rows, folder);
    const CanvasFormat format = options.format == FigureFormat::svg   ? CanvasFormat::svg
                                : options.format == FigureFormat::pdf ? CanvasFormat::pdf
                                                                      : CanvasFormat::png;
    const char* const extension = format == CanvasFormat::svg ? ".svg" : format == CanvasFormat::pdf ? ".pdf" : ".png";
    const std::filesystem::path file = folder / (std::string(name) + extension);
    check_writable(file);
    write_file(file, figure_file(view, picture, state, format, options));
    return {file};
}

}  // namespace sightlines
