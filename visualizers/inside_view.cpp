#include "visualizers/inside_view.h"

#include "visualizers/canvas.h"
#include "visualizers/lit_marks.h"
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
           a.last == b.last && a.ray.origin == b.ray.origin && a.ray.target == b.ray.target;
}

const ImageRgba8& solid_part(InsideView& view, const InsidePicture& picture, const ViewState& state, ImageSize size,
                             int samples_per_axis) {
    SolidDrawn& latest = view.latest;
    if (latest.picture && same_solid(*latest.picture, picture) && latest.state == state && latest.size == size &&
        latest.samples_per_axis == samples_per_axis)
        return latest.pixels;
    latest.picture.reset();  // nothing half-valid stays where drawing fails
    latest.pixels = std::visit(
        [&](const VoxelRowPicture& rows) { return render_solid(view.voxel_rows, rows, state, size, samples_per_axis); },
        picture);
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

OrbitCamera shown_camera(const InsidePicture& picture, const ViewState& state, ImageSize size) {
    return std::visit([&](const VoxelRowPicture& rows) { return shown_camera(rows, state, size); }, picture);
}

bool same_solid(const InsidePicture& a, const InsidePicture& b) {
    return is_same_solid(std::get<VoxelRowPicture>(a), std::get<VoxelRowPicture>(b));
}

ImageRgba8 render(InsideView& view, const InsidePicture& picture, const ViewState& state, const LitGeometry& lit,
                  ImageSize size, int samples_per_axis, float text_scale) {
    Canvas canvas = make_picture_canvas(solid_part(view, picture, state, size, samples_per_axis));
    const ViewCamera camera = view_camera(shown_camera(picture, state, size), size);
    const Palette colours = palette(state.theme);
    draw_lit(canvas, camera, lit.step, colours, text_scale, Emphasis::step);
    draw_voxel_row_marks(canvas, std::get<VoxelRowPicture>(picture), state, size, text_scale, MarksKey::in_corner);
    draw_lit(canvas, camera, lit.pointed, colours, text_scale, Emphasis::pointed);
    return finished_picture(canvas);
}

TraceGeometry voxel_box(const InsidePicture& picture, ivec3 voxel) {
    const VoxelRowPicture& rows = std::get<VoxelRowPicture>(picture);
    const mat4& world = rows.world_from_voxels;
    std::string name = "voxel " + std::to_string(voxel.x);
    for (const int index : {voxel.y, voxel.z}) name.append(", ").append(std::to_string(index));
    return {name, TraceShape::box, {world_point(rows, vec3(voxel)), vec3(world[0]), vec3(world[1]), vec3(world[2])}};
}

PickedInside pick(const InsidePicture& picture, const ViewState& state, std::span<const TraceGeometry> recorded,
                  ImageSize size, vec2 pixel) {
    const ViewCamera camera = view_camera(shown_camera(picture, state, size), size);
    PickedInside picked;
    picked.geometry = nearest_geometry(camera, recorded, pixel);
    if (!picked.geometry.empty()) return picked;
    const auto& rows = std::get<VoxelRowPicture>(picture);
    picked.voxel = pick(rows, state, size, pixel);
    if (picked.voxel) picked.geometry = geometry_of_voxel(rows, *picked.voxel);
    return picked;
}

}  // namespace sightlines
