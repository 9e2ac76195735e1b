#include "visualizers/voxel_row_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "visualizers/bit_strip.h"
#include "visualizers/lit_marks.h"
#include "visualizers/theme.h"
#include "visualizers/view_camera.h"
#include "visualizers/view_marks.h"
#include "visualizers/voxel_row_view.h"

namespace sightlines {
namespace {

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
std::vector<vec2> cells_outline(const Sheet& sheet, const VoxelRowPicture& picture, int first, int last) {
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
void mark_kept_part(Sheet& sheet, const VoxelRowPicture& picture) {
    if (picture.first > picture.last) return;
    const std::vector<vec2> outline = cells_outline(sheet, picture, picture.first, picture.last);
    fill_path(sheet.canvas, outline, sheet.colours.set_bit, 0.16f);
    draw_path(sheet.canvas, outline, true, {.colour = sheet.colours.set_bit, .width = 0.05f * sheet.em});
    for (int u = picture.first; u <= picture.last; ++u)
        if (is_set(picture, {u, picture.v, picture.w}))
            draw_path(sheet.canvas, cells_outline(sheet, picture, u, u), true,
                      {.colour = sheet.colours.ink, .width = 0.1f * sheet.em});
}

/// Names the first set voxel that the ray comes to.
void label_first_blocker(Sheet& sheet, const VoxelRowPicture& picture) {
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

void draw_extent(Sheet& sheet, const VoxelRowPicture& picture, bool label) {
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

void draw_angle(Sheet& sheet, const VoxelRowPicture& picture) {
    const Segment ray = picture.ray, twin = twin_of(picture);
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
    place_label(sheet, arc[8], {0.8f, -1.0f}, text_of("%.2f\u00b0", picture.angular_error_deg),
                label_style(sheet, sheet.colours.ink, Font::mono));
}

void draw_rays(Sheet& sheet, const VoxelRowPicture& picture, const ViewState& state) {
    const Segment twin = twin_of(picture);
    const float em = sheet.em;
    if (state.twin)
        draw_world_line(sheet, twin.origin, twin.target,
                        {.colour = sheet.colours.twin, .width = 0.14f * em, .dash = 0.7f * em, .gap = 0.35f * em});
    if (state.ray) draw_ray(sheet, picture.ray);
}

void label_rays(Sheet& sheet, const VoxelRowPicture& picture, const ViewState& state) {
    if (!state.ray) return;
    label_ray(sheet, picture.ray);
    if (state.twin) draw_angle(sheet, picture);
}

vec3 object_colour(const Sheet& sheet, const ObjectPicture& object) {
    return object.blocked ? sheet.colours.set_bit : object.rows ? sheet.colours.ink : sheet.colours.muted;
}

/// Fills the voxels that are in the way, which the larger ones of what stands still may hide.
void fill_blockers(Sheet& sheet, const VoxelRowPicture& rows) {
    for (int u = rows.first; u <= rows.last; ++u)
        if (is_set(rows, {u, rows.v, rows.w}))
            fill_path(sheet.canvas, cells_outline(sheet, rows, u, u), sheet.colours.set_bit, 0.8f);
}

/// The bounds of the objects that were asked, and the part of the rows that was looked at.
void draw_objects(Sheet& sheet, const VoxelRowPicture& picture, const ViewState& state) {
    for (const ObjectPicture& object : picture.objects) {
        const Stroke line{.colour = object_colour(sheet, object), .width = (object.rows ? 0.12f : 0.06f) * sheet.em};
        for_each_edge(object.bounds, [&](vec3 from, vec3 to) { draw_world_line(sheet, from, to, line); });
        if (!object.rows) continue;
        if (state.row) fill_blockers(sheet, *object.rows);
        if (state.row && state.extent) mark_kept_part(sheet, *object.rows);
        if (state.extent) draw_extent(sheet, *object.rows, false);
    }
}

/// Says of each object whose row was asked what became of the ray there.
void label_objects(Sheet& sheet, const VoxelRowPicture& picture, const ViewState& state) {
    for (const ObjectPicture& object : picture.objects) {
        if (!object.rows) continue;
        if (state.row) label_first_blocker(sheet, *object.rows);
        const std::vector<vec3>& box = object.bounds;
        vec3 top = box[0] + 0.5f * (box[1] + box[2] + box[3]);
        for (std::size_t edge = 1; edge <= 3; ++edge) top.y += 0.5f * std::abs(box[edge].y);
        if (const auto at = projected(sheet.camera, top))
            place_label(sheet, vec2(*at), {0.0f, -1.0f},
                        object.name + (object.blocked ? ": in the way" : ": lets it by"),
                        label_style(sheet, object_colour(sheet, object)));
    }
}

/// Verdict and, where the picture is large enough, legend in the top left corner, on a ground that hides a little of
/// the picture.
void draw_key(Sheet& sheet, const VoxelRowPicture& picture, const ViewState& state) {
    constexpr float most_of_height = 0.28f;
    const float em = sheet.em, small = 0.92f * em;
    Canvas& canvas = sheet.canvas;
    const vec2 corner{em, em}, out_of_sight{-1e4f, -1e4f};
    const float room = static_cast<float>(canvas.size.x) - 4.0f * em;
    const float width = draw_verdict(canvas, picture, state, out_of_sight, room, small);
    const float legend = draw_voxel_row_legend(canvas, picture, state, out_of_sight, width, small);
    const bool with_legend = legend + 3.2f * em < most_of_height * static_cast<float>(canvas.size.y);
    const Rectangle ground{corner, {width + 2.0f * em, with_legend ? legend + 3.2f * em : 2.6f * em}};
    fill_rectangle(canvas, ground, sheet.colours.page, 0.88f);
    draw_rectangle(canvas, ground, {.colour = sheet.colours.hairline, .width = 1.0f});
    draw_verdict(canvas, picture, state, corner + vec2(em, 1.7f * em), room, small);
    if (with_legend) draw_voxel_row_legend(canvas, picture, state, corner + vec2(em, 2.8f * em), width, small);
    sheet.taken.push_back(ground);
}

}  // namespace

void draw_voxel_row_marks(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, ImageSize size,
                          float text_scale, MarksKey key) {
    const OrbitCamera orbit = shown_camera(picture, state, size);
    Sheet sheet{canvas, palette(state.theme), view_camera(orbit, size), 12.0f * text_scale};
    if (state.row && state.extent) mark_kept_part(sheet, picture);
    if (state.extent) draw_extent(sheet, picture, false);
    draw_objects(sheet, picture, state);
    draw_rays(sheet, picture, state);
    if (!state.labels) return;
    if (key == MarksKey::in_corner) draw_key(sheet, picture, state);
    draw_orientation(sheet, NamedAxis{glm::normalize(vec3(picture.world_from_voxels[0])), "u"});
    draw_scale_bar(sheet, orbit, text_of("voxel %.2f m along u", voxel_size_m(picture).x));
    const vec3 row{0.0f, static_cast<float>(picture.v) + 0.5f, static_cast<float>(picture.w) + 0.5f};
    const vec3 row_end = row + vec3(picture.resolution, 0.0f, 0.0f);
    const vec3 voxel_m = voxel_size_m(picture);
    const float half_cell = 0.5f * std::max(voxel_m.y, voxel_m.z) / metres_per_pixel(sheet.camera, orbit.distance_m);
    take_line(sheet, world_point(picture, row), world_point(picture, row_end), std::max(half_cell, 0.5f * sheet.em));
    take_line(sheet, picture.ray.origin, picture.ray.target, 0.5f * sheet.em);
    if (state.extent) draw_extent(sheet, picture, true);
    label_rays(sheet, picture, state);
    if (state.row) label_first_blocker(sheet, picture);
    label_objects(sheet, picture, state);
}

float draw_voxel_row_legend(Canvas& canvas, const VoxelRowPicture& picture, const ViewState& state, vec2 at,
                            float width, float text_height) {
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
    if (!picture.objects.empty())
        item("object that was asked", [&](vec2 m) {
            draw_rectangle(canvas, {m - vec2(0.7f, 0.45f) * em, vec2(1.4f, 0.9f) * em},
                           {.colour = colours.muted, .width = 0.1f * em});
        });
    return cursor.y + line - at.y;
}

}  // namespace sightlines
