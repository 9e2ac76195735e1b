#include "visualizers/inside_view.h"

#include <algorithm>

#include "techniques/trace_boxes.h"
#include "visualizers/canvas.h"
#include "visualizers/dictionary_panel.h"
#include "visualizers/lit_marks.h"
#include "visualizers/mask_merging.h"
#include "visualizers/raster.h"
#include "visualizers/theme.h"
#include "visualizers/view_camera.h"
#include "visualizers/voxel_row_marks.h"

namespace sightlines {
namespace {

constexpr float pick_reach_pixels = 6.0f;

/// All that the solid part is drawn from; equal pointers mean equal content.
bool is_same_solid(const VoxelRowPicture& a, const VoxelRowPicture& b) {
    return a.scene == b.scene && a.occupied == b.occupied && a.resolution == b.resolution &&
           a.world_from_voxels == b.world_from_voxels && a.v == b.v && a.w == b.w && a.first == b.first &&
           a.last == b.last && a.ray.origin == b.ray.origin && a.ray.target == b.ray.target &&
           std::ranges::equal(a.objects, b.objects, [](const ObjectPicture& one, const ObjectPicture& other) {
               return one.rows == other.rows || (one.rows && other.rows && is_same_solid(*one.rows, *other.rows));
           });
}

bool is_same_solid(const RayPicture& a, const RayPicture& b) {
    return a.scene == b.scene && a.boxes == b.boxes && a.patches == b.patches && a.ray.origin == b.ray.origin &&
           a.ray.target == b.ray.target;
}

constexpr float body_text_pixels = 12.0f;  // at text scale 1

/// The height of the panel below the part in space; 0: none.
float panel_height(const InsidePicture& picture, vec2 size, float text_height) {
    if (std::holds_alternative<DictionaryPicture>(picture)) return dictionary_panel_height(size, text_height);
    if (const auto* ray = std::get_if<RayPicture>(&picture)) return map_panel_height(*ray, size, text_height);
    return 0.0f;
}

/// How much of a view the part in space takes: all of it, or what is above the panel.
ImageSize size_in_space(const InsidePicture& picture, ImageSize size, float text_scale) {
    const float panel = panel_height(picture, vec2(size.width, size.height), body_text_pixels * text_scale);
    return {size.width, std::max(1, size.height - static_cast<int>(panel))};
}

/// The view in space above, the panel below it.
ImageRgba8 with_panel(const ImageRgba8& above, const InsidePicture& picture, const ViewState& state, ImageSize size,
                      float text_scale) {
    ImageRgba8 whole(size, {0, 0, 0, 0});
    std::ranges::copy(above.pixels, whole.pixels.begin());
    Canvas canvas = make_picture_canvas(whole);
    const Rectangle panel{vec2(0, above.size.height), vec2(size.width, size.height - above.size.height)};
    if (panel.size.y < 1.0f) return whole;
    if (state.theme != Theme::print) fill_rectangle(canvas, panel, palette(state.theme).page);
    draw_line(canvas, panel.corner, panel.corner + vec2(panel.size.x, 0.0f),
              {.colour = palette(state.theme).hairline, .width = text_scale});
    if (const auto* dictionary = std::get_if<DictionaryPicture>(&picture))
        draw_dictionary_panel(canvas, *dictionary, state, panel, body_text_pixels * text_scale);
    else
        draw_map_panel(canvas, std::get<RayPicture>(picture), state, panel, body_text_pixels * text_scale);
    return finished_picture(canvas);
}

ImageRgba8 draw_solid(InsideView& view, const InsidePicture& picture, const ViewState& state, ImageSize size,
                      int samples_per_axis) {
    if (const auto* ray = std::get_if<RayPicture>(&picture)) {
        if (!view.rays) view.rays.emplace();
        return render_solid(*view.rays, *ray, state, size, samples_per_axis);
    }
    if (!view.voxel_rows) view.voxel_rows.emplace();
    return render_solid(*view.voxel_rows, *rows_in_space(picture), state, size, samples_per_axis);
}

const ImageRgba8& solid_part(InsideView& view, const InsidePicture& picture, const ViewState& state, ImageSize size,
                             int samples_per_axis) {
    SolidDrawn& latest = view.latest;
    if (latest.picture && same_solid(*latest.picture, picture) && latest.state == state && latest.size == size &&
        latest.samples_per_axis == samples_per_axis)
        return latest.pixels;
    latest.picture.reset();  // nothing half-valid stays where drawing fails
    latest.pixels = draw_solid(view, picture, state, size, samples_per_axis);
    if (state.theme != Theme::print) latest.pixels = over_page(latest.pixels, palette(state.theme).page);
    latest.state = state;
    latest.size = size;
    latest.samples_per_axis = samples_per_axis;
    latest.picture = picture;
    return latest.pixels;
}

/// The recorded point or line nearest to the pixel and within reach of it; points before lines.
std::string nearest_geometry(const ViewCamera& camera, std::span<const TraceGeometry> recorded, vec2 pixel) {
    for (const TraceShape shape : {TraceShape::point, TraceShape::segment}) {
        const TraceGeometry* nearest = nullptr;
        float least = pick_reach_pixels;
        for (const TraceGeometry& geometry : recorded) {
            if (geometry.shape != shape) continue;
            const auto distance = distance_pixels(camera, geometry, pixel);
            if (!distance || *distance > least || (nearest != nullptr && *distance == least)) continue;
            least = *distance;
            nearest = &geometry;
        }
        if (nearest != nullptr) return nearest->name;
    }
    return {};
}

std::string geometry_of_voxel(const VoxelRowPicture& picture, ivec3 voxel) {
    if (voxel.y != picture.v || voxel.z != picture.w) return {};
    return voxel.x >= picture.first && voxel.x <= picture.last ? "extent" : "row";
}

}  // namespace

const VoxelRowPicture* rows_in_space(const InsidePicture& picture) {
    if (const auto* dictionary = std::get_if<DictionaryPicture>(&picture)) return &dictionary->row;
    return std::get_if<VoxelRowPicture>(&picture);
}

OrbitCamera shown_camera(const InsidePicture& picture, const ViewState& state, ImageSize size, float text_scale) {
    const ImageSize in_space = size_in_space(picture, size, text_scale);
    if (const auto* ray = std::get_if<RayPicture>(&picture)) return shown_camera(*ray, state, in_space);
    return shown_camera(*rows_in_space(picture), state, in_space);
}

bool same_solid(const InsidePicture& a, const InsidePicture& b) {
    if (a.index() != b.index()) return false;
    if (const auto* ray = std::get_if<RayPicture>(&a)) return is_same_solid(*ray, std::get<RayPicture>(b));
    return is_same_solid(*rows_in_space(a), *rows_in_space(b));
}

ImageRgba8 render(InsideView& view, const InsidePicture& picture, const ViewState& state, const LitGeometry& lit,
                  ImageSize size, int samples_per_axis, float text_scale) {
    if (const auto* ray = std::get_if<RayPicture>(&picture); ray != nullptr && ray->samples)
        return render(view, merged_until(*ray, state.merged_samples), state, lit, size, samples_per_axis, text_scale);
    const auto* dictionary = std::get_if<DictionaryPicture>(&picture);
    const ImageSize in_space = size_in_space(picture, size, text_scale);
    Canvas canvas = make_picture_canvas(solid_part(view, picture, state, in_space, samples_per_axis));
    const ViewCamera camera = view_camera(shown_camera(picture, state, size, text_scale), in_space);
    const Palette colours = palette(state.theme);
    draw_lit(canvas, camera, lit.step, colours, text_scale, Emphasis::step);
    if (dictionary) draw_lit(canvas, camera, differing_voxels(*dictionary), colours, text_scale, Emphasis::step);
    if (const auto* ray = std::get_if<RayPicture>(&picture))
        draw_ray_marks(canvas, *ray, state, in_space, text_scale);
    else
        draw_voxel_row_marks(canvas, *rows_in_space(picture), state, in_space, text_scale,
                             dictionary ? MarksKey::none : MarksKey::in_corner);
    draw_lit(canvas, camera, lit.pointed, colours, text_scale, Emphasis::pointed);
    ImageRgba8 drawn = finished_picture(canvas);
    return in_space.height < size.height ? with_panel(drawn, picture, state, size, text_scale) : drawn;
}

TraceGeometry voxel_box(const VoxelRowPicture& rows, ivec3 voxel) {
    std::string name = "voxel " + std::to_string(voxel.x);
    for (const int index : {voxel.y, voxel.z}) name.append(", ").append(std::to_string(index));
    return box_geometry(name, rows.world_from_voxels, vec3(voxel), vec3(voxel + 1));
}

std::vector<TraceGeometry> differing_voxels(const DictionaryPicture& picture) {
    std::vector<TraceGeometry> boxes;
    for (int u = 0; u < picture.row.resolution; ++u)
        if (differs(picture, u)) boxes.push_back(voxel_box(picture.row, {u, picture.row.v, picture.row.w}));
    return boxes;
}

PickedInside pick(const InsidePicture& picture, const ViewState& state, std::span<const TraceGeometry> recorded,
                  ImageSize size, vec2 pixel, float text_scale) {
    const ImageSize in_space = size_in_space(picture, size, text_scale);
    if (pixel.y >= static_cast<float>(in_space.height)) return {};
    const ViewCamera camera = view_camera(shown_camera(picture, state, size, text_scale), in_space);
    PickedInside picked;
    picked.geometry = nearest_geometry(camera, recorded, pixel);
    if (!picked.geometry.empty()) return picked;
    if (const auto* ray = std::get_if<RayPicture>(&picture)) {
        picked.voxel = pick(*ray, state, in_space, pixel);
        return picked;
    }
    const VoxelRowPicture* const rows = rows_in_space(picture);
    picked.voxel = pick(*rows, state, in_space, pixel);
    if (picked.voxel) picked.geometry = geometry_of_voxel(*rows, *picked.voxel);
    return picked;
}

}  // namespace sightlines
