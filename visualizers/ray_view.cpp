#include "visualizers/ray_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <vtkPlane.h>
#include <vtkRenderer.h>
#include <glm/gtc/constants.hpp>

#include "visualizers/lit_marks.h"
#include "visualizers/offscreen_window.h"
#include "visualizers/raster.h"
#include "visualizers/solid_piece.h"
#include "visualizers/view_marks.h"

namespace sightlines {
namespace {

/// What a piece was made from. The pointers keep their objects alive, so that equal pointers mean equal content.
struct MadeFrom {
    std::shared_ptr<const void> content;
    CutPlane cut{};
    Theme theme = Theme::light;

    bool operator==(const MadeFrom&) const = default;
};

using Piece = KeptPiece<MadeFrom>;

struct PatchesFrom {
    std::vector<ValuedPatch> patches;
    Theme theme = Theme::light;

    bool operator==(const PatchesFrom&) const = default;
};

vec3 any_across(vec3 along) {
    const vec3 least = std::abs(along.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    return glm::normalize(glm::cross(along, least));
}

vec3 direction_of(const Segment& ray) {
    const vec3 along = ray.target - ray.origin;
    const float length = glm::length(along);
    return length > 0.0f ? along / length : vec3(1.0f, 0.0f, 0.0f);
}

std::vector<vec3> corners_of(const Box3& box) {
    std::vector<vec3> corners;
    for (int k = 0; k < 8; ++k)
        corners.push_back({(k & 1) != 0 ? box.highest.x : box.lowest.x, (k & 2) != 0 ? box.highest.y : box.lowest.y,
                           (k & 4) != 0 ? box.highest.z : box.lowest.z});
    return corners;
}

/// The plane along the ray that faces the camera most, of twelve: so turning the view seldom makes anything anew.
CutPlane cut_along(const RayPicture& picture, vec3 forward) {
    const vec3 along = direction_of(picture.ray), across = any_across(along), third = glm::cross(along, across);
    constexpr int planes = 12;
    CutPlane best{picture.ray.origin, across};
    for (int k = 0; k < planes; ++k) {
        const float turn = glm::two_pi<float>() * static_cast<float>(k) / planes;
        const vec3 normal = std::cos(turn) * across + std::sin(turn) * third;
        if (glm::dot(normal, forward) > glm::dot(best.normal, forward)) best.normal = normal;
    }
    return best;
}

/// Whether a cell is drawn: any where all are, or those whose middle is beyond the plane.
bool is_kept(const ValuedBox& cell, const CutPlane& cut, bool all) {
    return all || glm::dot(cell.box.centre() - cut.origin, cut.normal) >= 0.0f;
}

ColouredTriangles kept_boxes(const RayPicture& picture, const CutPlane& cut, bool all, const Palette& colours) {
    std::vector<ColouredBox> kept;
    for (const ValuedBox& each : *picture.boxes)
        if (is_kept(each, cut, all)) kept.push_back({each.box, glm::mix(colours.voxel, colours.set_bit, each.value)});
    return box_triangles(kept);
}

ColouredTriangles patch_triangles(const std::vector<ValuedPatch>& patches, const Palette& colours) {
    ColouredTriangles out;
    for (const ValuedPatch& patch : patches)
        add_quad(out, patch.corners, glm::mix(colours.ray, colours.set_bit, patch.value));
    return out;
}

Box3 drawn_bounds(const RayPicture& picture) {
    Box3 bounds;
    bounds.add(picture.ray.origin);
    bounds.add(picture.ray.target);
    if (picture.scene && !picture.scene->bounds.empty()) {
        bounds.add(picture.scene->bounds.lowest);
        bounds.add(picture.scene->bounds.highest);
    }
    return bounds;
}

Verdict verdict_of(const RayPicture& picture) {
    if (!picture.truly_blocked) return {picture.blocked, {}};
    const bool right = *picture.truly_blocked == picture.blocked;
    const std::string truth = *picture.truly_blocked ? "blocked" : "open";
    return {picture.blocked,
            {right ? "Embree agrees." : "Wrong: by Embree the ray is " + truth + ".", right ? "right" : "wrong"}};
}

void draw_key(Sheet& sheet, const RayPicture& picture, const ViewState& state) {
    const float em = sheet.em, small = 0.92f * em;
    const Verdict verdict = verdict_of(picture);
    const bool legend = state.voxels && picture.boxes && !picture.boxes_title.empty();
    const TextStyle style{.height = small, .colour = sheet.colours.ink};
    const float room = static_cast<float>(sheet.camera.size.width) - 4.0f * em;
    const vec2 corner{em, em}, out_of_sight{-1e4f, -1e4f};
    float width = draw_verdict(sheet.canvas, verdict, sheet.colours, out_of_sight, room, small);
    if (legend) width = std::max(width, 1.6f * em + text_width(sheet.canvas, picture.boxes_title, style));
    const Rectangle ground{corner, {std::min(width + 2.0f * em, room + 2.0f * em), (legend ? 4.4f : 2.6f) * em}};
    fill_rectangle(sheet.canvas, ground, sheet.colours.page, 0.88f);
    draw_rectangle(sheet.canvas, ground, {.colour = sheet.colours.hairline, .width = 1.0f});
    draw_verdict(sheet.canvas, verdict, sheet.colours, corner + vec2(em, 1.7f * em), room, small);
    if (legend) {
        const vec2 at = corner + vec2(em, 3.5f * em);
        for (const float part : {0.0f, 0.25f, 0.5f, 0.75f})
            fill_rectangle(
                sheet.canvas, {at + vec2(part * em, -0.8f * em), {0.25f * em, em}},
                glm::mix(sheet.colours.voxel, sheet.colours.set_bit, picture.boxes_graded ? part / 0.75f : 0.0f));
        draw_text(sheet.canvas, at + vec2(1.6f * em, 0.0f), picture.boxes_title, style);
    }
    sheet.taken.push_back(ground);
}

/// A map's texels as a picture, the row 0 at the top.
ImageRgba8 map_pixels(const PictureMap& map, const Palette& colours) {
    ImageRgba8 pixels({map.size.x, map.size.y}, {0, 0, 0, 255});
    for (std::size_t k = 0; k < map.values.size(); ++k) {
        const vec3 colour = 255.0f * glm::mix(colours.ghost, colours.ray, glm::clamp(map.values[k], 0.0f, 1.0f));
        pixels.pixels[k] = {static_cast<std::uint8_t>(colour.x), static_cast<std::uint8_t>(colour.y),
                            static_cast<std::uint8_t>(colour.z), 255};
    }
    return pixels;
}

/// Each texel as a square of so many pixels that none is blurred when the picture is stretched.
ImageRgba8 enlarged(const ImageRgba8& from, int times) {
    ImageRgba8 to({from.size.width * times, from.size.height * times}, {0, 0, 0, 255});
    for (int y = 0; y < to.size.height; ++y)
        for (int x = 0; x < to.size.width; ++x)
            to.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.size.width) +
                      static_cast<std::size_t>(x)] =
                from.pixels[static_cast<std::size_t>(y / times) * static_cast<std::size_t>(from.size.width) +
                            static_cast<std::size_t>(x / times)];
    return to;
}

/// Texels keep their shape: `texel` pixels wide and high.
void draw_map(Canvas& canvas, const PictureMap& map, const Palette& colours, vec2 corner, float texel, float em) {
    const Rectangle frame{corner + vec2(0.0f, 1.5f * em), texel * vec2(map.size)};
    draw_text(canvas, corner + vec2(0.0f, 0.9f * em), map.title,
              {.height = em, .colour = map.asked ? colours.ink : colours.muted, .bold = map.asked.has_value()});
    const int times = std::max(1, static_cast<int>(std::ceil(std::min(3.0f * texel, 4096.0f / frame.size.x))));
    draw_picture(canvas, frame, enlarged(map_pixels(map, colours), times));
    draw_rectangle(canvas, frame, {.colour = colours.hairline, .width = 0.08f * em});
    if (!map.asked) return;
    const float extent = static_cast<float>(map.asked_side);
    const vec2 middle = frame.corner + texel * (vec2(*map.asked) + 0.5f * extent);
    const float reach = std::max(0.5f * extent * texel, 0.25f * em);
    draw_rectangle(canvas, {middle - reach, vec2(2.0f * reach)}, {.colour = colours.page, .width = 0.3f * em});
    draw_rectangle(canvas, {middle - reach, vec2(2.0f * reach)}, {.colour = colours.pointed, .width = 0.15f * em});
}

constexpr float map_gap_em = 1.2f, map_frame_em = 3.6f;  ///< between maps; above and below them
constexpr float most_map_em = 54.0f;                     ///< a map's height, of a panel with the whole height

/// Side by side, at most as high as is of use.
float map_height(const RayPicture& picture, vec2 size, float em) {
    const auto count = static_cast<float>(picture.maps.size());
    float aspects = 0.0f;
    for (const PictureMap& map : picture.maps)
        aspects += static_cast<float>(map.size.x) / static_cast<float>(map.size.y);
    return std::min({(size.x - map_gap_em * em * (count + 1.0f)) / aspects, picture.maps_share * size.y,
                     picture.maps_share * most_map_em * em});
}

}  // namespace

struct RayView::Objects {
    vtkSmartPointer<vtkRenderWindow> window = make_offscreen_window();
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkPlane> cut;
    Piece scene, boxes;
    KeptPiece<PatchesFrom> patches;

    Objects() {
        renderer->SetBackground(0.0, 0.0, 0.0);
        renderer->SetBackgroundAlpha(0.0);
        for (Piece* const piece : {&scene, &boxes}) renderer->AddActor(piece->solid.actor);
        renderer->AddActor(patches.solid.actor);
        scene.solid.mapper->AddClippingPlane(cut);
        window->AddRenderer(renderer);
    }
};

RayView::RayView() : objects(std::make_unique<Objects>()) {}
RayView::~RayView() = default;
RayView::RayView(RayView&&) noexcept = default;
RayView& RayView::operator=(RayView&&) noexcept = default;

OrbitCamera shown_camera(const RayPicture& picture, const ViewState& state, ImageSize size) {
    if (state.camera) return *state.camera;
    const Segment& ray = picture.ray;
    const vec3 along = direction_of(ray);
    OrbitCamera camera;
    camera.focal_point = 0.5f * (ray.origin + ray.target);
    const bool upright = std::hypot(along.x, along.z) < 0.05f;
    const float across_deg = upright ? 0.0f : glm::degrees(std::atan2(-along.z, along.x));
    camera.azimuth_deg = std::remainder(across_deg - 14.0f, 360.0f);
    camera.elevation_deg = 24.0f;
    std::vector<vec3> points{ray.origin, ray.target};
    if (picture.focus) {
        points = corners_of(*picture.focus);
        camera.focal_point = picture.focus->centre();
        camera.elevation_deg = 38.0f;
    }
    camera.distance_m =
        std::max(fitting_distance_m(view_camera(camera, size), camera.focal_point, points, {0.7f, 0.6f}), 1e-2f);
    return camera;
}

ImageRgba8 render_solid(RayView& view, const RayPicture& picture, const ViewState& state, ImageSize size,
                        int samples_per_axis) {
    RayView::Objects& objects = *view.objects;
    const ImageSize drawn_size{size.width * samples_per_axis, size.height * samples_per_axis};
    const ViewCamera camera = view_camera(shown_camera(picture, state, size), drawn_size);
    const CutPlane cut = cut_along(picture, camera.forward);
    const Palette colours = palette(state.theme);
    const bool has_scene = picture.scene && !picture.scene->triangles.empty();
    const bool whole = state.cut_away == CutAway::none || picture.boxes_whole;
    keep_made(objects.scene, state.scene && has_scene,
              MadeFrom{.content = picture.scene, .cut = cut, .theme = state.theme},
              [&] { return ghost_triangles(*picture.scene, cut, colours); });
    keep_made(objects.boxes, state.voxels && picture.boxes && !picture.boxes->empty(),
              MadeFrom{.content = picture.boxes, .cut = whole ? CutPlane{} : cut, .theme = state.theme},
              [&] { return kept_boxes(picture, cut, whole, colours); });
    keep_made(objects.patches, state.voxels && !picture.patches.empty(), PatchesFrom{picture.patches, state.theme},
              [&] { return patch_triangles(picture.patches, colours); });
    objects.cut->SetOrigin(cut.origin.x, cut.origin.y, cut.origin.z);
    objects.cut->SetNormal(cut.normal.x, cut.normal.y, cut.normal.z);
    const Box3 bounds = drawn_bounds(picture);
    set_camera(*objects.renderer->GetActiveCamera(), camera, bounds);
    DrawnPixels drawn = draw(*objects.window, drawn_size);
    ink_outlines(drawn, 0.01f * bounds.diagonal(), colours.ink, state.theme == Theme::dark ? 0.25f : 0.35f);
    return reduced(drawn.colour, samples_per_axis);
}

void draw_ray_marks(Canvas& canvas, const RayPicture& picture, const ViewState& state, ImageSize size,
                    float text_scale) {
    const OrbitCamera orbit = shown_camera(picture, state, size);
    Sheet sheet{canvas, palette(state.theme), view_camera(orbit, size), 12.0f * text_scale};
    const Stroke thin{.colour = sheet.colours.set_bit, .width = 0.08f * sheet.em};
    for (const TraceGeometry& geometry : picture.recorded) {
        if (!state.row || geometry.name == "ray") continue;
        if (geometry.shape == TraceShape::box)
            for_each_edge(geometry.points, [&](vec3 from, vec3 to) { draw_world_line(sheet, from, to, thin); });
        if (geometry.shape == TraceShape::segment) draw_world_line(sheet, geometry.points[0], geometry.points[1], thin);
    }
    draw_lit(canvas, sheet.camera, picture.marked, sheet.colours, text_scale, Emphasis::step);
    draw_lit(canvas, sheet.camera, picture.pointed, sheet.colours, text_scale, Emphasis::pointed);
    if (state.ray) draw_ray(sheet, picture.ray);
    if (!state.labels) return;
    draw_key(sheet, picture, state);
    draw_orientation(sheet, std::nullopt);
    draw_scale_bar(sheet, orbit, "");
    take_line(sheet, picture.ray.origin, picture.ray.target, 0.5f * sheet.em);
    if (state.ray) label_ray(sheet, picture.ray, picture.end_name);
}

float map_panel_height(const RayPicture& picture, vec2 size, float text_height) {
    if (picture.maps.empty()) return 0.0f;
    const float height = map_height(picture, size, text_height);
    return height < 3.0f * text_height ? 0.0f : height + map_frame_em * text_height;
}

void draw_map_panel(Canvas& canvas, const RayPicture& picture, const ViewState& state, const Rectangle& where,
                    float text_height) {
    const Palette colours = palette(state.theme);
    const float height = where.size.y - map_frame_em * text_height, gap = map_gap_em * text_height;
    vec2 corner = where.corner + vec2(gap, text_height);
    for (const PictureMap& map : picture.maps) {
        const float texel = height / static_cast<float>(map.size.y);
        draw_map(canvas, map, colours, corner, texel, text_height);
        corner.x += texel * static_cast<float>(map.size.x) + gap;
    }
}

std::optional<ivec3> pick(const RayPicture& picture, const ViewState& state, ImageSize size, vec2 pixel) {
    if (!picture.boxes || !state.voxels) return std::nullopt;
    const ViewCamera camera = view_camera(shown_camera(picture, state, size), size);
    const CutPlane cut = cut_along(picture, camera.forward);
    const bool whole = state.cut_away == CutAway::none || picture.boxes_whole;
    const vec3 direction = direction_through(camera, pixel);
    std::optional<ivec3> picked;
    float nearest = std::numeric_limits<float>::infinity();
    for (const ValuedBox& each : *picture.boxes) {
        if (!is_kept(each, cut, whole)) continue;
        // Where the line of sight is between each pair of opposite faces.
        const vec3 a = (each.box.lowest - camera.position) / direction,
                   b = (each.box.highest - camera.position) / direction;
        const vec3 near = glm::min(a, b), far = glm::max(a, b);
        const float enters = std::max({near.x, near.y, near.z, 0.0f}), leaves = std::min({far.x, far.y, far.z});
        if (enters > leaves || enters >= nearest) continue;
        nearest = enters;
        picked = each.place;
    }
    return picked;
}

}  // namespace sightlines
