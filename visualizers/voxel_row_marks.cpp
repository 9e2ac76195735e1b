#include "visualizers/voxel_row_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include <glm/gtc/constants.hpp>

#include "visualizers/bit_strip.h"
#include "visualizers/theme.h"
#include "visualizers/view_camera.h"
#include "visualizers/voxel_row_view.h"

namespace sightlines {
namespace {

/// All that the marks share.
struct Sheet {
    Canvas& canvas;
    const VoxelRowPicture& picture;
    Palette colours;
    ViewCamera camera;
    float em = 12.0f;              ///< body text height
    std::vector<Rectangle> taken;  ///< where labels must not go
};

std::string text_of(const char* format, double value) {
    std::array<char, 64> out{};
    std::snprintf(out.data(), out.size(), format, value);
    return out.data();
}

TextStyle label_style(const Sheet& sheet, vec3 colour, Font font = Font::sans) {
    return {.height = sheet.em, .colour = colour, .font = font, .bold = true, .halo = sheet.colours.page};
}

/// Puts a label near its anchor where it covers no other: tries the eight directions, then further off, with a leader.
void place_label(Sheet& sheet, vec2 anchor, vec2 preferred, const std::string& text, const TextStyle& style) {
    const float width = text_width(sheet.canvas, text, style), em = sheet.em;
    const vec2 picture_size(sheet.camera.size.width, sheet.camera.size.height);
    for (float reach = 1.3f; reach < 14.0f; reach += 1.1f)
        for (const float turn : {0.0f, 0.6f, -0.6f, 1.2f, -1.2f, 2.0f, -2.0f, 3.1f}) {
            const vec2 way = glm::normalize(preferred);
            const vec2 direction{way.x * std::cos(turn) - way.y * std::sin(turn),
                                 way.x * std::sin(turn) + way.y * std::cos(turn)};
            const vec2 centre = anchor + direction * (reach * em + 0.5f * std::abs(direction.x) * width);
            const Rectangle box{centre - vec2(0.5f * width + 0.3f * em, 0.62f * em), {width + 0.6f * em, 1.24f * em}};
            const bool inside = glm::all(glm::greaterThanEqual(box.corner, vec2(0.2f * em))) &&
                                glm::all(glm::lessThanEqual(box.corner + box.size, picture_size - 0.2f * em));
            const bool free = std::none_of(sheet.taken.begin(), sheet.taken.end(),
                                           [&](const Rectangle& other) { return box.overlaps(other); });
            if (!inside || !free) continue;
            if (reach > 2.0f) {
                const vec2 end = glm::clamp(anchor, box.corner, box.corner + box.size);
                draw_line(sheet.canvas, anchor, end, {.colour = style.colour, .width = 0.07f * em, .alpha = 0.8f});
            }
            draw_text(sheet.canvas, box.corner + vec2(0.3f * em, 0.98f * em), text, style);
            sheet.taken.push_back(box);
            return;
        }
}

/// A line with an outline in the page's colour, so that it stands off from whatever is behind.
void draw_world_line(Sheet& sheet, vec3 from, vec3 to, Stroke stroke) {
    const auto ends = projected_segment(sheet.camera, from, to);
    if (!ends) return;
    Stroke halo = stroke;
    halo.colour = sheet.colours.page;
    halo.width = stroke.width + 0.1f * sheet.em;
    halo.alpha = 0.6f;
    halo.dash = 0.0f;
    draw_line(sheet.canvas, ends->from, ends->to, halo);
    draw_line(sheet.canvas, ends->from, ends->to, stroke);
}

/// Keeps labels off the bar and the lines along it: a chain of boxes.
void take_line(Sheet& sheet, vec3 from, vec3 to, float half_width) {
    const auto ends = projected_segment(sheet.camera, from, to);
    if (!ends) return;
    const int boxes = 40;
    for (int i = 0; i <= boxes; ++i) {
        const vec2 middle = glm::mix(ends->from, ends->to, static_cast<float>(i) / static_cast<float>(boxes));
        sheet.taken.push_back({middle - half_width, vec2(2.0f * half_width)});
    }
}

/// The convex polygon round the points, in order (Andrew's monotone chain).
std::vector<vec2> convex_outline(std::vector<vec2> points) {
    std::sort(points.begin(), points.end(), [](vec2 a, vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<vec2> outline;
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t start = outline.size();
        for (const vec2& point : points) {
            while (outline.size() >= start + 2) {
                const vec2 a = outline[outline.size() - 2], b = outline.back();
                if ((b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x) > 0.0f) break;
                outline.pop_back();
            }
            outline.push_back(point);
        }
        outline.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return outline;
}

/// The outline on the picture of the row's cells first .. last; empty where a corner is behind the camera.
std::vector<vec2> cells_outline(const Sheet& sheet, int first, int last) {
    const VoxelRowPicture& picture = sheet.picture;
    std::vector<vec2> corners;
    for (int i = 0; i < 8; ++i) {
        const vec3 corner((i & 1) != 0 ? last + 1 : first, picture.v + (i >> 1 & 1), picture.w + (i >> 2 & 1));
        const auto at = projected(sheet.camera, world_point(picture, corner));
        if (!at) return {};
        corners.emplace_back(*at);
    }
    return convex_outline(std::move(corners));
}

/// A tint over the part of the row that is looked at, and a firm outline round each set voxel in it.
void mark_kept_part(Sheet& sheet) {
    const VoxelRowPicture& picture = sheet.picture;
    if (picture.first > picture.last) return;
    const std::vector<vec2> outline = cells_outline(sheet, picture.first, picture.last);
    fill_path(sheet.canvas, outline, sheet.colours.set_bit, 0.16f);
    draw_path(sheet.canvas, outline, true, {.colour = sheet.colours.set_bit, .width = 0.05f * sheet.em});
    for (int u = picture.first; u <= picture.last; ++u)
        if (is_set(picture, {u, picture.v, picture.w}))
            draw_path(sheet.canvas, cells_outline(sheet, u, u), true,
                      {.colour = sheet.colours.ink, .width = 0.1f * sheet.em});
}

/// Names the first set voxel that the ray comes to.
void label_first_blocker(Sheet& sheet) {
    const VoxelRowPicture& picture = sheet.picture;
    const vec3 along(picture.world_from_voxels[0]);
    const bool upwards = glm::dot(picture.ray.target - picture.ray.origin, along) >= 0.0f;
    for (int i = picture.first; i <= picture.last; ++i) {
        const int u = upwards ? i : picture.first + picture.last - i;
        if (!is_set(picture, {u, picture.v, picture.w})) continue;
        const vec3 middle =
            vec3(static_cast<float>(u), static_cast<float>(picture.v), static_cast<float>(picture.w)) + 0.5f;
        const auto at = projected(sheet.camera, world_point(picture, middle));
        if (at)
            place_label(sheet, vec2(*at), {0.5f, 1.0f}, "set: u = " + std::to_string(u),
                        label_style(sheet, sheet.colours.set_bit));
        return;
    }
}

void draw_extent(Sheet& sheet, bool label) {
    const VoxelRowPicture& picture = sheet.picture;
    if (picture.first > picture.last) return;
    const vec2 row(static_cast<float>(picture.v) + 0.5f, static_cast<float>(picture.w) + 0.5f);
    for (const bool end : {false, true}) {
        const auto u = static_cast<float>(end ? picture.last + 1 : picture.first);
        std::array<vec2, 4> ring;
        bool visible = true;
        for (std::size_t i = 0; i < 4; ++i) {
            const vec2 corner = row + 1.1f * vec2(i == 1 || i == 2 ? 1.0f : -1.0f, i >= 2 ? 1.0f : -1.0f);
            const auto at = projected(sheet.camera, world_point(picture, {u, corner.x, corner.y}));
            visible = visible && at.has_value();
            if (at) ring[i] = vec2(*at);
        }
        if (!visible) continue;
        if (!label) {
            draw_path(sheet.canvas, ring, true,
                      {.colour = sheet.colours.page, .width = 0.34f * sheet.em, .alpha = 0.8f});
            draw_path(sheet.canvas, ring, true, {.colour = sheet.colours.extent, .width = 0.17f * sheet.em});
            continue;
        }
        vec2 lowest = ring[0];
        for (const vec2& corner : ring)
            if (corner.y > lowest.y) lowest = corner;
        place_label(sheet, lowest, {end ? 0.25f : -0.25f, 1.0f},
                    (end ? "e = " : "s = ") + std::to_string(end ? picture.last : picture.first),
                    label_style(sheet, sheet.colours.extent, Font::mono));
    }
}

void draw_angle(Sheet& sheet, const Segment& ray, const Segment& twin) {
    const vec3 middle = 0.5f * (ray.origin + ray.target);
    std::array<vec2, 17> arc;
    for (std::size_t i = 0; i < arc.size(); ++i) {
        const vec3 chord = glm::mix(ray.target, twin.target, static_cast<float>(i) / 16.0f) - middle;
        const auto at =
            projected(sheet.camera, middle + glm::normalize(chord) * 0.5f * glm::length(ray.target - ray.origin));
        if (!at) return;
        arc[i] = vec2(*at);
    }
    draw_path(sheet.canvas, arc, false, {.colour = sheet.colours.ink, .width = 0.12f * sheet.em});
    place_label(sheet, arc[8], {0.8f, -1.0f}, text_of("%.2f\u00b0", sheet.picture.angular_error_deg),
                label_style(sheet, sheet.colours.ink, Font::mono));
}

void draw_light(Sheet& sheet, vec2 at) {
    const float em = sheet.em;
    for (int i = 0; i < 8; ++i) {
        const float turn = glm::quarter_pi<float>() * static_cast<float>(i);
        const vec2 way{std::cos(turn), std::sin(turn)};
        draw_line(sheet.canvas, at + 0.58f * em * way, at + 0.9f * em * way,
                  {.colour = sheet.colours.light, .width = 0.13f * em, .round_ends = true});
    }
    fill_circle(sheet.canvas, at, 0.42f * em, sheet.colours.light);
    draw_circle(sheet.canvas, at, 0.42f * em, {.colour = sheet.colours.ray, .width = 0.11f * em});
}

void draw_rays(Sheet& sheet, const ViewState& state) {
    const Segment ray = sheet.picture.ray, twin = twin_of(sheet.picture);
    const float em = sheet.em;
    if (state.twin)
        draw_world_line(sheet, twin.origin, twin.target,
                        {.colour = sheet.colours.twin, .width = 0.14f * em, .dash = 0.7f * em, .gap = 0.35f * em});
    if (!state.ray) return;
    draw_world_line(sheet, ray.origin, ray.target,
                    {.colour = sheet.colours.ray, .width = 0.14f * em, .round_ends = true});
    if (const auto from = projected(sheet.camera, ray.origin)) {
        fill_circle(sheet.canvas, vec2(*from), 0.36f * em, sheet.colours.page);
        fill_circle(sheet.canvas, vec2(*from), 0.26f * em, sheet.colours.ray);
    }
    if (const auto to = projected(sheet.camera, ray.target)) draw_light(sheet, vec2(*to));
}

void label_rays(Sheet& sheet, const ViewState& state) {
    const Segment ray = sheet.picture.ray, twin = twin_of(sheet.picture);
    const auto from = projected(sheet.camera, ray.origin), to = projected(sheet.camera, ray.target);
    if (state.ray && from)
        place_label(sheet, vec2(*from), {-0.6f, -1.0f}, "surface point", label_style(sheet, sheet.colours.ray));
    if (state.ray && to) place_label(sheet, vec2(*to), {0.6f, -1.0f}, "light", label_style(sheet, sheet.colours.ray));
    if (state.ray && state.twin) draw_angle(sheet, ray, twin);
}

void draw_orientation(Sheet& sheet) {
    const float em = sheet.em, letter = 0.75f * em;
    const vec2 centre{3.6f * em, static_cast<float>(sheet.camera.size.height) - 4.0f * em};
    const auto draw_axis = [&](vec3 axis, const char* name, vec3 colour, float width, float length) {
        const vec2 way{glm::dot(axis, sheet.camera.right), -glm::dot(axis, sheet.camera.up)};
        const vec2 tip = centre + way * length;
        draw_line(sheet.canvas, centre, tip, {.colour = colour, .width = width * em, .round_ends = true});
        const float reach = glm::length(way);
        if (reach < 0.15f) return;
        const TextStyle style{
            .height = 0.9f * em, .colour = colour, .bold = true, .align = Align::centre, .halo = sheet.colours.page};
        draw_text(sheet.canvas, tip + way / reach * letter + vec2(0.0f, 0.32f * em), name, style);
    };
    draw_axis({1.0f, 0.0f, 0.0f}, "X", sheet.colours.muted, 0.1f, 2.0f * em);
    draw_axis({0.0f, 1.0f, 0.0f}, "Y", sheet.colours.muted, 0.1f, 2.0f * em);
    draw_axis({0.0f, 0.0f, 1.0f}, "Z", sheet.colours.muted, 0.1f, 2.0f * em);
    draw_axis(glm::normalize(vec3(sheet.picture.world_from_voxels[0])), "u", sheet.colours.set_bit, 0.15f, 2.7f * em);
    sheet.taken.push_back({centre - 3.4f * em, vec2(6.8f * em)});
}

void draw_scale_bar(Sheet& sheet, const OrbitCamera& orbit) {
    const float em = sheet.em, unit_m = metres_per_pixel(sheet.camera, orbit.distance_m);
    const float wanted_m = 0.16f * static_cast<float>(sheet.camera.size.width) * unit_m;
    const float decade_m = std::pow(10.0f, std::floor(std::log10(wanted_m)));
    float length_m = decade_m;
    for (const float step : {2.0f, 5.0f})
        if (step * decade_m <= wanted_m) length_m = step * decade_m;
    const vec2 right{static_cast<float>(sheet.camera.size.width) - 1.6f * em,
                     static_cast<float>(sheet.camera.size.height) - 1.5f * em};
    const vec2 left = right - vec2(length_m / unit_m, 0.0f);
    for (const bool halo : {true, false}) {
        const Stroke stroke{.colour = halo ? sheet.colours.page : sheet.colours.ink,
                            .width = (halo ? 0.4f : 0.14f) * em};
        const vec2 tick{0.0f, 0.4f * em};
        const std::array<vec2, 4> bar{left - tick, left, right, right - tick};
        draw_path(sheet.canvas, bar, false, stroke);
    }
    const vec3 voxel_m = voxel_size_m(sheet.picture);
    draw_text(sheet.canvas, 0.5f * (left + right) - vec2(0.0f, 0.55f * em), text_of("%g m", length_m),
              {.height = em,
               .colour = sheet.colours.ink,
               .font = Font::mono,
               .align = Align::centre,
               .halo = sheet.colours.page});
    draw_text(sheet.canvas, right + vec2(0.0f, 1.1f * em), text_of("voxel %.2f m along u", voxel_m.x),
              {.height = 0.8f * em, .colour = sheet.colours.muted, .align = Align::right, .halo = sheet.colours.page});
    sheet.taken.push_back({left - vec2(em, 2.0f * em), right - left + vec2(2.0f * em, 4.0f * em)});
}

/// Verdict and, where the picture is large enough, legend in the top left corner, on a ground that hides a little of
/// the picture.
void draw_key(Sheet& sheet, const ViewState& state) {
    constexpr float most_of_height = 0.28f;
    const float em = sheet.em, small = 0.92f * em;
    Canvas& canvas = sheet.canvas;
    const vec2 corner{em, em}, out_of_sight{-1e4f, -1e4f};
    const float room = static_cast<float>(canvas.size.x) - 4.0f * em;
    const float width = draw_verdict(canvas, sheet.picture, state, out_of_sight, room, small);
    const float legend = draw_voxel_row_legend(canvas, state, out_of_sight, width, small);
    const bool with_legend = legend + 3.2f * em < most_of_height * static_cast<float>(canvas.size.y);
    const Rectangle ground{corner, {width + 2.0f * em, with_legend ? legend + 3.2f * em : 2.6f * em}};
    fill_rectangle(canvas, ground, sheet.colours.page, 0.88f);
    draw_rectangle(canvas, ground, {.colour = sheet.colours.hairline, .width = 1.0f});
    draw_verdict(canvas, sheet.picture, state, corner + vec2(em, 1.7f * em), room, small);
    if (with_legend) draw_voxel_row_legend(canvas, state, corner + vec2(em, 2.8f * em), width, small);
    sheet.taken.push_back(ground);
}

}  // namespace

void draw_voxel_row_marks(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, ImageSize size,
                          float text_scale, MarksKey key) {
    const OrbitCamera orbit = shown_camera(picture, state, size);
    Sheet sheet{canvas, picture, palette(state.theme), view_camera(orbit, size), 12.0f * text_scale, {}};
    if (state.row && state.extent) mark_kept_part(sheet);
    if (state.extent) draw_extent(sheet, false);
    draw_rays(sheet, state);
    if (!state.labels) return;
    if (key == MarksKey::in_corner) draw_key(sheet, state);
    draw_orientation(sheet);
    draw_scale_bar(sheet, orbit);
    const vec3 row{0.0f, static_cast<float>(picture.v) + 0.5f, static_cast<float>(picture.w) + 0.5f};
    const vec3 row_end = row + vec3(picture.resolution, 0.0f, 0.0f);
    const vec3 voxel_m = voxel_size_m(picture);
    const float half_cell = 0.5f * std::max(voxel_m.y, voxel_m.z) / metres_per_pixel(sheet.camera, orbit.distance_m);
    take_line(sheet, world_point(picture, row), world_point(picture, row_end), std::max(half_cell, 0.5f * sheet.em));
    take_line(sheet, picture.ray.origin, picture.ray.target, 0.5f * sheet.em);
    if (state.extent) draw_extent(sheet, true);
    label_rays(sheet, state);
    if (state.row) label_first_blocker(sheet);
}

float draw_voxel_row_legend(Canvas& canvas, const ViewState& state, vec2 at, float width, float text_height) {
    const Palette colours = palette(state.theme);
    const float em = text_height, key = 1.7f * em, line = 1.7f * em;
    const TextStyle style{.height = em, .colour = colours.ink};
    vec2 cursor = at;
    const auto item = [&](const char* text, const auto& draw_key) {
        const float needed = key + 0.5f * em + text_width(canvas, text, style);
        if (cursor.x > at.x && cursor.x + needed > at.x + width) cursor = {at.x, cursor.y + line};
        draw_key(cursor + vec2(0.5f * key, 0.5f * em));
        draw_text(canvas, cursor + vec2(key + 0.5f * em, 0.86f * em), text, style);
        cursor.x += needed + 1.6f * em;
    };
    const auto square = [&](vec2 middle, float side) { return Rectangle{middle - 0.5f * side, vec2(side)}; };
    const auto rule = [&](vec2 middle, const Stroke& stroke) {
        draw_line(canvas, middle - vec2(0.5f * key, 0.0f), middle + vec2(0.5f * key, 0.0f), stroke);
    };
    if (state.row) {
        item("set, looked at", [&](vec2 m) { fill_rectangle(canvas, square(m, em), colours.set_bit); });
        item("clear, looked at", [&](vec2 m) {
            draw_rectangle(canvas, square(m, 0.9f * em), {.colour = colours.clear_bit, .width = 0.1f * em});
        });
        item("set, clipped away",
             [&](vec2 m) { fill_rectangle(canvas, square(m, 0.6f * em), colours.set_bit_clipped); });
    }
    if (state.extent)
        item("extent [s, e]", [&](vec2 m) {
            draw_rectangle(canvas, {m - vec2(0.3f, 0.55f) * em, vec2(0.6f, 1.1f) * em},
                           {.colour = colours.extent, .width = 0.17f * em});
        });
    if (state.ray) item("ray", [&](vec2 m) { rule(m, {.colour = colours.ray, .width = 0.17f * em}); });
    if (state.twin)
        item("its twin, along the row", [&](vec2 m) {
            rule(m, {.colour = colours.twin, .width = 0.2f * em, .dash = 0.5f * em, .gap = 0.25f * em});
        });
    if (state.voxels)
        item("voxels behind the row", [&](vec2 m) { fill_rectangle(canvas, square(m, em), colours.voxel); });
    if (state.voxels && state.cut_away == CutAway::to_row)
        item("cut through", [&](vec2 m) { fill_rectangle(canvas, square(m, em), colours.section); });
    return cursor.y + line - at.y;
}

}  // namespace sightlines
